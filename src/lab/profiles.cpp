#include "lab/profiles.hpp"

#include <cmath>

namespace krepl::lab {

namespace {

/// Points of a circle about the origin, in equal steps from left to right.
std::vector<Point> half_circle(std::size_t segments, double size, double side) {
  constexpr double from = 0.3, to = 2.8;  // radians, from the left
  std::vector<Point> points;
  for (std::size_t i = 0; i <= segments; ++i) {
    const double a = from + (to - from) * double(i) / double(segments);
    points.push_back({-size * std::cos(a), side * size * std::sin(a)});
  }
  return points;
}

}  // namespace

ProfileConstruction convex_chain(std::size_t n) {
  return {"convex-chain", "2n + 2 vertices, the most", half_circle(n, 10, 1), 1, 2 * n + 2, 0};
}

ProfileConstruction bowl(std::size_t n) {
  return {"bowl", "n - 1 explicit vertices, the most", half_circle(n, 10, -1), 5, n + 3, n - 1};
}

ProfileConstruction pit(std::size_t n) {
  // Ends at the same height, 1 apart; all between is below the disk that touches both.
  std::vector<Point> points = half_circle(n, 1, -1);
  const double left = points.front().x, right = points.back().x;
  for (Point& p : points) p = {(p.x - left) / (right - left), 3 * p.y};
  points.front().y = points.back().y = 0;
  return {"pit", "3 vertices, the fewest", std::move(points), 1, 3, 1};
}

}  // namespace krepl::lab
