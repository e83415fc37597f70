#include "output/surface_mesh.hpp"

#include <algorithm>
#include <numeric>

#include "kernel/parallel.hpp"
#include "output/polygon_triangulation.hpp"
#include "output/surface_patch.hpp"
#include "output/surface_writers.hpp"

namespace krepl::output {

namespace {

using Index = SurfaceMesh::Index;

// The deviation asked for, shared between the chords of edges, and the triangles inside faces. Triangles have chords for
// sides, and so cannot be much better than these.
constexpr double edge_part = 0.4, face_part = 0.6;
/// So many times the edges of faces that fold over are taken finer, until the chords of the two sides of a narrow face
/// no longer cross.
constexpr int refinements = 3;
constexpr double finer = 1.0 / 16;

/// The loops of a face, its vertices numbered anew: the mesh has far more of them.
struct LocalFace {
  std::vector<std::vector<Index>> loops;
  std::vector<Index> global;

  Index number(Index v) const { return Index(std::lower_bound(global.begin(), global.end(), v) - global.begin()); }
};

LocalFace local_face(const Surface& surface, const BorderVertices& border, Surface::Index f) {
  const Subdivision& topology = surface.subdivision();
  LocalFace face;
  face.loops.push_back(border.loop(topology.face_outer[f]));
  for (const Surface::Index h : topology.inner_loops(f)) face.loops.push_back(border.loop(h));
  for (const auto& loop : face.loops) face.global.insert(face.global.end(), loop.begin(), loop.end());
  std::sort(face.global.begin(), face.global.end());
  face.global.erase(std::unique(face.global.begin(), face.global.end()), face.global.end());
  for (auto& loop : face.loops) {
    for (Index& v : loop) v = face.number(v);
  }
  return face;
}

/// The chords of a face's border but for those at rims, ascending.
std::vector<PatchMesh::Chord> border_chords(const Surface& surface, const BorderVertices& border, Surface::Index f,
                                            const LocalFace& face) {
  const Subdivision& topology = surface.subdivision();
  std::vector<PatchMesh::Chord> chords;
  std::vector<Index> vertices;
  const auto add_loop = [&](Surface::Index first) {
    Surface::Index h = first;
    do {
      const Surface::Index following = topology.next[h];
      vertices.clear();
      border.append(h, vertices);
      const std::size_t count = vertices.size();
      border.append(following, vertices);
      const Surface::Index beyond = surface.face_feature(topology.face[Subdivision::twin(h)]);
      if (surface.edge(Subdivision::edge(h)).kind != Surface::EdgeKind::rim) {
        for (std::size_t i = 0; i < count; ++i)
          chords.push_back({face.number(vertices[i]), face.number(vertices[i + 1]), beyond});
      }
      h = following;
    } while (h != first);
  };
  add_loop(topology.face_outer[f]);
  for (const Surface::Index h : topology.inner_loops(f)) add_loop(h);
  std::sort(chords.begin(), chords.end());
  return chords;
}

PatchMesh triangulate(const BorderVertices& border, const LocalFace& face, const SurfacePatch& patch,
                      double max_error) {
  std::vector<Point3> points;
  std::vector<Point> places;
  for (const Index v : face.global) {
    points.push_back(border.vertex(v));
    places.push_back({points.back().x, points.back().y});
  }
  const PolygonTriangulation polygon(places, face.loops);
  PatchMesh mesh(patch, std::move(points), polygon.triangles());
  mesh.refine(max_error);
  return mesh;
}

}  // namespace

SurfaceMesh::SurfaceMesh(const Surface& surface, BorderVertices border, double face_error)
    : surface_(&surface),
      border_(std::move(border)),
      face_error_(face_error),
      block_((surface.subdivision().face_count() + block_size - 1) / block_size) {}

void SurfaceMesh::visit(std::size_t block, const Context& context, const std::function<void(const Face&)>& use) const {
  const std::size_t last = std::min(surface_->subdivision().face_count(), (block + 1) * block_size);
  std::uint64_t inner = block_[block].inner_before, points = block_[block].points_before;
  for (auto f = Surface::Index(block * block_size); f < last && !context.cancelled(); ++f) {
    if (!border_.has_triangles(f)) continue;
    const LocalFace face = local_face(*surface_, border_, f);
    const SurfacePatch patch(surface_->terrain(), surface_->face_feature(f), surface_->radius());
    PatchMesh mesh = triangulate(border_, face, patch, face_error_);
    if (mesh.points().size() > face.global.size())
      mesh.lift(surface_->terrain(), surface_->radius(), border_chords(*surface_, border_, f, face));
    use({f, mesh, face.global, inner, points});
    inner += mesh.points().size() - face.global.size();
    points += mesh.points().size();
  }
}

void SurfaceMesh::Sums::add(const Sums& other) {
  triangles += other.triangles, inner += other.inner, points += other.points, folded += other.folded;
  deviation = std::max(deviation, other.deviation);
  low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y), std::min(low.z, other.low.z)};
  high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y), std::max(high.z, other.high.z)};
}

void SurfaceMesh::count(std::size_t block, const Context& context) {
  Sums sums;
  std::vector<Surface::Index> folded_faces;
  visit(block, context, [&](const Face& face) {
    const PatchMesh& mesh = face.triangles;
    const std::size_t folded = mesh.folded(), points = mesh.points().size();
    sums.add({.triangles = mesh.triangle_count(),
              .inner = points - face.border.size(),
              .points = points,
              .folded = folded,
              .deviation = mesh.deviation()});
    for (const Point3 p : mesh.points()) sums.add({.low = p, .high = p});
    if (folded > 0) folded_faces.push_back(face.face);
  });
  block_[block].sums = sums;
  block_[block].folded_faces = std::move(folded_faces);
}

Status SurfaceMesh::count(const std::vector<std::size_t>& blocks, const Context& context) {
  kernel::Progress progress(context, blocks.size());
  const bool done = kernel::parallel_blocks(context, blocks.size(), 1, [&](std::size_t i, std::size_t) {
    count(blocks[i], context);
    progress.add(1);
  });
  if (!done) return surface_interrupted();
  return std::monostate{};
}

void SurfaceMesh::add_up() {
  total_ = {};
  for (Block& block : block_) {
    block.inner_before = total_.inner;
    block.points_before = total_.points;
    total_.add(block.sums);
  }
}

std::vector<Surface::Index> SurfaceMesh::edges_of_folded_faces() const {
  const Subdivision& topology = surface_->subdivision();
  std::vector<Surface::Index> edges;
  const auto add_loop = [&](Surface::Index first) {
    Surface::Index h = first;
    do edges.push_back(Subdivision::edge(h));
    while ((h = topology.next[h]) != first);
  };
  for (const Block& block : block_) {
    for (const Surface::Index f : block.folded_faces) {
      add_loop(topology.face_outer[f]);
      for (const Surface::Index h : topology.inner_loops(f)) add_loop(h);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::vector<std::size_t> SurfaceMesh::blocks_beside(std::span<const Surface::Index> edges) const {
  std::vector<std::size_t> blocks;
  for (const Surface::Index e : edges) {
    for (const Surface::Index h : {2 * e, 2 * e + 1}) blocks.push_back(surface_->subdivision().face[h] / block_size);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

Result<SurfaceMesh> SurfaceMesh::make(const Surface& surface, double max_error, const Context& context) {
  double edge_error = edge_part * max_error;
  Result<BorderVertices> border = BorderVertices::make(surface, edge_error, context);
  if (!border) return border.error();
  SurfaceMesh mesh(surface, std::move(*border), face_part * max_error);
  std::vector<std::size_t> blocks(mesh.block_count());
  std::iota(blocks.begin(), blocks.end(), std::size_t{0});
  for (int round = 0;; ++round) {
    if (Status counted = mesh.count(blocks, context); !counted) return counted.error();
    const std::vector<Surface::Index> narrow = mesh.edges_of_folded_faces();
    if (narrow.empty() || round == refinements) break;
    edge_error *= finer;
    if (Status refined = mesh.border_.refine(narrow, edge_error, context); !refined) return refined.error();
    blocks = mesh.blocks_beside(narrow);
  }
  mesh.add_up();
  return mesh;
}

}  // namespace krepl::output
