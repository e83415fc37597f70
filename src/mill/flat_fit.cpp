#include "mill/flat_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vectors.hpp"

namespace krepl::mill {
namespace {

using namespace vectors;

/// The farthest end for which `fits` holds, found by doubling and halving; `first` + 1 at least.
template <class Fits>
std::size_t farthest(std::size_t first, std::size_t last, const Fits& fits) {
  std::size_t good = first + 1, step = 1;
  while (good < last) {
    const std::size_t next = std::min(last, good + step);
    if (!fits(next)) break;
    good = next, step *= 2;
  }
  for (std::size_t bad = std::min(last + 1, good + step); bad - good > 1;) {
    const std::size_t middle = good + (bad - good) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

double distance_to_segment(Point p, Point a, Point b) {
  const Point d = b - a;
  const double squared = dot(d, d);
  const double s = squared > 0 ? std::clamp(dot(p - a, d) / squared, 0.0, 1.0) : 0;
  return length(Point{a.x + s * d.x - p.x, a.y + s * d.y - p.y});
}

}  // namespace

FlatPoint FlatFit::round(Point p) const {
  const PlaneLattice& l = o_.lattice;
  return {std::llround((p.x + l.origin.x) / l.unit), std::llround((p.y + l.origin.y) / l.unit)};
}

bool FlatFit::is_line(FlatPoint start, std::size_t first, std::size_t last) const {
  const Point from = place(start), way = place(round(points_[last])) - from;
  const double far = length(way);
  if (far == 0) return false;
  for (std::size_t i = first; i <= last; ++i) {
    if (std::abs(cross(points_[i] - from, way)) > o_.within * far) return false;
    if (i > first && dot(points_[i] - points_[i - 1], way) < 0) return false;
  }
  return true;
}

/// Of the lattice points about the centre the one that is as far from both ends as can be.
FlatPoint FlatFit::centre_near(Point centre, Point start, Point end) const {
  const FlatPoint middle = round(centre);
  FlatPoint best = middle;
  double off = -1;
  for (std::int64_t i = -1; i <= 1; ++i)
    for (std::int64_t j = -1; j <= 1; ++j) {
      const FlatPoint c{middle.i + i, middle.j + j};
      const double difference = std::abs(length(start - place(c)) - length(end - place(c)));
      if (off < 0 || difference < off) best = c, off = difference;
    }
  return best;
}

bool FlatFit::find_arc(FlatPoint start, std::size_t first, std::size_t last, FlatMove& arc) const {
  if (last - first < 2 || o_.most_radius == 0) return false;
  arc.end = round(points_[last]);
  const Point p = place(start), q = place(arc.end) - p, m = points_[first + (last - first) / 2] - p;
  const double twice = 2 * cross(m, q);
  if (arc.end == start || twice == 0) return false;
  const Point centre{p.x + (dot(m, m) * q.y - dot(q, q) * m.y) / twice,
                     p.y + (dot(q, q) * m.x - dot(m, m) * q.x) / twice};
  // Small ones are no better than lines, and a controller's check of radii is relative.
  if (const double radius = length(p - centre); !(radius >= std::max(64 * o_.lattice.unit, o_.least_radius) && radius <= o_.most_radius))
    return false;
  arc.centre = centre_near(centre, p, place(arc.end));
  arc.turn = twice > 0 ? 1 : -1;
  return follows(arc, start, first, last);
}

bool FlatFit::follows(const FlatMove& arc, FlatPoint start, std::size_t first, std::size_t last) const {
  const Point c = place(arc.centre);
  const double r0 = length(place(start) - c), r1 = length(place(arc.end) - c);
  const double inner = std::max(r0, r1) - o_.within, outer = std::min(r0, r1) + o_.within;
  double sweep = 0;
  const auto turn = [&](Point a, Point b) { return arc.turn * std::atan2(cross(a - c, b - c), dot(a - c, b - c)); };
  if (turn(place(start), place(arc.end)) <= 0) return false;
  for (std::size_t i = first; i <= last; ++i) {
    if (length(points_[i] - c) > outer) return false;
    if (i == first) continue;
    if (distance_to_segment(c, points_[i - 1], points_[i]) < inner) return false;
    const double step = turn(points_[i - 1], points_[i]);
    if (step < 0) return false;
    sweep += step;
    if (sweep > std::numbers::pi) return false;
  }
  return true;
}

FlatPoint FlatFit::run(std::vector<FlatMove>& moves) {
  const std::size_t last = points_.size() - 1;
  const FlatPoint first = round(points_.front());
  FlatPoint start = first;
  for (std::size_t at = 0; at < last;) {
    FlatMove arc;
    const std::size_t by_line = farthest(at, last, [&](std::size_t end) { return is_line(start, at, end); });
    std::size_t by_arc = at;
    if (o_.most_radius > 0 && last - at > 1) {
      by_arc = farthest(at, last, [&](std::size_t end) {
        // Two segments do not tell an arc from a corner.
        return end - at < 3 || find_arc(start, at, end, arc);
      });
      if (!find_arc(start, at, by_arc, arc)) by_arc = at;
    }
    if (by_arc > by_line) {
      moves.push_back(arc);
      at = by_arc;
    } else {
      at = by_line;
      const FlatPoint end = round(points_[at]);
      if (end == start) continue;
      moves.push_back({0, end, {}});
    }
    start = moves.back().end;
  }
  return first;
}

}  // namespace krepl::mill
