// Checks of the curves: is the ball, with its centre there, touching what it should and cutting nothing?
#include <algorithm>
#include <limits>
#include <optional>

#include "verify/surface_checks.hpp"

namespace krepl::verify {

namespace {

using Index = SurfaceCase::Index;
using Curve = SubdivisionFile::Curve;
using EdgeKind = SubdivisionFile::EdgeKind;
using Vec3 = Space<double>;

struct EdgeTallies {
  Tally touch, join, empty, ends, shape, between, outline;
  std::uint64_t loose = 0;  ///< chords between whose ends no true point was found
  void add(const EdgeTallies& t) {
    touch.add(t.touch), join.add(t.join), empty.add(t.empty), ends.add(t.ends), shape.add(t.shape);
    between.add(t.between), outline.add(t.outline);
    loose += t.loose;
  }
};

Vec place(Vec3 c) { return Vec(c.x, c.y); }

class EdgeChecker {
 public:
  explicit EdgeChecker(const SurfaceCase& surface) : surface_(surface), file_(surface.file), limit_(surface.tolerance) {
    on_rim_.resize(file_.vertices.size());
    for (const auto& half : file_.half_edges)
      if (file_.edges[half.edge].kind == EdgeKind::rim) on_rim_[half.origin] = true;
  }

  void check(Index e, EdgeTallies& sum, double& edge_sag, double& edge_bulge) const {
    const auto& edge = file_.edges[e];
    const std::uint64_t first = edge.first, last = file_.points_end(e);
    const int features = (edge.feature[0] != SurfaceCase::none) + (edge.feature[1] != SurfaceCase::none);
    edge_sag = limit_, edge_bulge = 0;
    ends(e, sum);
    if (features != (edge.kind == EdgeKind::rim ? 1 : 2)) return;  // told by check_labels
    const bool outline = surface_.left_label(e) == SurfaceCase::none || surface_.right_label(e) == SurfaceCase::none;
    double sag = 0, bulge = 0;
    for (std::uint64_t i = first; i < last; ++i) {
      const Vec3 c = surface_.point(i);
      sum.touch.add(touching(edge, c), limit_, place(c));
      sum.join.add(joining(edge, c), limit_, place(c));
      sum.empty.add(depth(c), limit_, place(c));
      if (outline) sum.outline.add(off_outline(c), limit_, place(c));
      if (i > first) between(edge, surface_.point(i - 1), c, sum, sag, bulge);
    }
    sum.shape.add(off_shape(edge, first, last), limit_, place(surface_.point(first)));
    edge_sag = 1.5 * sag + limit_, edge_bulge = bulge;
  }

  /// How far c is from having distance R to both features. Where the two touched points lie in nearly the same
  /// direction, the place along the surface is not well determined: a touched point outside its feature counts by what
  /// the ball misses.
  double touching(const SubdivisionFile::Edge& edge, Vec3 c) const {
    const double off = touching_in<double>(edge, c);
    return off <= limit_ / 8 ? off : touching_in<Quad>(edge, c);
  }

  /// How much a ball about c cuts into the solid.
  double depth(Vec3 c) const {
    const double near = surface_.solid.distance(c, surface_.radius);
    if (surface_.radius - near <= limit_ / 8) return surface_.radius - near;
    return surface_.radius - surface_.solid.distance_carefully(c, surface_.radius);
  }
  bool on_rim(Index vertex) const { return on_rim_[vertex]; }

 private:
  template <class T>
  double touching_in(const SubdivisionFile::Edge& edge, Vec3 c) const {
    double worst = 0, outside = 0, turn = 1;
    Space<T> normal[2];
    int count = 0;
    for (const Index f : edge.feature) {
      if (f == SurfaceCase::none) continue;
      const Foot<T> foot = foot_on(surface_.shape[f], Space<T>(c));
      const Space<T> up = Space<T>(c) - foot.at;
      const T off = root(square(up) + foot.outside * foot.outside) - T(surface_.radius);
      // The ball lies on what it touches.
      worst = std::max({worst, std::abs(double(off)), -double(up.z)});
      outside = std::max(outside, double(foot.outside) * in_plan(surface_.shape[f], up));
      normal[count++] = T(1) / T(surface_.radius) * up;
    }
    if (count == 2) turn = std::min(1.0, double(length(normal[0] - normal[1])));
    return std::max(worst, outside * turn);
  }

  /// How far the ball moves in the plane, at least, for each unit that the touched point moves along an edge: near a
  /// wall a steep edge's touched point runs along it while the ball hardly moves.
  template <class T>
  static double in_plan(const Shape& shape, const Space<T>& up) {
    if (shape.count != 2) return 1;
    const Vec3 d = Vec3(shape.at[1]) - Vec3(shape.at[0]);
    // A ball that touches with its equator is above or below that by rounding alone.
    const double rise = d.z * double(length(up)), level = std::abs(double(up.z)) * length(d);
    return level > 0 || rise != 0 ? level / std::hypot(level, rise) : 1;
  }

  /// Along a seam both features are touched at the same place, along a rim the ball touches with its equator. Distances
  /// would tell the square of the deviation only.
  double joining(const SubdivisionFile::Edge& edge, Vec3 c) const {
    const auto off = [&]<class T>(T) {
      if (edge.kind == EdgeKind::seam)
        return double(length(foot_on(surface_.shape[edge.feature[0]], Space<T>(c)).at -
                             foot_on(surface_.shape[edge.feature[1]], Space<T>(c)).at));
      const Index f = edge.feature[edge.feature[0] == SurfaceCase::none];
      const Space<T> away = Space<T>(c) - foot_on(surface_.shape[f], Space<T>(c)).at;
      // A face has no equator: how far in the plane it ends from where the cylinder beside it would.
      if (surface_.shape[f].count == 3) return double(length(away) - root(away.x * away.x + away.y * away.y));
      return double(away.z);
    };
    if (edge.kind == EdgeKind::valley) return 0;
    const double quick = std::abs(off(double{}));
    return quick <= limit_ / 8 ? quick : std::abs(off(Quad{}));
  }

  double off_outline(Vec3 c) const {
    return std::abs(surface_.solid.plane_distance(c.x, c.y, 1.5 * surface_.radius) - surface_.radius);
  }

  /// The edge's ends are its vertices. At a rim the vertex is that of the upper side, and what ends below keeps its
  /// height.
  void ends(Index e, EdgeTallies& sum) const {
    const Index h = surface_.forward[e], twin = file_.half_edges[h].twin;
    const auto one = [&](Index half, std::uint64_t i) {
      const Index v = file_.half_edges[half].origin;
      const Vec3 d = surface_.point(i) - Vec3(file_.vertices[v]);
      const bool below = on_rim_[v] && d.z < 0;
      sum.ends.add(below ? std::hypot(d.x, d.y) : length(d), limit_, place(surface_.point(i)));
    };
    one(h, file_.edges[e].first);
    one(twin, file_.points_end(e) - 1);
  }

  double off_shape(const SubdivisionFile::Edge& edge, std::uint64_t first, std::uint64_t last) const {
    double worst = 0;
    const Vec3 a = surface_.point(first), b = surface_.point(last - 1);
    if (edge.curve == Curve::line) {
      for (std::uint64_t i = first + 1; i + 1 < last; ++i)
        worst = std::max(worst, length(surface_.point(i) - nearest_on_segment(surface_.point(i), a, b)));
    } else if (edge.curve == Curve::circle) {
      worst = off_circle(first, last);
    }
    return worst;
  }

  /// Distance of all points from the circle through three of them; where those are nearly on a line, from the plane
  /// only.
  double off_circle(std::uint64_t first, std::uint64_t last) const {
    const std::uint64_t count = last - first;
    const Vec3 a = surface_.point(first), b = surface_.point(first + count / 3),
               c = surface_.point(first + 2 * count / 3);
    const Vec3 u = b - a, v = c - a, n = cross(u, v);
    const double nn = square(n);
    if (!(nn > 1e-8 * square(u) * square(v))) return 0;
    const Vec3 middle = a + (1 / (2 * nn)) * (square(u) * cross(v, n) + square(v) * cross(n, u));
    const double r = length(a - middle);
    double worst = 0;
    for (std::uint64_t i = first; i < last; ++i) {
      const Vec3 d = surface_.point(i) - middle;
      const double up = dot(d, n) / std::sqrt(nn);
      worst = std::max(worst, std::hypot(up, std::sqrt(std::max(0.0, square(d) - up * up)) - r));
    }
    return worst;
  }

  /// The true curve half-way between two neighbouring points: the same checks there, and how far it is from the chord.
  void between(const SubdivisionFile::Edge& edge, Vec3 a, Vec3 b, EdgeTallies& sum, double& sag, double& bulge) const {
    if (!(length(b - a) > 64 * limit_)) {
      // Too short to be followed: where two surfaces are nearly tangent, the curve bends between points so close.
      if (edge.curve != Curve::line) sag = std::max(sag, length(b - a) / 2);
      return;
    }
    const std::optional<Vec3> m = middle(edge, a, b);
    if (!m) {
      ++sum.loose;
      sag = std::max(sag, length(b - a) / 2);
      return;
    }
    sum.between.add(std::max({touching(edge, *m), joining(edge, *m), depth(*m)}), limit_, place(*m));
    const Vec3 chord = b - a, off = *m - 0.5 * (a + b);
    // Not only across the chord: seen from above, a steep arc may reach beyond the chord's ends.
    sag = std::max(sag, std::hypot(off.x, off.y));
    // As for a parabola: two thirds of chord times sagitta.
    bulge += 2 * (off.x * chord.y - off.y * chord.x) / 3;
  }

  std::optional<Vec3> middle(const SubdivisionFile::Edge& edge, Vec3 a, Vec3 b) const {
    const Vec3 m = 0.5 * (a + b);
    if (edge.curve == Curve::line) return m;
    if (edge.kind != EdgeKind::valley) {
      // A circle about a vertex.
      for (const Index f : edge.feature) {
        if (f == SurfaceCase::none || surface_.shape[f].count != 1) continue;
        const Vec3 v(surface_.shape[f].at[0]), d = m - v;
        if (!(square(d) > 1e-6 * surface_.radius * surface_.radius)) return std::nullopt;
        return v + (surface_.radius / length(d)) * d;
      }
      return edge.kind == EdgeKind::rim ? std::nullopt : circle_about_line(edge, m);
    }
    return valley_middle(edge, a, b);
  }

  /// Two edges that follow each other on a line share a seam circle about their common vertex.
  std::optional<Vec3> circle_about_line(const SubdivisionFile::Edge& edge, Vec3 m) const {
    const Vec3 p = foot_on(surface_.shape[edge.feature[0]], m).at, d = m - p;
    if (!(square(d) > 1e-6 * surface_.radius * surface_.radius)) return std::nullopt;
    return p + (surface_.radius / length(d)) * d;
  }

  /// Newton's iteration for: at distance R from both features, in the plane that halves a b.
  std::optional<Vec3> valley_middle(const SubdivisionFile::Edge& edge, Vec3 a, Vec3 b) const {
    const Vec3 m = 0.5 * (a + b), chord = (1 / length(b - a)) * (b - a);
    const double radius = surface_.radius;
    Vec3 c = m;
    for (int round = 0; round < 12; ++round) {
      const Vec3 p = c - foot_on(surface_.shape[edge.feature[0]], c).at,
                 q = c - foot_on(surface_.shape[edge.feature[1]], c).at;
      const double p_length = length(p), q_length = length(q);
      if (!(p_length > 0 && q_length > 0)) return std::nullopt;
      const Vec3 u = (1 / p_length) * p, v = (1 / q_length) * q;
      const double f = p_length - radius, g = q_length - radius, h = dot(c - m, chord);
      const Vec3 uv = cross(u, v), vw = cross(v, chord), wu = cross(chord, u);
      const double volume = dot(uv, chord);
      if (!(std::abs(volume) > 1e-9)) return std::nullopt;
      const Vec3 step = (1 / volume) * (f * vw + g * wu + h * uv);
      c = c - step;
      if (!(length(c - m) <= length(b - a))) return std::nullopt;
      if (length(step) <= 1e-14 * surface_.scale) return c;
    }
    return touching(edge, c) <= limit_ / 8 ? std::optional<Vec3>(c) : std::nullopt;
  }

  const SurfaceCase& surface_;
  const SubdivisionFile& file_;
  double limit_;
  std::vector<bool> on_rim_;
};

}  // namespace

std::vector<Check> check_edges(SurfaceCase& surface) {
  const std::size_t count = surface.file.edges.size();
  surface.sag.assign(count, 0), surface.bulge.assign(count, 0);
  const EdgeChecker checker(surface);
  const auto sum = tally_all<EdgeTallies>(surface.context, count, [&](std::size_t e, EdgeTallies& t) {
    checker.check(Index(e), t, surface.sag[e], surface.bulge[e]);
  });
  const Real limit = surface.tolerance;
  std::vector<Check> checks{
      sum.ends.check("edges end at vertices", limit),   sum.touch.check("edges touch their features", limit),
      sum.join.check("seams and rims in place", limit), sum.empty.check("nothing nearer to edges", limit),
      sum.shape.check("lines and circles", limit),      sum.between.check("curves between their points", limit),
      sum.outline.check("outline at distance R", limit)};
  if (sum.loose > 0) checks[5].note = std::to_string(sum.loose) + " not followed";
  return checks;
}

Check check_vertices(const SurfaceCase& surface) {
  const EdgeChecker checker(surface);
  const SubdivisionFile& file = surface.file;
  Tally sum = tally_all(surface.context, file.vertices.size(), [&](std::size_t v, Tally& t) {
    const Space<double> c(file.vertices[v]);
    t.add(checker.depth(c), surface.tolerance, place(c));
  });
  sum.add(tally_all(surface.context, file.half_edges.size(), [&](std::size_t h, Tally& t) {
    const auto& half = file.half_edges[h];
    const auto& edge = file.edges[half.edge];
    const Space<double> c(file.vertices[half.origin]);
    const std::uint64_t end = surface.forward[half.edge] == h ? edge.first : file.points_end(half.edge) - 1;
    // What ends below a rim does not touch at its height.
    if (checker.on_rim(half.origin) && surface.point(end).z < c.z - surface.tolerance) return;
    t.add(checker.touching(edge, c), surface.tolerance, place(c));
  }));
  return sum.check("vertices", surface.tolerance);
}

}  // namespace krepl::verify
