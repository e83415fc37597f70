// Clearance of disks and their first contacts against distances by brute force in extended precision.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "krepl/free_space.hpp"
#include "support/environment.hpp"
#include "support/zone_case.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {
namespace {

using Random = std::mt19937_64;
using Real = long double;
using Contact = DiskFreeSpace::Contact;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Real distance(Point p, Point a, Point b) {
  const Real dx = (Real)b.x - a.x, dy = (Real)b.y - a.y, px = (Real)p.x - a.x, py = (Real)p.y - a.y;
  const Real whole = dx * dx + dy * dy, t = whole > 0 ? std::clamp<Real>((px * dx + py * dy) / whole, 0, 1) : 0;
  return std::hypot(px - t * dx, py - t * dy);
}

template <class Visit>
void for_each_segment(const ZoneCase& c, const Visit& visit) {
  for (const InputPart& part : c.parts) {
    const auto& v = part.vertices;
    if (v.size() == 1) visit(part, v[0], v[0]);
    for (std::size_t i = 0; i + 1 < v.size(); ++i) visit(part, v[i], v[i + 1]);
    if (part.ring && v.size() > 1) visit(part, v.back(), v.front());
  }
}

Real to_lines(const ZoneCase& c, Point p) {
  Real nearest = HUGE_VALL;
  for_each_segment(c, [&](const InputPart&, Point a, Point b) { nearest = std::min(nearest, distance(p, a, b)); });
  return nearest;
}

/// By the even-odd rule of each feature.
bool in_polygon(const ZoneCase& c, Point p) {
  std::map<std::int64_t, bool> odd;
  for_each_segment(c, [&](const InputPart& part, Point a, Point b) {
    if (!part.ring || (a.y > p.y) == (b.y > p.y)) return;
    const Real side = ((Real)b.x - a.x) * ((Real)p.y - a.y) - ((Real)b.y - a.y) * ((Real)p.x - a.x);
    if ((b.y > a.y) == (side > 0)) odd[part.feature] ^= true;
  });
  for (const auto& [feature, inside] : odd)
    if (inside) return true;
  return false;
}

struct Extent {
  double west = 1e300, east = -1e300, south = 1e300, north = -1e300, scale = 0;
};
Extent extent_of(const ZoneCase& c) {
  Extent e;
  for (const InputPart& part : c.parts)
    for (const Point& p : part.vertices) {
      e.west = std::min(e.west, p.x), e.east = std::max(e.east, p.x);
      e.south = std::min(e.south, p.y), e.north = std::max(e.north, p.y);
      e.scale = std::max({e.scale, std::abs(p.x), std::abs(p.y)});
    }
  return e;
}
Point along(Point a, Point b, double t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }

class RandomDisks : public testing::TestWithParam<int> {
 protected:
  void check_place(const DiskFreeSpace& space, const ZoneCase& c, Point p, double tolerance) {
    const Contact contact = space.clearance(p);
    const Real away = to_lines(c, p);
    SCOPED_TRACE(testing::Message() << "at " << p.x << ' ' << p.y);
    const bool inside = in_polygon(c, p);
    const double r = space.radius(), expected = double((inside ? -away : away) - r);
    // On an outline either side is right.
    ASSERT_NEAR(contact.clearance, away > tolerance ? expected : -r, 2 * tolerance);
    ASSERT_NEAR(std::hypot(contact.point.x - p.x, contact.point.y - p.y), double(away), tolerance);
    // The source is that of the point.
    const InputPart& part = c.parts[contact.source.part];
    const Point first = part.vertices[contact.source.vertex];
    const Point second = contact.at_vertex ? first : part.vertices[(contact.source.vertex + 1) % part.vertices.size()];
    ASSERT_LE(distance(contact.point, first, second), tolerance);
    ++(contact.free() ? free_ : inside ? inside_ : cut_);
  }

  void check_motion(const DiskFreeSpace& space, const ZoneCase& c, Point from, Point to, double tolerance) {
    SCOPED_TRACE(testing::Message() << "from " << from.x << ' ' << from.y << " to " << to.x << ' ' << to.y);
    const auto cut = space.first_contact(from, to);
    const double r = space.radius(), until = cut ? cut->t : 1;
    ASSERT_EQ(!cut, space.is_free(std::array{from, to}));
    if (!space.is_free(from)) {
      ASSERT_TRUE(cut);
      ASSERT_EQ(until, 0);
      return;
    }
    const auto room = [&](double t) {
      const Point p = along(from, to, t);
      return double(in_polygon(c, p) ? -to_lines(c, p) - r : to_lines(c, p) - r);
    };
    for (int i = 0; i <= 64; ++i) ASSERT_GE(room(i * until / 64), -tolerance) << i * until / 64 << " of " << until;
    if (!cut) return;
    ++cuts_;
    ASSERT_EQ(cut->contact.clearance, 0);
    ASSERT_NEAR(room(until), 0, tolerance);
    double deepest = 0;
    for (double step = 1 - until; step > 1e-13; step /= 1.5) deepest = std::min(deepest, room(until + step));
    ASSERT_LT(deepest, 0) << "t " << until;
  }

  int free_ = 0, cut_ = 0, inside_ = 0, cuts_ = 0;
};

TEST_P(RandomDisks, AgreeWithBruteForce) {
  const auto family = Family(GetParam());
  Random random(seed() + std::uint64_t(GetParam()));
  const int cases = int(40 * effort());
  for (int i = 0; i < cases; ++i) {
    std::vector<std::uint8_t> bytes(64);
    for (auto& b : bytes) b = std::uint8_t(random());
    const ZoneCase c = decode(family, bytes);
    auto network = network_of(c);
    ASSERT_TRUE(network.ok());
    const auto space = DiskFreeSpace::build(std::make_shared<const Network>(std::move(*network)), c.radius);
    ASSERT_TRUE(space.ok()) << space.error().text();
    SCOPED_TRACE(testing::Message() << c);
    const Extent e = extent_of(c);
    const double r = c.radius, tolerance = 1e-12 * (std::max(e.scale, r) + 4 * r);
    const auto any = [&](int k) {
      Point p{uniform(random, e.west - 2 * r, e.east + 2 * r), uniform(random, e.south - 2 * r, e.north + 2 * r)};
      const auto& part = c.parts[random() % c.parts.size()];
      const Point vertex = part.vertices[random() % part.vertices.size()];
      if (k % 4 == 0) p = {std::round(p.x), std::round(p.y)};
      if (k % 4 == 1) p = {vertex.x + r * double(int(random() % 5) - 2), vertex.y + r * double(int(random() % 5) - 2)};
      return p;
    };
    for (int k = 0; k < 40; ++k) {
      check_place(*space, c, any(k), tolerance);
      if (HasFatalFailure()) return;
    }
    for (int k = 0; k < 12; ++k) {
      check_motion(*space, c, any(k), any(k), 10 * tolerance);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(free_, 0);
  EXPECT_GT(cut_, 0);
  EXPECT_GT(cuts_, 0);
  if (family == Family::rings) {
    EXPECT_GT(inside_, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, RandomDisks, testing::Range(0, int(Family::count)));

Result<DiskFreeSpace> space_of(std::vector<InputPart> parts, double radius) {
  ZoneCase c{std::move(parts), radius};
  auto network = network_of(c);
  if (!network) return network.error();
  return DiskFreeSpace::build(std::make_shared<const Network>(std::move(*network)), radius);
}

TEST(DiskFreeSpace, GapOfExactlyTwoRadii) {
  const auto space = space_of({line({{0, 0}, {10, 0}}), line({{0, 2}, {10, 2}})}, 1);
  ASSERT_TRUE(space.ok());
  EXPECT_EQ(space->clearance(Point{5, 1}).clearance, 0);
  EXPECT_TRUE(space->is_free(Point{5, 1}));
  EXPECT_FALSE(space->is_free(Point{5, 1.001}));
  EXPECT_FALSE(space->first_contact(Point{-5, 1}, Point{15, 1})) << "through the gap";
  const auto cut = space->first_contact(Point{-5, 1}, Point{15, 1.5});
  ASSERT_TRUE(cut);
  EXPECT_TRUE(cut->contact.at_vertex);
  EXPECT_EQ(cut->contact.point, (Point{0, 2}));
  EXPECT_NEAR(std::hypot(cut->place.x, cut->place.y - 2), 1, 1e-15);
}

TEST(DiskFreeSpace, InsidePolygonsAndTheirHoles) {
  const auto space = space_of(
      {ring({{0, 0}, {20, 0}, {20, 20}, {0, 20}}, 7), ring({{5, 5}, {15, 5}, {15, 15}, {5, 15}}, 7), point(10, 10)}, 2);
  ASSERT_TRUE(space.ok());
  EXPECT_EQ(space->clearance(Point{2, 10}).clearance, -4) << "2 inside the polygon";
  EXPECT_EQ(space->clearance(Point{2, 10}).source.feature, 7);
  EXPECT_EQ(space->clearance(Point{7.5, 7.5}).clearance, 0.5) << "in the hole";
  EXPECT_EQ(space->clearance(Point{10, 10}).clearance, -2);
  EXPECT_EQ(space->clearance(Point{-5, 10}).clearance, 3);
  EXPECT_EQ(space->clearance(Point{-3, -4}).clearance, 3);
  EXPECT_EQ(space->clearance(Point{0, 10}).clearance, -2) << "on the outline";
  const std::array<Point, 3> way{Point{-5, -5}, Point{-5, 10}, Point{30, 10}};
  const auto cut = space->first_contact(way);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->leg, 1u);
  EXPECT_NEAR(cut->place.x, -2, 1e-14);
}

TEST(DiskFreeSpace, RadiiAndPlacesThatAreNone) {
  for (const double r : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    const auto space = space_of({point(0, 0)}, r);
    ASSERT_FALSE(space.ok()) << r;
    EXPECT_EQ(space.error().code, ErrorCode::usage);
  }
  const auto space = space_of({point(0, 0)}, 1);
  EXPECT_FALSE(space->is_free(Point{std::nan(""), 0}));
  EXPECT_TRUE(space->first_contact(Point{5, 5}, Point{std::nan(""), 0}));
  EXPECT_DOUBLE_EQ(space->clearance({1e200, 0}).clearance, 1e200);
}

}  // namespace
}  // namespace krepl::test
