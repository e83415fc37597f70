#include "measure/surface_measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "kernel/parallel.hpp"
#include "measure/edge_course.hpp"

namespace krepl::measure {

namespace {

using File = input::SubdivisionFile;
using Index = File::Index;
constexpr Index none = File::none;

/// What is added up along an edge: its length, and what it adds to the faces left and right, on the surface and seen
/// from above.
struct Along {
  double length = 0, projected = 0, left = 0, right = 0;

  friend Along operator+(Along a, Along b) {
    return {a.length + b.length, a.projected + b.projected, a.left + b.left, a.right + b.right};
  }
  friend Along operator*(double s, Along a) { return {s * a.length, s * a.projected, s * a.left, s * a.right}; }
};

/// How far two sums are apart, areas in terms of the radius.
double difference(Along a, Along b, double radius) {
  return std::max({std::fabs(a.length - b.length), std::fabs(a.projected - b.projected) / radius,
                   std::fabs(a.left - b.left) / radius, std::fabs(a.right - b.right) / radius});
}

class EdgeSums {
 public:
  EdgeSums(const File& file, Index e, Point3 origin, double noise, const Touched* left, const Touched* right)
      : file_(file),
        course_(file, e, origin),
        edge_(file.edges[e]),
        start_(file.points[edge_.first] - origin),
        noise_(noise),
        left_(left),
        right_(right) {
    left_foot_ = edge_.kind == File::EdgeKind::rim && edge_.feature[0] == none;
    right_foot_ = edge_.kind == File::EdgeKind::rim && edge_.feature[1] == none;
  }

  Along between(Point3 a, Point3 b, int depth = 0) const {
    const Point3 m = halfway(a, b), k = halfway(a, m), l = halfway(m, b);
    const Along one = step(a, b), two = step(a, m) + step(m, b);
    const Along four = step(a, k) + step(k, m) + step(m, l) + step(l, b);
    // Errors go with the square of the step: Romberg's way.
    const Along coarse = 4.0 / 3 * two + -1.0 / 3 * one, fine = 4.0 / 3 * four + -1.0 / 3 * two;
    const Along best = 16.0 / 15 * fine + -1.0 / 15 * coarse;
    constexpr int deepest = 12;
    constexpr double accuracy = 1e-11;
    if (depth == deepest || !(difference(best, fine, file_.radius) > accuracy * distance(a, b) + noise_)) return best;
    return between(a, m, depth + 1) + between(m, b, depth + 1);
  }
  /// What was left out of `projected` for the sake of its digits: the part between the edge's chord and the origin.
  static double below_chord(Point3 first, Point3 last) { return (first.x * last.y - last.x * first.y) / 2; }

 private:
  /// Edges shorter than what tells their two surfaces apart stay straight.
  Point3 halfway(Point3 a, Point3 b) const {
    const Point3 middle = 0.5 * (a + b), found = course_.nearest(middle);
    return distance(found, middle) <= distance(a, b) ? found : middle;
  }
  Along step(Point3 a, Point3 b) const {
    return {distance(a, b), below_chord(a - start_, b - start_), side(left_, left_foot_, a, b),
            side(right_, right_foot_, a, b)};
  }
  /// A lower face ends at the wall's foot.
  double side(const Touched* patch, bool foot, Point3 a, Point3 b) const {
    if (patch == nullptr) return 0;
    if (foot) a.z = patch->height(a, file_.radius), b.z = patch->height(b, file_.radius);
    return patch->area_step(a, b, file_.radius);
  }

  const File& file_;
  EdgeCourse course_;
  const File::Edge& edge_;
  Point3 start_;
  double noise_;  // rounding, which no smaller step takes away
  const Touched *left_, *right_;
  bool left_foot_, right_foot_;
};

class Measurer {
 public:
  Measurer(const File& file, const Context& context) : file_(file), context_(context) {}
  Result<SurfaceMeasure> run();

 private:
  std::optional<Error> find_sides();
  bool sum_edges();
  void count_edges(SurfaceMeasure& measure) const;
  void count_faces(SurfaceMeasure& measure) const;
  void look_at_valley(Index e, SurfaceMeasure& measure) const;
  void look_at_points(Index e, SurfaceMeasure& measure) const;
  bool share_a_point(Index e) const;
  Index face(Index e, int side) const { return side_face_[2 * std::size_t(e) + std::size_t(side)]; }
  Point3 point(std::uint64_t i) const { return file_.points[i] - origin_; }

  const File& file_;
  const Context& context_;
  Point3 origin_{};
  double scale_ = 0;
  std::vector<Index> side_face_;  // per edge: left and right of its points' order
  std::vector<Touched> patch_;    // per face
  std::vector<Along> along_;      // per edge
};

/// Which faces lie left and right of each edge.
std::optional<Error> Measurer::find_sides() {
  const auto broken = [](const char* what, std::size_t item) {
    return Error{ErrorCode::input, std::string("its topology is broken: ") + what + " " + std::to_string(item), "",
                 "`krepl verify` says more"};
  };
  side_face_.assign(2 * file_.edges.size(), none);
  std::vector<bool> first(file_.edges.size(), true);
  for (std::size_t h = 0; h < file_.half_edges.size(); ++h) {
    const auto& half = file_.half_edges[h];
    if (half.edge >= file_.edges.size() || half.face >= file_.faces.size() || half.twin >= file_.half_edges.size())
      return broken("an index out of range at half-edge", h);
    // The first half-edge of each edge runs along its points.
    side_face_[2 * std::size_t(half.edge) + (first[half.edge] ? 0 : 1)] = half.face;
    first[half.edge] = false;
  }
  for (std::size_t e = 0; e < file_.edges.size(); ++e) {
    if (side_face_[2 * e] == none || side_face_[2 * e + 1] == none) return broken("fewer than two sides of edge", e);
    for (const Index f : file_.edges[e].feature)
      if (f != none && (f >= file_.features.size() || file_.features[f].count == 0)) return broken("a feature out of range at edge", e);
  }
  for (std::size_t f = 0; f < file_.faces.size(); ++f)
    if (file_.faces[f].feature != none && file_.faces[f].feature >= file_.features.size())
      return broken("a feature out of range at face", f);
  return std::nullopt;
}

bool Measurer::sum_edges() {
  patch_.resize(file_.faces.size());
  for (std::size_t f = 0; f < file_.faces.size(); ++f)
    if (file_.faces[f].feature != none) patch_[f] = touched(file_.features[file_.faces[f].feature], origin_);
  along_.resize(file_.edges.size());
  constexpr std::size_t block = 1024;
  kernel::Progress progress(context_, file_.edges.size());
  return kernel::parallel_blocks(context_, file_.edges.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto e = Index(i);
      const auto patch = [&](int side) {
        return file_.faces[face(e, side)].feature == none ? nullptr : &patch_[face(e, side)];
      };
      const EdgeSums sums(file_, e, origin_, 1e-15 * scale_, patch(0), patch(1));
      const std::uint64_t first = file_.edges[e].first, last = file_.points_end(e) - 1;
      for (std::uint64_t p = first; p < last; ++p) along_[e] = along_[e] + sums.between(point(p), point(p + 1));
      along_[e].projected += EdgeSums::below_chord(point(first), point(last));
    }
    progress.add(end - begin);
  });
}

void Measurer::count_edges(SurfaceMeasure& measure) const {
  for (Index e = 0; e < file_.edges.size(); ++e) {
    const auto& edge = file_.edges[e];
    for (auto* sums : {&measure.by_kind[std::size_t(edge.kind)], &measure.by_curve[std::size_t(edge.curve)]})
      ++sums->count, sums->length += along_[e].length;
    measure.shortest_edge.lower(along_[e].length, file_.points[edge.first]);
    look_at_points(e, measure);
    if (edge.kind == File::EdgeKind::valley) look_at_valley(e, measure);
  }
}

void Measurer::look_at_points(Index e, SurfaceMeasure& measure) const {
  const EdgeCourse course(file_, e, origin_);
  for (std::uint64_t p = file_.edges[e].first; p < file_.points_end(e); ++p) {
    for (int s = 0; s < 2; ++s)
      if (course.side(s) != nullptr)
        measure.residual.raise(std::fabs(course.side(s)->off(point(p), file_.radius)), file_.points[p]);
  }
}

bool Measurer::share_a_point(Index e) const {
  const auto& edge = file_.edges[e];
  const auto &a = file_.features[edge.feature[0]], &b = file_.features[edge.feature[1]];
  for (int i = 0; i < a.count; ++i)
    for (int k = 0; k < b.count; ++k)
      if (a.at[std::size_t(i)] == b.at[std::size_t(k)]) return true;
  return false;
}

void Measurer::look_at_valley(Index e, SurfaceMeasure& measure) const {
  const EdgeCourse course(file_, e, origin_);
  if (course.side(0) == nullptr || course.side(1) == nullptr) return;
  const bool crease = share_a_point(e);
  Valleys& valleys = crease ? measure.creases : measure.bridges;
  ++valleys.count;
  valleys.length += along_[e].length;
  const double radius = file_.radius;
  for (std::uint64_t p = file_.edges[e].first; p < file_.points_end(e); ++p) {
    const Point3 centre = point(p), place = file_.points[p];
    const double sine = std::min(1.0, distance(course.side(0)->normal(centre), course.side(1)->normal(centre)) / 2);
    const double cosine = std::sqrt(1 - sine * sine);
    valleys.turn.raise(2 * std::asin(sine), place);
    if (cosine > 0) valleys.depth.raise(radius * sine * sine / (cosine * (1 + cosine)), place);
    if (crease) continue;
    measure.narrowest_bridge.lower(radius * sine, place);
    measure.widest_bridge.raise(radius * sine, place);
  }
}

void Measurer::count_faces(SurfaceMeasure& measure) const {
  std::vector<double> area(file_.faces.size()), projected(file_.faces.size());
  for (Index e = 0; e < file_.edges.size(); ++e) {
    area[face(e, 0)] += along_[e].left, area[face(e, 1)] -= along_[e].right;
    projected[face(e, 0)] += along_[e].projected, projected[face(e, 1)] -= along_[e].projected;
  }
  for (std::size_t f = 0; f < file_.faces.size(); ++f) {
    const auto& found = file_.faces[f];
    if (found.feature == none) {
      measure.holes += f > 0;
      continue;
    }
    auto& sums = measure.by_feature[std::size_t(file_.features[found.feature].count - 1)];
    ++sums.count, ++measure.faces;
    sums.area += area[f], sums.projected += projected[f];
    if (found.outer < file_.half_edges.size() && file_.half_edges[found.outer].origin < file_.vertices.size())
      measure.smallest_face.lower(std::max(0.0, area[f]), file_.vertices[file_.half_edges[found.outer].origin]);
  }
}

Result<SurfaceMeasure> Measurer::run() {
  if (std::optional<Error> broken = find_sides()) return *broken;
  SurfaceMeasure measure;
  measure.radius = file_.radius;
  measure.vertices = file_.vertices.size(), measure.edges = file_.edges.size();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  measure.lowest = {infinity, infinity, infinity}, measure.highest = {-infinity, -infinity, -infinity};
  for (const Point3 p : file_.vertices) {
    measure.lowest = {std::min(measure.lowest.x, p.x), std::min(measure.lowest.y, p.y),
                      std::min(measure.lowest.z, p.z)};
    measure.highest = {std::max(measure.highest.x, p.x), std::max(measure.highest.y, p.y),
                       std::max(measure.highest.z, p.z)};
  }
  if (file_.vertices.empty()) return Error{ErrorCode::input, "has no vertices", "", ""};
  origin_ = 0.5 * (measure.lowest + measure.highest);
  const Point3 half = 0.5 * (measure.highest - measure.lowest);
  measure.scale = scale_ = std::max({file_.radius, half.x, half.y, half.z});
  if (!sum_edges()) return Error{ErrorCode::cancelled, "interrupted", "", ""};
  count_edges(measure);
  count_faces(measure);
  return measure;
}

}  // namespace

Result<SurfaceMeasure> measure_surface(const File& file, const Context& context) {
  return Measurer(file, context).run();
}

}  // namespace krepl::measure
