#include "view/surface/curve_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vectors.hpp"

namespace krepl::view {

namespace {

using Curve = input::SubdivisionFile::Curve;
using output::SurfacePatch;

constexpr int deepest = 10;          // halvings of a stretch between two given points
constexpr int root_steps = 60;       // of bisection
constexpr double most_steps = 1024;  // chords of an arc

using namespace vectors;

double distance_to_chord(Point3 p, Point3 a, Point3 b) {
  const Point3 d = b - a, w = p - a;
  const double length = dot(d, d);
  const double t = length > 0 ? std::clamp(dot(w, d) / length, 0.0, 1.0) : 0;
  const Point3 off = w - t * d;
  return std::sqrt(dot(off, off));
}

/// Keeps what the chords need of the points given (Douglas and Peucker's rule).
void thin_out(std::span<const Point3> given, double max_error, std::vector<Point3>& kept) {
  std::size_t worst = 0;
  double largest = max_error;
  for (std::size_t i = 1; i + 1 < given.size(); ++i) {
    const double off = distance_to_chord(given[i], given.front(), given.back());
    if (off > largest) largest = off, worst = i;
  }
  if (worst == 0) {
    kept.push_back(given.back());
    return;
  }
  thin_out(given.first(worst + 1), max_error, kept);
  thin_out(given.subspan(worst), max_error, kept);
}

struct Circle {
  Point3 center{}, normal{};  // it runs counter-clockwise about the normal
  double radius = 0;
};

/// Through three points in this order; radius 0 if they are in one line.
Circle circle_through(Point3 a, Point3 b, Point3 c) {
  const Point3 u = a - b, v = c - b, n = cross(v, u);
  const double area = dot(n, n);
  if (!(area > 1e-24 * dot(u, u) * dot(v, v))) return {};
  const Point3 to_center = (0.5 / area) * cross(n, dot(u, u) * v - dot(v, v) * u);
  return {b + to_center, (1 / std::sqrt(area)) * n, std::sqrt(dot(to_center, to_center))};
}

/// Puts points on a circle between a and b.
void fill_arc(const Circle& circle, Point3 a, Point3 b, double max_error, std::vector<Point3>& points) {
  const Point3 from = a - circle.center, aside = cross(circle.normal, from), to = b - circle.center;
  double angle = std::atan2(dot(to, aside), dot(to, from));
  if (angle <= 0) angle += 2 * std::numbers::pi;
  const double most = 2 * std::acos(std::max(0.0, 1 - max_error / circle.radius));
  const int steps = most > 0 ? int(std::min(most_steps, std::ceil(angle / most))) : 1;
  for (int i = 1; i < steps; ++i) {
    const double s = angle * i / steps;
    points.push_back(circle.center + std::cos(s) * from + std::sin(s) * aside);
  }
}

/// The point of a valley beside the middle of a chord, on the line across it seen
/// from above; the middle if there is none.
Point3 valley_point(Point3 a, Point3 b, const SurfacePatch& left, const SurfacePatch& right) {
  const Point3 middle = 0.5 * (a + b);
  const double across_x = -(b.y - a.y) / 2, across_y = (b.x - a.x) / 2;
  const auto gap = [&](double s) {
    const double x = middle.x + s * across_x, y = middle.y + s * across_y;
    return left.height(x, y) - right.height(x, y);
  };
  // Near by first: farther off the two patches may meet once more.
  double high = 1.0 / 64;
  while (high < 1 && gap(-high) * gap(high) > 0) high *= 2;
  double low = -high;
  const bool rises = gap(high) > gap(low);
  if (gap(low) * gap(high) > 0) return middle;
  for (int i = 0; i < root_steps; ++i) {
    const double s = (low + high) / 2;
    ((gap(s) > 0) == rises ? high : low) = s;
  }
  const double x = middle.x + low * across_x, y = middle.y + low * across_y;
  return {x, y, std::max(left.height(x, y), right.height(x, y))};
}

void fill_valley(Point3 a, Point3 b, const SurfacePatch& left, const SurfacePatch& right, double max_error, int depth,
                 std::vector<Point3>& points) {
  const Point3 p = valley_point(a, b, left, right);
  if (depth == deepest || distance_to_chord(p, a, b) <= max_error) return;
  fill_valley(a, p, left, right, max_error, depth + 1, points);
  points.push_back(p);
  fill_valley(p, b, left, right, max_error, depth + 1, points);
}

}  // namespace

std::vector<Point3> curve_points(std::span<const Point3> given, Curve curve, const SurfacePatch* left,
                                 const SurfacePatch* right, double max_error) {
  if (curve == Curve::line || given.size() < 3) return {given.front(), given.back()};
  std::vector<Point3> kept{given.front()};
  thin_out(given, max_error, kept);
  std::vector<Point3> points{kept.front()};
  Circle circle;
  if (curve == Curve::circle) {
    // A full circle has both ends at one place.
    const bool closed = dot(given.back() - given.front(), given.back() - given.front()) == 0;
    circle = closed ? circle_through(given[0], given[given.size() / 3], given[2 * given.size() / 3])
                    : circle_through(given.front(), given[given.size() / 2], given.back());
  }
  for (std::size_t i = 1; i < kept.size(); ++i) {
    if (circle.radius > 0)
      fill_arc(circle, kept[i - 1], kept[i], max_error, points);
    else if (curve != Curve::circle && left != nullptr && right != nullptr)
      fill_valley(kept[i - 1], kept[i], *left, *right, max_error, 0, points);
    points.push_back(kept[i]);
  }
  return points;
}

}  // namespace krepl::view
