#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "krepl/drop_cutter.hpp"
#include "krepl/mill.hpp"

namespace krepl::test {

/// Calls visit(place of the centre, move) at points of a path at most `step` apart, and at least `least` of each move.
/// Arcs are run as controllers do: the radius changes evenly from that at the start to that at the end.
inline void walk(const ToolPath& path, double step, int least, const std::function<void(Point3, const Move&)>& visit) {
  Point3 at = path.start;
  for (const Move& m : path.moves) {
    const bool arc = m.kind == MoveKind::clockwise || m.kind == MoveKind::counter_clockwise;
    if (!arc) {
      const double length = std::hypot(m.end.x - at.x, m.end.y - at.y, m.end.z - at.z);
      const int n = std::max(least, int(std::ceil(length / step)));
      for (int i = 0; i <= n; ++i) {
        const double s = double(i) / n;
        visit(i == n ? m.end
                     : Point3{at.x + s * (m.end.x - at.x), at.y + s * (m.end.y - at.y), at.z + s * (m.end.z - at.z)},
              m);
      }
    } else {
      // First and second axis of the plane: X Y, Z X, Y Z, so that counter-clockwise turns the first into the second.
      const auto first = [&](Point3 p) { return m.plane == ArcPlane::xy ? p.x : m.plane == ArcPlane::zx ? p.z : p.y; };
      const auto second = [&](Point3 p) { return m.plane == ArcPlane::xy ? p.y : m.plane == ArcPlane::zx ? p.x : p.z; };
      const double a0 = first(at) - first(m.centre), b0 = second(at) - second(m.centre);
      const double a1 = first(m.end) - first(m.centre), b1 = second(m.end) - second(m.centre);
      const double r0 = std::hypot(a0, b0), r1 = std::hypot(a1, b1), from = std::atan2(b0, a0);
      double turn = std::atan2(b1, a1) - from;
      const double full = 2 * std::numbers::pi;
      if (m.kind == MoveKind::counter_clockwise && turn <= 0) turn += full;
      if (m.kind == MoveKind::clockwise && turn >= 0) turn -= full;
      const int n = std::max(least, int(std::ceil(std::abs(turn) * r0 / step)));
      for (int i = 0; i <= n; ++i) {
        const double s = double(i) / n, r = r0 + s * (r1 - r0), angle = from + s * turn;
        const double a = first(m.centre) + r * std::cos(angle), b = second(m.centre) + r * std::sin(angle);
        Point3 p{at.x + s * (m.end.x - at.x), at.y + s * (m.end.y - at.y), at.z + s * (m.end.z - at.z)};  // helices: evenly along the axis
        if (m.plane == ArcPlane::xy)
          p.x = a, p.y = b;
        else if (m.plane == ArcPlane::zx)
          p.z = a, p.x = b;
        else
          p.y = a, p.z = b;
        visit(i == n ? m.end : p, m);
      }
    }
    at = m.end;
  }
}

/// What brute force finds along a path.
struct PathCheck {
  double deepest = -1e300;  ///< how far the centre is below the surface of the part and the ball, at worst
  double highest = -1e300;  ///< of moves that cut, how far above that of the ball and the tolerance
  Point3 deepest_at{}, highest_at{};
  std::size_t places = 0;
};

/// Drops a ball of radius `radius` at places along the path, and one of radius `outer`: a centre is within outer -
/// radius of the surface if it is below that of the larger ball. Moves for which `links` are also those up, down and
/// across between cuts.
inline PathCheck check_path(const Terrain& part, std::shared_ptr<const Terrain> shared, const ToolPath& path,
                            double radius, double outer, double floor, double step, int least,
                            const std::function<bool(const Move&)>& must_be_near) {
  const auto cutter = DropCutter::build(std::move(shared), radius);
  const auto larger = cutter->with_radius(outer);
  const Point3 origin = part.origin();
  std::vector<Point> places;
  std::vector<double> heights;
  std::vector<char> near;
  walk(path, step, least, [&](Point3 p, const Move& m) {
    places.push_back({p.x - origin.x, p.y - origin.y});
    heights.push_back(p.z - origin.z);
    near.push_back(must_be_near(m));
  });
  std::vector<DropCutter::Contact> inner(places.size()), beyond(places.size());
  PathCheck check;
  check.places = places.size();
  if (!cutter->at(places, inner) || !larger->at(places, beyond)) return check;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double low = std::max(inner[i].height, floor), high = std::max(beyond[i].height, floor + (outer - radius));
    if (low - heights[i] > check.deepest)
      check.deepest = low - heights[i], check.deepest_at = {places[i].x, places[i].y, heights[i]};
    if (near[i] && heights[i] - high > check.highest)
      check.highest = heights[i] - high, check.highest_at = {places[i].x, places[i].y, heights[i]};
  }
  return check;
}

}  // namespace krepl::test
