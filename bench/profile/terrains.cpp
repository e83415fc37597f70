#include "terrains.hpp"

#include <cmath>
#include <cstdint>

namespace krepl::bench {

namespace {

class Random {
 public:
  double real() { return double(next() >> 11) * 0x1p-53; }
  int below(int n) { return int(next() % std::uint64_t(n)); }

 private:
  std::uint64_t next() {  // splitmix64
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_ = 20060401;
};

/// Step from one point to the next; u in [0, 1) is how far along the whole.
Point step(Kind kind, Point p, std::size_t i, double u, std::size_t n, Random& random) {
  const double x = p.x + 1;
  switch (kind) {
    case Kind::rough: return {p.x + 0.5 + random.real(), 2 * random.real() - 1};
    case Kind::walk: return {p.x + 0.5 + random.real(), p.y + 2 * random.real() - 1};
    case Kind::smooth: return {x, 20 * std::sin(x / 50) + 3 * std::sin(x / 7)};
    case Kind::flat: return {x, 0};
    case Kind::convex: {  // a quarter of an ellipse and its mirror image, all turns alike in size
      const double a = std::acos(-1.0) * (1 - u);
      return {double(n) * (1 + std::cos(a)) / 2, double(n) * std::sin(a) / 2};
    }
    case Kind::concave: {
      const double a = std::acos(-1.0) * (1 - u);
      return {double(n) * (1 + std::cos(a)) / 2, -double(n) * std::sin(a) / 2};
    }
    case Kind::grooves: return {p.x + 0.5, i % 2 == 0 ? -10.0 : random.real()};
    case Kind::integer: return {x, p.y + random.below(3) - 1};
    case Kind::plateaus: return {x, random.below(5) == 0 ? double(random.below(5)) : p.y};
    case Kind::cliffs: return {p.x + random.below(3), double(random.below(7))};
  }
  return p;
}

}  // namespace

const char* name(Kind kind) {
  constexpr const char* names[] = {"rough",   "walk",    "smooth",  "flat",     "convex",
                                   "concave", "grooves", "integer", "plateaus", "cliffs"};
  return names[int(kind)];
}

const std::vector<Point>& terrain(Kind kind, std::size_t segments) {
  static std::vector<Point> points;
  static Kind last = Kind::flat;
  if (!points.empty() && last == kind && points.size() == segments + 1) return points;
  last = kind;
  points.clear();
  points.reserve(segments + 1);
  Random random;
  Point p{0, 0};
  for (std::size_t i = 0; i <= segments; ++i) {
    points.push_back(p);
    p = step(kind, p, i, double(i + 1) / double(segments), segments, random);
  }
  return points;
}

}  // namespace krepl::bench
