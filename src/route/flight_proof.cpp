#include "route/flight_proof.hpp"

#include <cmath>

#include "kernel/vectors.hpp"

namespace krepl::route {

using namespace vectors;

namespace {
/// Stretches shorter than this part of the radius are needed only near places that touch, few for each.
constexpr double short_stretch = 1.0 / 32;
constexpr int most_short_stretches = 400;
}  // namespace

double FlightProof::height(Point p, double radius) {
  ++counters_.drops;
  if (radius == radius_) return cutter_.at(p).height;
  const Result<DropCutter> other = cutter_.with_radius(radius);
  return other ? other->at(p).height : std::numeric_limits<double>::infinity();
}

bool FlightProof::free(Point3 p, double radius) { return height({p.x, p.y}, radius) <= p.z; }

/// The swept ball is the balls about both ends and a cylinder; the cylinder about half a length l lies in the ball of
/// radius sqrt(r^2 + l^2) about the middle.
bool FlightProof::free_inside(Point3 a, Point3 b, double radius, int& patience) {
  const Point3 middle = 0.5 * (a + b);
  const double half = 0.5 * distance(a, b);
  if (free(middle, std::hypot(radius, half))) return true;
  if (half < short_stretch * radius && --patience < 0) return false;
  if (!free(middle, radius)) return false;
  return free_inside(a, middle, radius, patience) && free_inside(middle, b, radius, patience);
}

bool FlightProof::free(Point3 a, Point3 b, double radius) {
  ++counters_.proofs;
  if (!free(a, radius) || !free(b, radius)) return false;
  // Straight above a free place everything is free.
  if (a.x == b.x && a.y == b.y) return true;
  int patience = most_short_stretches;
  return free_inside(a, b, radius, patience);
}

bool FlightProof::free(std::span<const Point3> points, double radius) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (!free(points[i], points[i + 1], radius)) return false;
  return true;
}

double FlightProof::clearance(std::span<const Point3> points) {
  double low = radius_ - tolerance_, high = 2 * radius_;
  // Ends usually rest on the terrain, and then there is nothing to look for.
  for (const Point3& p : {points.front(), points.back()})
    if (!free(p, radius_ + tolerance_)) return free(points, radius_) ? radius_ : low;
  while (high < 1e6 * radius_ && free(points, high)) low = high, high *= 2;
  while (high - low > 1e-4 * radius_) {
    const double middle = (low + high) / 2;
    (free(points, middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace krepl::route
