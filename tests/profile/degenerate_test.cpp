// Inputs on which two or more answers are equally near: each must come out sound, and with the same bits from blocks and
// as a stream.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "terrain_case.hpp"

namespace krepl::test {

namespace {

struct Named {
  const char* name;
  Terrain terrain;
};

Terrain repeat(std::size_t times, double step, const Terrain& unit) {
  Terrain t;
  for (std::size_t i = 0; i < times; ++i)
    for (const Point& p : unit) t.push_back({p.x + double(i) * step, p.y});
  return t;
}

std::vector<Named> corpus() {
  std::vector<Named> c;
  c.push_back({"one point", {{0, 0}}});
  c.push_back({"two equal points", {{0, 0}, {0, 0}}});
  c.push_back({"a single wall up", {{0, 0}, {0, 5}}});
  c.push_back({"a single wall down", {{0, 5}, {0, 0}}});
  c.push_back({"a spike alone", {{0, 0}, {0, 5}, {0, 0}}});
  c.push_back({"a slit alone", {{0, 5}, {0, 0}, {0, 5}}});
  c.push_back({"flat", repeat(40, 1, {{0, 0}})});
  c.push_back({"collinear slope", repeat(1, 0, [] {
                 Terrain t;
                 for (int i = 0; i < 40; ++i) t.push_back({3.0 * i, 2.0 * i});
                 return t;
               }())});
  c.push_back({"nearly collinear slope", [] {
                 Terrain t;
                 for (int i = 0; i < 40; ++i) t.push_back({0.1 * i, 0.3 * i});
                 return t;
               }()});
  c.push_back({"stairs up", [] {
                 Terrain t;
                 for (int i = 0; i < 20; ++i) t.push_back({double(i), double(i)}), t.push_back({double(i), double(i + 1)});
                 return t;
               }()});
  c.push_back({"stairs down", [] {
                 Terrain t;
                 for (int i = 0; i < 20; ++i) t.push_back({double(i), -double(i)}), t.push_back({double(i), -double(i + 1)});
                 return t;
               }()});
  c.push_back({"battlements", repeat(15, 4, {{0, 0}, {0, 2}, {2, 2}, {2, 0}})});
  c.push_back({"slots as wide as the disk", repeat(10, 5, {{0, 0}, {1, 0}, {1, -7}, {5, -7}, {5, 0}})});
  c.push_back({"slots, right wall lower", repeat(10, 6, {{0, 0}, {1, 0}, {1, -7}, {5, -7}, {5, -3}, {6, -3}, {6, 0}})});
  c.push_back({"needles at distance 2R", repeat(12, 4, {{0, 0}, {0, 5}, {0, 0}})});
  c.push_back({"equal peaks", repeat(20, 2, {{0, 0}, {1, 1}})});
  c.push_back({"pythagorean needles",
               repeat(4, 12, {{-4, -9}, {-4, -3}, {-4, -9}, {-3, -9}, {-3, -4}, {-3, -9}, {0, -9}, {0, -5},
                              {0, -9}, {3, -9}, {3, -4}, {3, -9}, {4, -9}, {4, -3}, {4, -9}})});
  c.push_back({"bowl of chords",
               {{-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}, {6, -3}, {7, -4}, {10, -5}, {13, -4}, {14, -3}}});
  c.push_back({"lake with a third ridge in its plane", {{0, 0}, {4, 0}, {5, -2}, {6, 0}, {9, 0}, {10, -8}, {11, 0}, {15, 0}}});
  c.push_back({"wall of many pieces",
               {{0, 0}, {1, 0}, {1, 2}, {1, 1}, {1, 4}, {1, 4}, {1, 3}, {1, 6}, {1, 0}, {1, 2}, {1, -3}, {2, -3}}});
  c.push_back({"ever smaller steps", [] {
                 Terrain t;
                 double x = 0;
                 for (int i = 0; i < 60; ++i) t.push_back({x, i % 2 == 0 ? 0.0 : std::ldexp(1, -i)}), x += std::ldexp(1, -i);
                 return t;
               }()});
  c.push_back({"tiny steps", {{0, 0}, {1e-300, 1}, {2e-300, 0}, {1, 0}, {1, 1e-300}, {2, 0}, {2 + 0x1p-51, 1}}});
  c.push_back({"finely drawn circle of radius 2", [] {
                 Terrain t;
                 for (int i = 0; i <= 400; ++i)
                   t.push_back({-2 * std::cos(std::acos(-1.0) * i / 400), -2 * std::sin(std::acos(-1.0) * i / 400)});
                 for (std::size_t i = 1; i < t.size(); ++i) t[i].x = std::max(t[i].x, t[i - 1].x);
                 return t;
               }()});
  return c;
}

TEST(Degenerate, IsSoundAtEveryRadius) {
  for (const Named& c : corpus())
    for (const double radius : {1e-6, 0.1, 0.5, 1.0, std::sqrt(2.0), 2.0, 2.5, 5.0, 7.0, 100.0, 1e6})
      for (const bool mirror : {false, true}) {
        const Terrain terrain = mirror ? mirrored(c.terrain) : c.terrain;
        const auto fault = fault_in(terrain, radius);
        EXPECT_FALSE(fault) << c.name << (mirror ? ", mirrored" : "") << ", radius " << radius << ": " << *fault;
      }
}

TEST(Degenerate, IsSoundFarFromTheOrigin) {
  for (const Named& c : corpus())
    for (const double radius : {1e-6, 1.0, 2.0, 100.0}) {
      const Terrain terrain = moved(c.terrain, 653251, 5212345);
      const auto fault = fault_in(terrain, radius);
      EXPECT_FALSE(fault) << c.name << ", radius " << radius << ": " << *fault;
    }
}

TEST(Degenerate, IsTheSameBitsInBlocksAndAsStream) {
  const std::array<std::size_t, 6> sizes{1, 2, 3, 4, 7, 16};
  for (const Named& c : corpus())
    for (const double radius : {1e-6, 0.5, 1.0, 2.0, 5.0, 100.0, 1e6})
      for (const bool mirror : {false, true}) {
        const auto difference = difference_in(mirror ? mirrored(c.terrain) : c.terrain, radius, sizes);
        EXPECT_FALSE(difference) << c.name << (mirror ? ", mirrored" : "") << ", radius " << radius << ": " << *difference;
      }
}

TEST(Degenerate, TiesAreFoundAsTies) {
  // Needles with their tips at these places; the disk of radius 5 touches all of them at once.
  const auto needles = [](const Terrain& tips) {
    Terrain t;
    for (const Point& p : tips) t.insert(t.end(), {{p.x, -20}, p, {p.x, -20}});
    return t;
  };
  const Profile tie = profile_of(needles({{-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}}), 5);
  EXPECT_GT(tie.counters.ties, 0u);
  EXPECT_EQ(tie.pieces.size(), 6u);  // half-line, wall, two arcs, wall, half-line
  // The middle one a hair lower is hidden, a hair higher it shows; neither is a tie.
  const Profile lower = profile_of(needles({{-3, -4}, {0, std::nextafter(-5.0, -6.0)}, {3, -4}}), 5);
  EXPECT_EQ(lower.pieces.size(), 6u);
  const Profile higher = profile_of(needles({{-3, -4}, {0, -5 + 0x1p-46}, {3, -4}}), 5);
  EXPECT_EQ(higher.pieces.size(), 7u);
}

}  // namespace

}  // namespace krepl::test
