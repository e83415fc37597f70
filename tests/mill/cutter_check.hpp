#pragma once

#include <random>
#include <vector>

#include "mill/path_check.hpp"

namespace krepl::test {

/// The cutter and everything within `by` of it, but for the rims of flanks, which stay sharp.
inline Cutter thicker(const Cutter& c, double by) {
  const double diameter = c.diameter() + 2 * by;
  if (by == 0) return c;
  switch (c.kind()) {
    case Cutter::Kind::ball:
      return *Cutter::ball(diameter);
    case Cutter::Kind::flat:
      return *Cutter::bull_nose(diameter, by);
    case Cutter::Kind::bull_nose:
      return *Cutter::bull_nose(diameter, c.corner_radius() + by);
    default:
      return *Cutter::taper(diameter, c.angle(), c.corner_radius() + by);
  }
}

/// Any cutter but a ball of the radius.
inline Cutter any_cutter(std::mt19937& random, double radius) {
  const auto uniform = [&](double low, double high) { return low + (high - low) * double(random() % 100001) / 100000; };
  const double angle = random() % 2 == 0 ? 30.0 * double(1 + random() % 5) : uniform(8, 172);
  switch (random() % 4) {
    case 0:
      return *Cutter::flat(2 * radius);
    case 1:
      return *Cutter::bull_nose(2 * radius, radius * (random() % 2 == 0 ? 0.25 : uniform(0.01, 1)));
    case 2:
      return *Cutter::cone(2 * radius, angle);
    default:
      return *Cutter::taper(2 * radius, angle, radius * uniform(0.02, 0.9));
  }
}

/// A cutter over a part, with an allowance: heights of the tip relative to the part's origin, never below the floor.
class TipHeights {
 public:
  TipHeights(const std::shared_ptr<const Terrain>& part, const Cutter& cutter, double allowance, double floor)
      : cutter_(*DropCutter::build(part, thicker(cutter, allowance))), allowance_(allowance), floor_(floor) {}
  std::vector<double> at(const std::vector<Point>& places) const {
    std::vector<DropCutter::Contact> contacts(places.size());
    std::vector<double> heights;
    if (!cutter_.at(places, contacts)) return heights;
    for (const auto& contact : contacts) heights.push_back(std::max(contact.height + allowance_, floor_));
    return heights;
  }
  double at(Point place) const { return std::max(cutter_.at(place).height + allowance_, floor_); }
  /// How far a place above the surface is from it at most, in units of `distance`: whether a place of a disk about it
  /// is so high that it is within that.
  bool is_within(Point p, double z, double distance) const {
    if (z - at(p) <= distance) return true;
    constexpr int directions = 48, radii = 10;
    for (int k = 1; k <= radii; ++k)
      for (int n = 0; n < directions; ++n) {
        const double r = distance * std::sin(k * std::numbers::pi / 2 / radii),
                     angle = 2 * std::numbers::pi * n / directions;
        const double up = std::sqrt(std::max(0.0, distance * distance - r * r));
        if (z - at({p.x + r * std::cos(angle), p.y + r * std::sin(angle)}) <= up) return true;
      }
    return false;
  }

 private:
  DropCutter cutter_;
  double allowance_, floor_;
};

/// What brute force finds along a path of the tip.
struct TipCheck {
  double deepest = -1e300;  ///< below the surface of the tip
  Point3 deepest_at{}, far_at{};
  std::size_t places = 0, far = 0;  ///< how many of moves that cut are farther above it than the tolerance
};

inline TipCheck check_tip(const Terrain& part, const TipHeights& heights, const ToolPath& path, double tolerance,
                          double step, int least, const std::function<bool(const Move&)>& must_be_near) {
  const Point3 origin = part.origin();
  std::vector<Point> places;
  std::vector<double> z;
  std::vector<char> near;
  walk(path, step, least, [&](Point3 p, const Move& m) {
    places.push_back({p.x - origin.x, p.y - origin.y});
    z.push_back(p.z - origin.z);
    near.push_back(must_be_near(m));
  });
  const std::vector<double> surface = heights.at(places);
  TipCheck check;
  check.places = places.size();
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (surface[i] - z[i] > check.deepest)
      check.deepest = surface[i] - z[i], check.deepest_at = {places[i].x, places[i].y, z[i]};
    // Directions and radii of the disk are samples: they miss the nearest place by 3 % at most.
    if (near[i] && z[i] - surface[i] > tolerance && !heights.is_within(places[i], z[i], 1.03 * tolerance))
      ++check.far, check.far_at = {places[i].x, places[i].y, z[i]};
  }
  return check;
}

}  // namespace krepl::test
