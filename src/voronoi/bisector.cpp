#include "voronoi/bisector.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::voronoi {
namespace {

Vector<double> vector(Point p) { return {p.x, p.y}; }

}  // namespace

Bisector::Bisector(const Network& network, const VoronoiDiagram::Edge& edge, Point start, Point end)
    : start_clearance_(edge.start_clearance), end_clearance_(edge.end_clearance), first_(start), last_(end) {
  const auto vertices = network.vertices();
  const Vector<double> p = vector(start), q = vector(end);
  if (edge.parabolic) {
    parabola_ = true;
    const auto& side = edge.left.is_vertex ? edge.right : edge.left;
    const Vector<double> focus = vector(vertices[edge.left.is_vertex ? edge.left.index : edge.right.index]);
    const auto s = network.segments()[side.index];
    const Vector<double> a = vector(vertices[s.a]), d = vector(vertices[s.b]) - a;
    const double l = length(d);
    along_ = {d.x / l, d.y / l};
    up_ = side.side == 0 ? Vector<double>{along_.y, -along_.x} : Vector<double>{-along_.y, along_.x};
    height_ = dot(focus - a, up_);
    origin_ = focus - height_ * up_;
  } else if (edge.left.is_vertex && edge.right.is_vertex) {
    two_vertices_ = true;
    const Vector<double> a = vector(vertices[edge.left.index]), b = vector(vertices[edge.right.index]);
    const double l = length(b - a);
    height_ = l / 2;
    up_ = {(b.x - a.x) / l, (b.y - a.y) / l};
    along_ = {up_.y, -up_.x};
    origin_ = {(a.x + b.x) / 2, (a.y + b.y) / 2};
  } else {
    const double l = length(q - p);
    origin_ = p;
    along_ = l > 0 ? Vector<double>{(q.x - p.x) / l, (q.y - p.y) / l} : Vector<double>{1, 0};
  }
  start_ = dot(p - origin_, along_);
  end_ = dot(q - origin_, along_);
}

Point Bisector::at(double x) const {
  if (x == start_) return first_;
  if (x == end_) return last_;
  const double y = parabola_ ? (x * x + height_ * height_) / (2 * height_) : 0;
  return {origin_.x + x * along_.x + y * up_.x, origin_.y + x * along_.y + y * up_.y};
}

bool Bisector::clip(double most, double& from, double& to) const {
  from = start_, to = end_;
  if (parabola_ || two_vertices_) {
    const double square = parabola_ ? height_ * (2 * most - height_) : (most - height_) * (most + height_);
    if (!(square > 0)) return false;
    const double half = std::sqrt(square);
    from = std::clamp(from, -half, half), to = std::clamp(to, -half, half);
    return from != to;
  }
  // The clearance is linear.
  if (start_clearance_ > most && end_clearance_ > most) return false;
  const double rise = end_clearance_ - start_clearance_;
  const double place = rise != 0 ? start_ + (end_ - start_) * ((most - start_clearance_) / rise) : start_;
  if (start_clearance_ > most) from = place;
  if (end_clearance_ > most) to = place;
  return from != to;
}

std::optional<Point> Bisector::control_point(double max_clearance) const {
  double from = 0, to = 0;
  if (!parabola_ || !clip(max_clearance, from, to)) return std::nullopt;
  // The tangents of y = (x^2 + h^2) / 2h at two places meet halfway between them.
  const double x = (from + to) / 2, y = from * to / (2 * height_) + height_ / 2;
  return Point{origin_.x + x * along_.x + y * up_.x, origin_.y + x * along_.y + y * up_.y};
}

std::vector<Point> Bisector::points(double max_error, double max_clearance) const {
  double from = 0, to = 0;
  if (!clip(max_clearance, from, to)) return {};
  // A chord over a stretch w of the parabola y = x^2 / 2h deviates from it by w^2 / 8h at most; 2^20 points are enough
  // for all.
  double steps = 1;
  if (parabola_) steps = std::clamp(std::ceil(std::abs(to - from) / std::sqrt(8 * height_ * max_error)), 1.0, 0x1p20);
  std::vector<Point> points{at(from)};
  for (double i = 1; i < steps; ++i) points.push_back(at(from + (to - from) * (i / steps)));
  points.push_back(at(to));
  return points;
}

}  // namespace krepl::voronoi
