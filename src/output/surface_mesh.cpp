#include "output/surface_mesh.hpp"

#include <algorithm>

#include "kernel/parallel.hpp"
#include "output/patch_mesh.hpp"
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

/// What one block of faces adds to the mesh. Vertices from `border` on are the block's own.
struct Part {
  std::vector<Point3> inner;
  std::vector<SurfaceMesh::Triangle> triangles;
  std::vector<Surface::Index> folded_faces;
  std::size_t folded = 0;
  double deviation = 0;
};

/// The loops of a face, its vertices numbered anew: the mesh has far more of them.
struct LocalFace {
  std::vector<std::vector<Index>> loops;
  std::vector<Index> global;
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
    for (Index& v : loop) v = Index(std::lower_bound(face.global.begin(), face.global.end(), v) - face.global.begin());
  }
  return face;
}

void triangulate_face(const Surface& surface, const BorderVertices& border, Surface::Index f, double max_error, Part& part) {
  const LocalFace face = local_face(surface, border, f);
  std::vector<Point3> points;
  std::vector<Point> places;
  for (const Index v : face.global) {
    points.push_back(border.vertices()[v]);
    places.push_back({points.back().x, points.back().y});
  }
  const PolygonTriangulation polygon(places, face.loops);
  const SurfacePatch patch(surface.terrain(), surface.face_feature(f), surface.radius());
  PatchMesh mesh(patch, std::move(points), polygon.triangles());
  mesh.refine(face_part * max_error);

  const auto first = Index(border.vertices().size() + part.inner.size());
  const auto known = Index(face.global.size());
  part.inner.insert(part.inner.end(), mesh.points().begin() + known, mesh.points().end());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    SurfaceMesh::Triangle triangle{mesh.triangle(t), f};
    for (Index& v : triangle.vertex) v = v < known ? face.global[v] : first + (v - known);
    part.triangles.push_back(triangle);
  }
  part.deviation = std::max(part.deviation, mesh.deviation());
  const std::size_t folded = mesh.folded();
  part.folded += folded;
  if (folded > 0) part.folded_faces.push_back(f);
}

Result<std::vector<Part>> triangulate_faces(const Surface& surface, const BorderVertices& border, double max_error,
                                            const Context& context) {
  constexpr std::size_t block = 64;
  const std::size_t faces = surface.subdivision().face_count();
  std::vector<Part> parts((faces + block - 1) / block);
  kernel::Progress progress(context, faces);
  const bool done = kernel::parallel_blocks(context, faces, block, [&](std::size_t first, std::size_t last) {
    for (std::size_t f = first; f < last && !context.cancelled(); ++f) {
      if (surface.face_feature(Surface::Index(f)) == Surface::none) continue;
      triangulate_face(surface, border, Surface::Index(f), max_error, parts[first / block]);
    }
    progress.add(last - first);
  });
  if (!done) return surface_interrupted();
  return parts;
}

std::vector<Surface::Index> edges_around(const Surface& surface, const std::vector<Part>& parts) {
  const Subdivision& topology = surface.subdivision();
  std::vector<Surface::Index> edges;
  const auto add_loop = [&](Surface::Index first) {
    Surface::Index h = first;
    do edges.push_back(Subdivision::edge(h));
    while ((h = topology.next[h]) != first);
  };
  for (const Part& part : parts) {
    for (const Surface::Index f : part.folded_faces) {
      add_loop(topology.face_outer[f]);
      for (const Surface::Index h : topology.inner_loops(f)) add_loop(h);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

Result<SurfaceMesh> join(std::vector<Point3> border, std::vector<Part> parts) {
  SurfaceMesh mesh;
  mesh.vertices = std::move(border);
  const std::size_t known = mesh.vertices.size();
  std::size_t vertices = known, triangles = 0;
  for (const Part& part : parts) vertices += part.inner.size(), triangles += part.triangles.size();
  mesh.vertices.reserve(vertices);
  mesh.triangles.reserve(triangles);
  for (Part& part : parts) {
    const std::size_t shift = mesh.vertices.size() - known;
    if (mesh.vertices.size() + part.inner.size() >= ~Index{0}) {
      return Error{ErrorCode::computation, "the mesh would have more than 2^32 vertices", "", "give a larger --max-error"};
    }
    for (SurfaceMesh::Triangle& triangle : part.triangles) {
      for (Index& v : triangle.vertex) v += v < known ? 0 : Index(shift);
    }
    mesh.vertices.insert(mesh.vertices.end(), part.inner.begin(), part.inner.end());
    mesh.triangles.insert(mesh.triangles.end(), part.triangles.begin(), part.triangles.end());
    mesh.deviation = std::max(mesh.deviation, part.deviation);
    mesh.folded += part.folded;
    part = {};
  }
  return mesh;
}

/// Drops vertices that no triangle has.
void compact(SurfaceMesh& mesh) {
  std::vector<Index> number(mesh.vertices.size(), ~Index{0});
  for (const SurfaceMesh::Triangle& triangle : mesh.triangles) {
    for (const Index v : triangle.vertex) number[v] = 0;
  }
  Index count = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] != 0) continue;
    mesh.vertices[count] = mesh.vertices[v];
    number[v] = count++;
  }
  mesh.vertices.resize(count);
  for (SurfaceMesh::Triangle& triangle : mesh.triangles) {
    for (Index& v : triangle.vertex) v = number[v];
  }
}

}  // namespace

Result<SurfaceMesh> triangulate_surface(const Surface& surface, double max_error, const Context& context) {
  double edge_error = edge_part * max_error;
  Result<SurfaceEdges> edges = SurfaceEdges::make(surface, edge_error, context);
  if (!edges) return edges.error();
  for (int round = 0;; ++round) {
    BorderVertices border(surface, *edges);
    Result<std::vector<Part>> parts = triangulate_faces(surface, border, max_error, context);
    if (!parts) return parts.error();
    const std::vector<Surface::Index> narrow = edges_around(surface, *parts);
    if (narrow.empty() || round == refinements) {
      const double edges_deviation = edges->deviation();
      std::vector<Point3> border_vertices = std::move(border).take();
      *edges = {};
      Result<SurfaceMesh> mesh = join(std::move(border_vertices), std::move(*parts));
      if (!mesh) return mesh.error();
      compact(*mesh);
      mesh->deviation += edges_deviation;
      return mesh;
    }
    edge_error *= finer;
    if (Status refined = edges->refine(surface, narrow, edge_error, context); !refined) return refined.error();
  }
}

}  // namespace krepl::output
