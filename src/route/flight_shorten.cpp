#include "route/flight_shorten.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"

namespace krepl::route {

using namespace vectors;

namespace {

/// What is worth another point, as part of the whole.
constexpr double least_part = 1e-5;

class Shortener {
 public:
  Shortener(const FlightRules& rules, FlightProof& proof) : rules_(rules), proof_(proof) {}

  double cost(const std::vector<Point3>& points) const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) sum += rules_.cost(points[i], points[i + 1]);
    return sum;
  }

  bool allowed(Point3 a, Point3 b) { return rules_.slope_allows(a, b) && over_terrain(a, b) && proof_.free(a, b); }

  /// From every point as far ahead as a straight stretch goes: twice as far as long as that works, then by halving.
  std::vector<Point3> leave_out(const std::vector<Point3>& points) {
    std::vector<Point3> out{points.front()};
    for (std::size_t i = 0; i + 1 < points.size();) {
      std::size_t good = i + 1, bad = points.size();
      for (std::size_t ahead = 2; i + ahead < points.size(); ahead *= 2) {
        if (!worth(points, i, i + ahead)) {
          bad = i + ahead;
          break;
        }
        good = i + ahead;
      }
      if (bad == points.size() && good + 1 < bad && worth(points, i, bad - 1)) good = bad - 1;
      while (good + 1 < bad) {
        const std::size_t middle = (good + bad) / 2;
        (worth(points, i, middle) ? good : bad) = middle;
      }
      out.push_back(points[good]);
      i = good;
    }
    return out;
  }

  /// Replaces a corner by a stretch between places before and after it, as far away as is possible.
  std::vector<Point3> cut_corners(const std::vector<Point3>& points) {
    const double least_gain = least_part * cost(points);
    std::vector<Point3> out{points.front()};
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Point3 before = out.back(), corner = points[i], after = points[i + 1];
      bool cut = false;
      for (double part = 0.5; !cut && part > 0.01; part /= 2) {
        const Point3 a = corner + part * (before - corner), b = corner + part * (after - corner);
        // Smaller cuts gain still less.
        if (rules_.cost(a, corner) + rules_.cost(corner, b) - rules_.cost(a, b) < least_gain) break;
        // The stretches that are left are parts of proven ones, but for the rounding of their ends.
        if (!allowed(a, b) || !proof_.free(before, a) || !proof_.free(b, after)) continue;
        out.push_back(a), out.push_back(b);
        cut = true;
      }
      if (!cut) out.push_back(corner);
    }
    out.push_back(points.back());
    return out;
  }

 private:
  bool worth(const std::vector<Point3>& points, std::size_t i, std::size_t j) {
    double along = 0;
    for (std::size_t k = i; k < j; ++k) along += rules_.cost(points[k], points[k + 1]);
    return rules_.cost(points[i], points[j]) <= along && allowed(points[i], points[j]);
  }

  bool over_terrain(Point3 a, Point3 b) const {
    const double way = std::hypot(b.x - a.x, b.y - a.y);
    const double samples = std::ceil(2 * way / rules_.step);
    for (double i = 1; i < samples; ++i) {
      const Point3 p = a + (i / samples) * (b - a);
      if (std::isinf(proof_.rest({p.x, p.y}))) return false;
    }
    return true;
  }

  const FlightRules& rules_;
  FlightProof& proof_;
};

}  // namespace

std::vector<Point3> shorten_flight(std::vector<Point3> points, const FlightRules& rules, FlightProof& proof,
                                   const Context& context) {
  Shortener shortener(rules, proof);
  constexpr int most_rounds = 40;
  constexpr std::size_t most_points = 2000;
  double before = shortener.cost(points);
  for (int round = 0; round < most_rounds && !context.cancelled(); ++round) {
    points = shortener.leave_out(points);
    if (points.size() > most_points) break;
    points = shortener.cut_corners(points);
    const double now = shortener.cost(points);
    if (now > before * (1 - least_part)) break;
    before = now;
  }
  return shortener.leave_out(points);
}

}  // namespace krepl::route
