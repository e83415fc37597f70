#include "route/axis_edge.hpp"

namespace krepl::route {

double AxisEdge::Site::distance(Point p) const {
  return is_vertex ? route::distance(p, a) : std::abs(cross(direction, p - a));
}

AxisEdge::Site AxisEdge::site_of(const VoronoiDiagram::Site& site, const Network& network) {
  const auto vertices = network.vertices();
  if (site.is_vertex) return {true, vertices[site.index] + network.origin(), {}};
  const Network::Segment s = network.segments()[site.index];
  const Point d = vertices[s.b] - vertices[s.a];
  return {false, vertices[s.a] + network.origin(), (1 / route::length(d)) * d};
}

AxisEdge::AxisEdge(const VoronoiDiagram::Edge& edge, const Network& network)
    : parabolic_(edge.parabolic),
      left_(site_of(edge.left, network)),
      right_(site_of(edge.right, network)),
      from_(edge.start),
      to_(edge.end) {
  if (parabolic_) {
    const Site& vertex = left_.is_vertex ? left_ : right_;
    const Site& line = left_.is_vertex ? right_ : left_;
    focus_ = vertex.a, direction_ = line.direction;
    focus_vertex_ = (edge.left.is_vertex ? edge.left : edge.right).index;
    directrix_ = (edge.left.is_vertex ? edge.right : edge.left).index;
    const double side = cross(line.direction, focus_ - line.a);
    focal_ = std::abs(side);
    apex_axis_ = (side > 0 ? -1 : 1) * right(direction_);
    start_ = dot(from_ - focus_, direction_), end_ = dot(to_ - focus_, direction_);
    // Straight: a focus on its directrix, and what is too short to have a bend.
    parabolic_ = focal_ > 0 && distance(from_, to_) > 0x1p-30 * distance(from_, focus_);
  }
  if (!parabolic_) {
    const double size = distance(from_, to_);
    direction_ = size > 0 ? (1 / size) * (to_ - from_) : Point{1, 0};
    start_ = 0, end_ = size;
  }
}

double AxisEdge::parameter(Point p) const {
  const auto [low, high] = std::minmax(start_, end_);
  return std::clamp(dot(p - (parabolic_ ? focus_ : from_), direction_), low, high);
}

double AxisEdge::residual(Point p) const { return distance(p, place(parameter(p))); }

Point AxisEdge::place(double t) const {
  if (t == start_) return from_;
  if (t == end_) return to_;
  if (!parabolic_) return from_ + t * direction_;
  return focus_ + t * direction_ + ((t * t / focal_ - focal_) / 2) * apex_axis_;
}

Point AxisEdge::control(double t0, double t1) const {
  return focus_ + ((t0 + t1) / 2) * direction_ + ((t0 * (t1 / focal_) - focal_) / 2) * apex_axis_;
}

double AxisEdge::clearance(double t0, double t1) const {
  if (parabolic_) {
    if ((t0 < 0) != (t1 < 0)) return focal_ / 2;  // the apex
    return std::min(distance(place(t0), focus_), distance(place(t1), focus_));
  }
  const Point a = place(t0), b = place(t1);
  for (const Site* site : {&left_, &right_})
    if (site->is_vertex) return distance_to_segment(site->a, a, b);
  return std::min(left_.distance(a), left_.distance(b));
}

/// Of y = u^2 / 2p from the apex: the integral of sqrt(1 + (u/p)^2).
double AxisEdge::along_parabola(double u) const {
  const double s = u / focal_;
  return (u * std::sqrt(1 + s * s) + focal_ * std::asinh(s)) / 2;
}

double AxisEdge::length(double t0, double t1) const {
  return parabolic_ ? std::abs(along_parabola(t1) - along_parabola(t0)) : std::abs(t1 - t0);
}

}  // namespace krepl::route
