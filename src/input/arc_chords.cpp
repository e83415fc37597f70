#include "input/arc_chords.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/vectors.hpp"

namespace krepl::input {
namespace {

constexpr double pi = std::numbers::pi;

using namespace vectors;
Point turned(Point d, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {d.x * c - d.y * s, d.x * s + d.y * c};
}

}  // namespace

std::optional<ArcChords> ArcChords::through(Point start, Point middle, Point end) {
  ArcChords arc;
  if (middle == start || middle == end) return std::nullopt;
  if (start == end) {
    arc.first_ = arc.last_ = start;
    arc.reversed_ = false;
    arc.left_turn_ = true;
    arc.angle_ = 2 * pi;
    arc.center_ = {start.x + (middle.x - start.x) / 2, start.y + (middle.y - start.y) / 2};
    arc.radius_ = std::hypot(middle.x - start.x, middle.y - start.y) / 2;
    return arc;
  }
  arc.reversed_ = end.x < start.x || (end.x == start.x && end.y < start.y);
  if (arc.reversed_) std::swap(start, end);
  arc.first_ = start;
  arc.last_ = end;
  // Half the arc is what the angle at the middle point lacks to 180 degrees (inscribed angles): exact for flat arcs
  // too.
  const Point u = middle - start, v = end - middle, chord = end - start;
  const double turn = cross(u, v);
  if (turn == 0) return std::nullopt;
  arc.left_turn_ = turn > 0;
  arc.angle_ = 2 * std::atan2(std::abs(turn), dot(u, v));
  const double d = 2 * cross(u, chord), uu = dot(u, u), cc = dot(chord, chord);
  arc.center_ = {start.x + (chord.y * uu - u.y * cc) / d, start.y + (u.x * cc - chord.x * uu) / d};
  arc.radius_ = (std::hypot(start.x - arc.center_.x, start.y - arc.center_.y) +
                 std::hypot(end.x - arc.center_.x, end.y - arc.center_.y)) /
                2;
  if (!std::isfinite(arc.radius_)) return std::nullopt;
  return arc;
}

double ArcChords::count(double max_error) const {
  // A chord over the angle s deviates by 2 r sin^2(s/4).
  const double step = std::min(pi / 2, 4 * std::asin(std::sqrt(std::min(1.0, max_error / (2 * radius_)))) * (1 - 1e-9));
  return std::min(0x1p40, std::ceil(angle_ / step));
}

double ArcChords::deviation(double count) const {
  const double s = std::sin(angle_ / count / 4);
  return 2 * radius_ * s * s;
}

/// By the chord from the first end: its length is that of the whole chord times a ratio of sines, its direction off by
/// half of the rest of the arc. That needs no centre, which is far away and uncertain where the arc is flat.
Point ArcChords::at(double fraction) const {
  const double sense = left_turn_ ? 1 : -1;
  if (angle_ > pi) {
    const Point d = turned(first_ - center_, sense * fraction * angle_);
    const double scale = radius_ / std::hypot(d.x, d.y);
    return {center_.x + d.x * scale, center_.y + d.y * scale};
  }
  const double ratio = std::sin(fraction * angle_ / 2) / std::sin(angle_ / 2);
  const Point d = turned(last_ - first_, -sense * (1 - fraction) * angle_ / 2);
  return {first_.x + d.x * ratio, first_.y + d.y * ratio};
}

void ArcChords::append_inner_ends(std::size_t count, std::vector<Point>& out) const {
  for (std::size_t i = 1; i < count; ++i) {
    const std::size_t k = reversed_ ? count - i : i;
    out.push_back(at(static_cast<double>(k) / static_cast<double>(count)));
  }
}

}  // namespace krepl::input
