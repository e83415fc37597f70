#include "section/edge_course.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "terrain/curve.hpp"

namespace krepl::section {

using namespace vectors;
using FeatureKind = Terrain::FeatureKind;

EdgeCourse::EdgeCourse(const Parts& parts, Index e) : surface_(*parts.surface), edge_(surface_.edge(e)) {
  const Subdivision& topology = parts.topology();
  Point3 a = surface_.vertex(topology.origin[2 * e]), b = surface_.vertex(topology.origin[2 * e + 1]);
  const bool is_rim = edge_.kind == Surface::EdgeKind::rim;
  if (edge_.curve == Surface::Curve::line && !is_rim) {
    a.z = parts.corner_height(2 * e);  // it may end at the foot of a wall
    b.z = parts.corner_height(2 * e + 1);
    samples_ = {a, b};
    return;
  }
  // A level or a line crosses a circle or an ellipse twice at most, but other curves, and what is below a rim, more
  // often.
  const bool twisted = !surface_.guides(e).empty() || edge_.curve == Surface::Curve::quartic;
  const double arc = distance(a, b) / surface_.radius();
  samples_ = surface_.curve(e, twisted ? 33 : std::clamp(5 + int(std::min(16 * arc, 12.0)), 5, 17));
  for (std::size_t i = 1; i < samples_.size(); ++i) length_ += distance(samples_[i - 1], samples_[i]);
  if (!is_rim && edge_.curve == Surface::Curve::circle)
    find_circle(topology.origin[2 * e] == topology.origin[2 * e + 1]);
  if (!is_rim && (edge_.curve == Surface::Curve::ellipse || edge_.curve == Surface::Curve::quartic)) find_around();
  if (!circle_ && !around_) return;
  for (std::size_t i = 1; i + 1 < samples_.size(); ++i) samples_[i] = at(double(i) / double(samples_.size() - 1));
}

/// Through both ends and the middle sample; the features only say how large it is.
void EdgeCourse::find_circle(bool is_closed) {
  const Terrain& terrain = surface_.terrain();
  const double radius = surface_.radius();
  auto f = terrain.corners(edge_.feature[0]), g = terrain.corners(edge_.feature[1]);
  if (f.count > g.count) std::swap(f, g);
  if (f.count != 1) return;  // two edges in one line share the circle about a point between them
  const Point3 centre = f.point[0];
  Circle circle{centre, {}, {}, 0, 0};
  Point3 axis;
  double off = 0;  // of the circle's plane from the sphere's centre
  if (g.count == 2) {
    if (edge_.kind != Surface::EdgeKind::seam) return;
    axis = unit(g.point[1] - g.point[0]);
  } else if (g.count == 1) {
    axis = unit(g.point[0] - centre);
    off = distance(g.point[0], centre) / 2;
  } else {
    axis = unit(cross(g.point[1] - g.point[0], g.point[2] - g.point[0]));
    if (axis.z < 0) axis = -1.0 * axis;
    off = radius - dot(centre - g.point[0], axis);
  }
  const double square = (radius - off) * (radius + off);
  if (!(square > 0)) return;
  circle.centre = centre + off * axis;
  const Point3 start = samples_.front() - circle.centre;
  const Point3 u = start - dot(start, axis) * axis;
  if (!(length(u) > 0)) return;
  circle.u = std::sqrt(square) * unit(u);
  circle.v = cross(axis, circle.u);
  const auto angle = [&](Point3 p) {
    const double t = std::atan2(dot(p - circle.centre, circle.v), dot(p - circle.centre, circle.u));
    return t < 0 ? t + 2 * std::numbers::pi : t;
  };
  const double turn = 2 * std::numbers::pi, middle = angle(samples_[samples_.size() / 2]);
  if (is_closed) {
    circle.to = angle(samples_[samples_.size() / 4]) < middle ? turn : -turn;
  } else {
    // Of the two arcs between the ends the one that is as long as the samples tell; half circles go through the middle
    // one.
    const double end = angle(samples_.back()), arc = length_ / length(circle.u);
    const bool is_half = std::abs(end - std::numbers::pi) < 0.5;
    const bool forwards = is_half ? middle <= end : std::abs(end - arc) < std::abs(turn - end - arc);
    circle.to = forwards ? end : end - turn;
  }
  circle_ = circle;
}

void EdgeCourse::find_around() {
  std::optional<Around> found;
  for (const int side : {0, 1}) {
    const auto next = around(side, samples_);
    if (next && (!found || std::abs(next->to - next->from) > std::abs(found->to - found->from))) found = next;
  }
  around_ = found;
}

/// By the angle around one of the edges that the ball touches, if it goes one way only.
std::optional<EdgeCourse::Around> EdgeCourse::around(int side, const std::vector<Point3>& guides) const {
  const Terrain& terrain = surface_.terrain();
  const auto own = terrain.corners(edge_.feature[std::size_t(side)]),
             other = terrain.corners(edge_.feature[std::size_t(1 - side)]);
  if (own.count != 2 || samples_.front() == samples_.back()) return std::nullopt;
  Around a;
  a.at = own.point[0];
  a.along = unit(own.point[1] - own.point[0]);
  const double flat = std::hypot(a.along.x, a.along.y);
  a.left = {-a.along.y / flat, a.along.x / flat, 0};
  a.up = cross(a.along, a.left);
  a.other_kind = other.count == 1 ? FeatureKind::vertex : other.count == 2 ? FeatureKind::edge : FeatureKind::face;
  a.other_at = other.point[0];
  if (other.count == 2) a.other_direction = unit(other.point[1] - other.point[0]);
  if (other.count == 3) {
    a.other_direction = unit(cross(other.point[1] - other.point[0], other.point[2] - other.point[0]));
    if (a.other_direction.z < 0) a.other_direction = -1.0 * a.other_direction;
  }
  const auto angle = [&](Point3 p) { return std::atan2(std::max(0.0, dot(p - a.at, a.up)), dot(p - a.at, a.left)); };
  a.from = angle(guides.front());
  a.to = angle(guides.back());
  if (std::abs(a.to - a.from) < 1e-6) return std::nullopt;
  for (const Point3 p : guides) {
    const double t = angle(p);
    if (!a.guides.empty() && (t > a.guides.back().first) != (a.to > a.from)) {
      if (edge_.curve == Surface::Curve::quartic) return std::nullopt;
      continue;  // an ellipse goes one way always, and only points found on it may not
    }
    a.guides.push_back({t, dot(p - a.at, a.along)});
  }
  if (edge_.curve == Surface::Curve::quartic) a.branch = branch(a);
  return a;
}

double EdgeCourse::Around::expected(double angle) const {
  const bool ascending = to > from;
  const auto after = std::find_if(guides.begin() + 1, guides.end() - 1,
                                  [&](const auto& g) { return ascending ? g.first >= angle : g.first <= angle; });
  const auto [a, place_a] = after[-1];
  const auto [b, place_b] = *after;
  return place_a + std::clamp((angle - a) / (b - a), 0.0, 1.0) * (place_b - place_a);
}

std::optional<EdgeCourse::Places> EdgeCourse::places(const Around& a, double angle) const {
  const double radius = surface_.radius();
  const Point3 base = a.at + (radius * std::cos(angle)) * a.left + (radius * std::sin(angle)) * a.up;
  Point3 w = base - a.other_at, d = a.along;
  if (a.other_kind == FeatureKind::face) {
    const double rate = dot(d, a.other_direction);
    if (rate == 0) return std::nullopt;
    const double place = (radius - dot(w, a.other_direction)) / rate;
    return Places{base, place, place};
  }
  if (a.other_kind == FeatureKind::edge) {
    w = w - dot(w, a.other_direction) * a.other_direction;
    d = d - dot(d, a.other_direction) * a.other_direction;
  }
  const double square = dot(d, d), half = dot(w, d), rest = dot(w, w) - radius * radius;
  const double root = std::sqrt(std::max(0.0, half * half - square * rest));
  return Places{base, (root - half) / square, (-root - half) / square};
}

/// Where the two are farthest apart the samples tell which one is meant.
int EdgeCourse::branch(const Around& a) const {
  double farthest = 0;
  int result = 0;
  for (const auto& [angle, place] : a.guides) {
    const auto found = places(a, angle);
    if (!found || found->larger - found->smaller <= farthest) continue;
    farthest = found->larger - found->smaller;
    result = std::abs(place - found->larger) < std::abs(place - found->smaller) ? 1 : -1;
  }
  return result;
}

std::optional<Point3> EdgeCourse::on_cylinder(double s) const {
  const Around& a = *around_;
  const double angle = a.from + s * (a.to - a.from);
  const auto found = places(a, angle);
  if (!found) return std::nullopt;
  const double expected = a.branch == 0 ? a.expected(angle) : 0;
  const bool larger =
      a.branch != 0 ? a.branch > 0 : std::abs(found->larger - expected) < std::abs(found->smaller - expected);
  return found->base + (larger ? found->larger : found->smaller) * a.along;
}

Point3 EdgeCourse::projected(Point3 near, double reach) const {
  const Point3 p = terrain::project_to_curve(surface_.terrain(), surface_.radius(), edge_, near, reach);
  return distance(p, near) > reach ? near : p;
}

Point3 EdgeCourse::at(double s) const {
  if (s <= 0) return samples_.front();
  if (s >= 1) return samples_.back();
  // What the closed forms lose in digits where surfaces are nearly tangent is got back, as long as that is little.
  constexpr double little = 1e-6;
  if (circle_) {
    const double angle = circle_->from + s * (circle_->to - circle_->from);
    return projected(circle_->centre + std::cos(angle) * circle_->u + std::sin(angle) * circle_->v, little * length_);
  }
  if (around_) {
    if (const auto p = on_cylinder(s)) return projected(*p, little * length_);
  }
  const double place = s * double(samples_.size() - 1);
  const std::size_t i = std::min(std::size_t(place), samples_.size() - 2);
  const double t = place - double(i);
  if (t <= 0) return samples_[i];
  const Point3 near = samples_[i] + t * (samples_[i + 1] - samples_[i]);
  if (edge_.curve == Surface::Curve::line) return near;
  return projected(near, length_);
}

}  // namespace krepl::section
