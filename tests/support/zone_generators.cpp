#include "support/zone_generators.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "support/byte_reader.hpp"

namespace krepl::test {

namespace {

// Half grid steps, half diagonals, half knight's moves: where zones of grid vertices touch; and both ends of the range.
double grid_radius(ByteReader& in) {
  static const std::array<double, 20> table{0.5,
                                            1,
                                            1.5,
                                            2,
                                            2.5,
                                            5,
                                            std::sqrt(0.5),
                                            std::sqrt(2.0),
                                            std::sqrt(1.25),
                                            std::sqrt(5.0),
                                            0.25,
                                            0.125,
                                            0.3,
                                            0.77,
                                            3.25,
                                            6.5,
                                            7.5,
                                            100,
                                            1e5,
                                            1e-4};
  return table[in.below(table.size())];
}

void grid_lines(ByteReader& in, ZoneCase& c) {
  c.radius = grid_radius(in);
  std::vector<Point> v{in.grid()};
  while (in.more()) {
    if (in.below(5) == 1) c.parts.push_back(line(std::move(v))), v.clear();
    v.push_back(in.grid());
  }
  c.parts.push_back(line(std::move(v)));
}

void grid_points(ByteReader& in, ZoneCase& c) {
  c.radius = grid_radius(in);
  do {
    const Point p = in.grid();
    c.parts.push_back(point(p.x, p.y));
  } while (in.more());
}

void streets(ByteReader& in, ZoneCase& c) {
  const double block = 1 + in.below(16);
  const unsigned nx = 1 + in.below(6), ny = 1 + in.below(6);
  const double slope = in.below(3) == 0 ? 0 : in.unit() * 2;
  c.radius = block / 2;
  const unsigned steps = in.below(5);
  for (unsigned k = 0; k < steps; ++k) c.radius = std::nextafter(c.radius, in.below(2) ? 1e9 : 0);
  if (in.below(4) == 3) c.radius *= 0.25 + in.unit();
  const auto at = [&](double i, double j) {
    return Point{block * (i * std::cos(slope) - j * std::sin(slope)),
                 block * (i * std::sin(slope) + j * std::cos(slope))};
  };
  for (unsigned i = 0; i <= nx; ++i) c.parts.push_back(line({at(i, 0), at(i, ny)}));
  for (unsigned j = 0; j <= ny; ++j) {
    std::vector<Point> v;  // with its crossings as vertices
    for (unsigned i = 0; i <= nx; ++i) v.push_back(at(i, j));
    c.parts.push_back(line(std::move(v)));
  }
}

Point between(Point a, Point b, double t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }

void on_segments(ByteReader& in, ZoneCase& c) {
  c.radius = grid_radius(in);
  std::vector<std::pair<Point, Point>> segments{{in.grid(), in.grid()}};
  do {
    const auto on = [&] {
      const auto& [a, b] = segments[in.below(unsigned(segments.size()))];
      return between(a, b, in.unit());
    };
    const Point a = on();
    segments.emplace_back(a, in.below(2) ? in.grid() : on());
  } while (in.more() && segments.size() < 60);
  for (const auto& [a, b] : segments) c.parts.push_back(line({a, b}));
}

void collinear(ByteReader& in, ZoneCase& c) {
  c.radius = grid_radius(in);
  const Point a = in.grid(), b = in.grid();
  do {
    std::vector<Point> v;
    for (unsigned k = 0, n = 1 + in.below(4); k < n; ++k) v.push_back(between(a, b, in.below(13) / 12.0));
    c.parts.push_back(line(std::move(v)));
  } while (in.more());
}

void tangent(ByteReader& in, ZoneCase& c) {
  static constexpr std::array<std::array<int, 3>, 4> triples{{{1, 0, 1}, {3, 4, 5}, {5, 12, 13}, {-8, 15, 17}}};
  const auto& t = triples[in.below(4)];
  // Along (t0, t1), apart by multiples of R along its left normal; exact in integers.
  const double half = 1 + in.below(4);
  c.radius = half * t[2];
  do {
    const double along = int(in.below(31)) - 15, apart = int(in.below(7)) - 3, length = in.below(9);
    const Point a{along * t[0] - half * 2 * apart * t[1], along * t[1] + half * 2 * apart * t[0]};
    c.parts.push_back(line({a, {a.x + length * t[0], a.y + length * t[1]}}));
  } while (in.more());
}

void cocircular(ByteReader& in, ZoneCase& c) {
  // Integer points on the circle of radius 65.
  static constexpr std::array<std::array<int, 2>, 9> points{
      {{65, 0}, {63, 16}, {60, 25}, {56, 33}, {52, 39}, {39, 52}, {33, 56}, {25, 60}, {16, 63}}};
  static constexpr std::array<double, 6> radii{65, 32.5, 130, 16, 64.99999999, 65.00000001};
  c.radius = radii[in.below(6)];
  const bool joined = in.below(2);
  std::vector<Point> v;
  do {
    const unsigned b = in.byte();
    const auto& p = points[b % 9];
    const double x = (b & 64 ? -1 : 1) * p[b >> 4 & 1], y = (b & 128 ? -1 : 1) * p[1 - (b >> 4 & 1)];
    v.push_back({x, y});
    if (!joined || in.below(7) == 6) c.parts.push_back(line(std::move(v))), v.clear();
  } while (in.more());
  if (!v.empty()) c.parts.push_back(line(std::move(v)));
}

void near_equal(ByteReader& in, ZoneCase& c) {
  grid_lines(in, c);
  unsigned k = 0;
  for (InputPart& part : c.parts)
    for (Point& p : part.vertices) {
      k = k * 1103515245u + 12345u + unsigned(p.x) + 16 * unsigned(p.y);
      const double shift = std::ldexp(1.0, -30 - int(k >> 16 & 31) % 23);
      if (k >> 24 & 1) p.x += shift;
      if (k >> 25 & 1) p.y -= shift;
    }
}

void rings(ByteReader& in, ZoneCase& c) {
  c.radius = grid_radius(in);
  std::vector<Point> v{in.grid()};
  std::int64_t feature = 0;
  while (in.more()) {
    const unsigned b = in.below(6);
    if (b == 1) c.parts.push_back(ring(std::move(v), feature)), v.clear();
    if (b == 1 && in.below(2)) ++feature;
    v.push_back(in.grid());
  }
  c.parts.push_back(ring(std::move(v), feature));
}

void digitised(ByteReader& in, ZoneCase& c) {
  const unsigned n = 3 + in.below(62);
  const double size = 10;
  static constexpr std::array<double, 8> factors{1, 1 + 1e-9, 1 - 1e-9, 0.999, 1.001, 0.5, 1 - 1e-15, 1.1};
  c.radius = size * factors[in.below(8)];
  std::vector<Point> v;
  for (unsigned k = 0; k < n; ++k)
    v.push_back({size * std::cos(2 * std::numbers::pi * k / n), size * std::sin(2 * std::numbers::pi * k / n)});
  if (in.below(2)) v.push_back(v[0]);
  c.parts.push_back(line(std::move(v)));
  while (in.more()) {
    const Point p = in.grid();
    c.parts.push_back(point(p.x - 8, p.y - 8));
  }
}

void scattered(ByteReader& in, ZoneCase& c) {
  c.radius = std::ldexp(1 + in.unit(), int(in.below(16)) - 8);
  do {
    std::vector<Point> v{{16 * in.unit(), 16 * in.unit()}};
    for (unsigned k = 0, n = in.below(6); k < n; ++k) {
      const double step = std::ldexp(1.0, -int(in.below(12)));
      const Point p = v.back();
      v.push_back({p.x + 16 * step * (in.unit() - 0.5), p.y + 16 * step * (in.unit() - 0.5)});
    }
    c.parts.push_back(line(std::move(v)));
  } while (in.more());
}

void comb(ByteReader& in, ZoneCase& c) {
  c.radius = grid_radius(in);
  std::vector<Point> v{{0, 0}};
  do {
    const double x = in.below(16), y = in.below(16);
    v.push_back({x, 0}), v.push_back({x, y});
    if (in.below(3)) v.push_back({x, y / 2});  // ends inside its own tooth
    v.push_back({x, 0});
  } while (in.more());
  c.parts.push_back(line(std::move(v)));
}

void move(unsigned kind, ZoneCase& c) {
  const auto each = [&](auto f) {
    for (InputPart& part : c.parts)
      for (Point& p : part.vertices) p = f(p);
  };
  switch (kind % 8) {
    case 1:
      each([](Point p) { return Point{0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y}; });
      break;
    case 2:
      each([](Point p) { return Point{p.x + 512345.25, p.y + 4612345.5}; });
      break;
    case 3:
      each([](Point p) {
        return Point{std::cos(1.0) * p.x - std::sin(1.0) * p.y, std::sin(1.0) * p.x + std::cos(1.0) * p.y};
      });
      break;
    case 4:
      each([](Point p) { return Point{p.x / 1048576, p.y / 1048576}; }), c.radius /= 1048576;
      break;
    case 5:
      each([](Point p) { return Point{p.x * 1e7, p.y * 1e7}; }), c.radius *= 1e7;
      break;
    case 6:
      each([](Point p) { return Point{p.x * 0.1 + 3e5, p.y * 0.1 - 7e6}; }), c.radius *= 0.1;
      break;
    default:
      break;
  }
}

}  // namespace

ZoneCase decode(Family family, std::span<const std::uint8_t> bytes) {
  static constexpr std::array makers{grid_lines, grid_points, streets, on_segments, collinear, tangent,
                                     cocircular, near_equal,  rings,   digitised,   scattered, comb};
  static_assert(makers.size() == std::size_t(Family::count));
  ByteReader in(bytes);
  const unsigned motion = in.byte();
  ZoneCase c;
  makers[std::size_t(family)](in, c);
  move(motion, c);
  // Radii near the coordinates' own steps are refused (tested on its own).
  double largest = 0;
  for (const InputPart& part : c.parts)
    for (const Point& p : part.vertices) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  c.radius = std::max(c.radius, 1e-11 * largest);
  return c;
}

ZoneCase decode(std::span<const std::uint8_t> bytes) {
  const unsigned family = bytes.empty() ? 0 : bytes[0];
  return decode(Family(family % unsigned(Family::count)), bytes.empty() ? bytes : bytes.subspan(1));
}

}  // namespace krepl::test
