#include "view/surface/shape.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/terrain_window.hpp"
#include "output/surface_patch.hpp"
#include "view/surface/curve_points.hpp"
#include "view/surface/links.hpp"
#include "view/surface/patch_triangles.hpp"

namespace krepl::view {

namespace {

using File = input::SubdivisionFile;
using Index = Shape::Index;
using output::SurfacePatch;

constexpr std::size_t cancel_interval = 4096;
/// Of the largest deviation: triangles beside a border deviate more than its chords.
constexpr double border_share = 0.5;

Point3 minus(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// Builds a shape face by face. Vertices on borders are shared between faces; the foot of a wall has its own.
class ShapeBuilder {
 public:
  ShapeBuilder(const File& file, double max_error, const Context& context)
      : file_(file), max_error_(max_error), context_(context) {}

  Result<Shape> build();

 private:
  SurfacePatch patch_of(Index feature) const;
  bool is_foot(Index half_edge) const {
    const File::HalfEdge& h = file_.half_edges[half_edge];
    return file_.edges[h.edge].feature[half_edge & 1u] == File::none;
  }
  std::span<const Index> inner(Index edge) const {
    return {edge_vertex_.data() + edge_first_[edge], edge_first_[edge + 1] - edge_first_[edge]};
  }
  void place_features();
  void place_edges();
  void add_face(Index face);
  std::vector<Index> loop(Index start, const SurfacePatch& patch);
  Index foot_of(Index vertex, const SurfacePatch& patch);
  bool is_below(Index vertex, const SurfacePatch& patch) const;
  void append_chain(Index half_edge, bool foot, const SurfacePatch& patch, std::vector<Index>& chain);
  void add_wall(Index half_edge, const std::vector<Index>& top, const std::vector<Index>& foot);
  void add_line(Index half_edge, Index face);

  const File& file_;
  const double max_error_;
  const Context& context_;
  Shape shape_;
  std::vector<Index> edge_vertex_;  // inner vertices of edges
  std::vector<std::uint64_t> edge_first_;
  std::vector<bool> at_rim_;                   // by vertex
  std::vector<Index> face_number_;             // of the file's faces in the shape
  std::vector<std::pair<Index, Index>> foot_;  // of the face in hand: top and foot
};

SurfacePatch ShapeBuilder::patch_of(Index feature) const {
  const Shape::Feature& f = shape_.features[feature];
  return {Terrain::FeatureKind(f.count - 1), Terrain::Corners{f.at, f.count}, file_.radius};
}

void ShapeBuilder::place_features() {
  shape_.radius = file_.radius;
  shape_.origin = file_.vertices.empty() ? Point3{} : file_.vertices.front();
  // Whole numbers are taken off, so that coordinates keep their last digit.
  for (double* c : {&shape_.origin.x, &shape_.origin.y, &shape_.origin.z}) *c = std::floor(*c);
  for (const File::Feature& f : file_.features) {
    Shape::Feature feature{f.at, f.count};
    for (int i = 0; i < f.count; ++i) feature.at[std::size_t(i)] = minus(f.at[std::size_t(i)], shape_.origin);
    shape_.features.push_back(feature);
  }
  for (const Point3 v : file_.vertices) shape_.vertices.push_back(minus(v, shape_.origin));
}

void ShapeBuilder::place_edges() {
  edge_first_.assign(1, 0);
  at_rim_.assign(file_.vertices.size(), false);
  std::vector<Point3> given;
  for (Index e = 0; e < file_.edges.size(); ++e) {
    const File::Edge& edge = file_.edges[e];
    given.clear();
    for (std::uint64_t i = edge.first; i < file_.points_end(e); ++i)
      given.push_back(minus(file_.points[i], shape_.origin));
    // Exactly its vertices, which its neighbours use.
    given.front() = shape_.vertices[file_.half_edges[2 * e].origin];
    given.back() = shape_.vertices[file_.half_edges[2 * e + 1].origin];
    if (edge.kind == File::EdgeKind::rim)
      at_rim_[file_.half_edges[2 * e].origin] = at_rim_[file_.half_edges[2 * e + 1].origin] = true;
    std::optional<SurfacePatch> side[2];
    if (edge.kind == File::EdgeKind::valley)
      for (int i : {0, 1})
        if (edge.feature[std::size_t(i)] != File::none) side[i] = patch_of(edge.feature[std::size_t(i)]);
    const bool both = side[0] && side[1];
    const std::vector<Point3> points = curve_points(given, edge.curve, both ? &*side[0] : nullptr,
                                                    both ? &*side[1] : nullptr, border_share * max_error_);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      edge_vertex_.push_back(Index(shape_.vertices.size()));
      shape_.vertices.push_back(points[i]);
    }
    edge_first_.push_back(edge_vertex_.size());
  }
}

/// A vertex of the face in hand below one of a rim.
Index ShapeBuilder::foot_of(Index vertex, const SurfacePatch& patch) {
  for (const auto& [top, foot] : foot_)
    if (top == vertex) return foot;
  const Point3 p = shape_.vertices[vertex];
  const auto foot = Index(shape_.vertices.size());
  shape_.vertices.push_back({p.x, p.y, std::min(p.z, patch.height(p.x, p.y))});
  foot_.emplace_back(vertex, foot);
  return foot;
}

/// Around the end of a rim some faces are below it that do not touch it otherwise.
bool ShapeBuilder::is_below(Index vertex, const SurfacePatch& patch) const {
  if (!at_rim_[vertex]) return false;
  const Point3 p = shape_.vertices[vertex];
  return patch.height(p.x, p.y) < p.z - max_error_;
}

/// The vertices along a half-edge but the last.
void ShapeBuilder::append_chain(Index half_edge, bool foot, const SurfacePatch& patch, std::vector<Index>& chain) {
  const std::span<const Index> points = inner(half_edge / 2);
  const auto add = [&](Index v) { chain.push_back(foot ? foot_of(v, patch) : v); };
  if (half_edge % 2 == 0)
    std::for_each(points.begin(), points.end(), add);
  else
    std::for_each(points.rbegin(), points.rend(), add);
}

std::vector<Index> ShapeBuilder::loop(Index start, const SurfacePatch& patch) {
  std::vector<Index> chain;
  Index h = start;
  bool after_foot = is_foot(start);
  // Whether the half-edge before the first one is a foot is known at the end only: then the first vertex is set again.
  do {
    const bool foot = is_foot(h);
    const Index origin = file_.half_edges[h].origin;
    chain.push_back(foot || after_foot || is_below(origin, patch) ? foot_of(origin, patch) : origin);
    append_chain(h, foot, patch, chain);
    after_foot = foot;
    h = file_.half_edges[h].next;
  } while (h != start);
  if (after_foot) chain.front() = foot_of(file_.half_edges[start].origin, patch);
  return chain;
}

void ShapeBuilder::add_wall(Index half_edge, const std::vector<Index>& top, const std::vector<Index>& foot) {
  if (!is_foot(half_edge)) return;
  for (std::size_t i = 0; i + 1 < top.size(); ++i) {
    // Counter-clockwise seen from the lower face, which is on the left of the half-edge.
    shape_.triangles.push_back({foot[i], top[i], top[i + 1]});
    shape_.triangles.push_back({foot[i], top[i + 1], foot[i + 1]});
  }
}

void ShapeBuilder::add_line(Index half_edge, Index face) {
  const File::Edge& edge = file_.edges[half_edge / 2];
  shape_.lines.push_back({Shape::LineKind(edge.kind), face, shape_.line_vertices.size()});
  shape_.line_vertices.push_back(file_.half_edges[half_edge & ~1u].origin);
  for (const Index v : inner(half_edge / 2)) shape_.line_vertices.push_back(v);
  shape_.line_vertices.push_back(file_.half_edges[half_edge | 1u].origin);
}

void ShapeBuilder::add_face(Index number) {
  const File::Face& face = file_.faces[number];
  const SurfacePatch patch = patch_of(face.feature);
  foot_.clear();
  std::vector<Index> starts{face.outer};
  starts.insert(starts.end(), file_.inner.begin() + std::ptrdiff_t(face.first_inner),
                file_.inner.begin() + std::ptrdiff_t(file_.inner_end(number)));
  std::vector<std::vector<Index>> loops;
  std::vector<Point3> points;
  std::vector<Index> global;
  for (const Index start : starts) {
    const std::vector<Index> chain = loop(start, patch);
    std::vector<Index>& local = loops.emplace_back();
    for (const Index v : chain) {
      local.push_back(Index(global.size()));
      global.push_back(v);
      points.push_back(shape_.vertices[v]);
    }
  }
  face_number_[number] = Index(shape_.faces.size());
  shape_.faces.push_back(
      {Shape::FaceKind(shape_.features[face.feature].count - 1), face.feature, shape_.triangles.size()});
  const PatchTriangles mesh = patch_triangles(patch, std::move(points), loops, max_error_);
  for (std::size_t i = global.size(); i < mesh.points.size(); ++i) {
    global.push_back(Index(shape_.vertices.size()));
    shape_.vertices.push_back(mesh.points[i]);
  }
  for (const auto& c : mesh.triangles) shape_.triangles.push_back({global[c[0]], global[c[1]], global[c[2]]});
  if (foot_.empty()) return;
  shape_.faces.push_back({Shape::FaceKind::wall, Shape::none, shape_.triangles.size()});
  for (const Index start : starts) {
    Index h = start;
    do {
      if (is_foot(h)) {
        std::vector<Index> top{file_.half_edges[h].origin}, foot;
        append_chain(h, false, patch, top);
        top.push_back(file_.half_edges[h ^ 1u].origin);
        for (const Index v : top) foot.push_back(foot_of(v, patch));
        add_wall(h, top, foot);
      }
      h = file_.half_edges[h].next;
    } while (h != start);
  }
}

Result<Shape> ShapeBuilder::build() {
  if (Status linked = check_links(file_); !linked) return linked.error();
  place_features();
  place_edges();
  face_number_.assign(file_.faces.size(), Shape::none);
  for (Index f = 0; f < file_.faces.size(); ++f) {
    if (f % cancel_interval == 0) {
      if (context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
      if (context_.progress) context_.progress(double(f) / double(file_.faces.size()));
    }
    if (file_.faces[f].feature != File::none) add_face(f);
    if (shape_.vertices.size() >= Shape::none / 2)
      return Error{ErrorCode::input, "has too many patches for a page", "",
                   "show a part of it, or give a larger --max-error"};
  }
  if (shape_.triangles.empty())
    return Error{ErrorCode::input, "has no face", "", "give a surface that krepl terrain wrote"};
  // A line goes with the face on its upper side.
  for (Index e = 0; e < file_.edges.size(); ++e) {
    const Index h = file_.edges[e].feature[0] != File::none ? 2 * e : 2 * e + 1;
    const Index face = face_number_[file_.half_edges[h].face];
    if (face != Shape::none) add_line(h, face);
  }
  return std::move(shape_);
}

}  // namespace

Result<Shape> surface_shape(const input::SubdivisionFile& surface, double max_error, const Context& context) {
  return ShapeBuilder(surface, max_error, context).build();
}

Shape terrain_shape(const Terrain& terrain, Point3 origin) {
  TerrainWindow window;
  window.fill(terrain, {terrain.lowest().x, terrain.lowest().y}, {terrain.highest().x, terrain.highest().y});
  const Point3 shift = minus(terrain.origin(), origin);
  Shape shape;
  shape.origin = origin;
  for (const TerrainWindow::Vertex& v : window.vertices())
    shape.vertices.push_back({v.at.x + shift.x, v.at.y + shift.y, v.at.z + shift.z});
  for (const TerrainWindow::Face& f : window.faces()) {
    shape.faces.push_back({Shape::FaceKind::ground, Shape::none, shape.triangles.size()});
    shape.triangles.push_back(f.vertex);
  }
  return shape;
}

}  // namespace krepl::view
