// Clearance of balls and their first contacts against distances from the solid by brute force in extended precision.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "krepl/drop_cutter.hpp"
#include "krepl/free_space.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"
#include "support/solid_distance.hpp"

namespace krepl::test {
namespace {

using Random = std::mt19937_64;
using Triangles = std::vector<SmallTerrain::Triangle>;
using Contact = BallFreeSpace::Contact;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// How far the upper side is above a place; nothing where nothing is above it.
std::optional<long double> depth(const Triangles& triangles, Point3 p) {
  std::optional<long double> deepest;
  for (const auto& t : triangles) {
    const auto side = [](Point3 a, Point3 b, Point3 c) {
      return ((long double)b.x - a.x) * ((long double)c.y - a.y) - ((long double)b.y - a.y) * ((long double)c.x - a.x);
    };
    const long double area = side(t[0], t[1], t[2]);
    if (area == 0) continue;
    const long double w[3] = {side(t[1], t[2], p) / area, side(t[2], t[0], p) / area, side(t[0], t[1], p) / area};
    if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
    const long double above = w[0] * t[0].z + w[1] * t[1].z + w[2] * t[2].z - p.z;
    if (above > 0) deepest = std::max(deepest.value_or(0), above);
  }
  return deepest;
}

double scale_of(const Triangles& triangles, Point3 place, double radius) {
  double scale = std::max({radius, std::abs(place.x), std::abs(place.y), std::abs(place.z)});
  for (const auto& t : triangles)
    for (const Point3& p : t) scale = std::max({scale, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return scale;
}

double distance(Point3 a, Point3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

/// Distance of a point from a feature and what is below it.
long double distance_from_feature(const Terrain& terrain, Terrain::Index feature, Point3 p) {
  const Terrain::Corners corners = terrain.corners(feature);
  std::array<Point3, 3> triangle;
  for (int k = 0; k < 3; ++k) {
    triangle[std::size_t(k)] = corners.point[std::size_t(std::min(k, corners.count - 1))];
    Point3& q = triangle[std::size_t(k)];
    q = {q.x + terrain.origin().x, q.y + terrain.origin().y, q.z + terrain.origin().z};
  }
  return solid_distance(std::span(&triangle, 1), p);
}

void check_place(const BallFreeSpace& space, const Triangles& triangles, Point3 place) {
  const double r = space.radius(), tolerance = 1e-12 * scale_of(triangles, place, r);
  const Contact contact = space.clearance(place);
  SCOPED_TRACE(testing::Message() << "at " << place.x << ' ' << place.y << ' ' << place.z << " R " << r);
  const long double away = solid_distance(triangles, place);
  ASSERT_LT(contact.feature, space.terrain().feature_bound());
  if (contact.clearance < -r) {
    ASSERT_LE(away, tolerance);
    const auto deep = depth(triangles, place);
    // On the border of a triangle's shadow extended precision may see nothing above.
    if (deep) {
      ASSERT_NEAR(double(-r - *deep), contact.clearance, tolerance);
    }
    ASSERT_EQ(contact.point.x, place.x);
    ASSERT_EQ(contact.point.y, place.y);
    ASSERT_NEAR(contact.point.z - place.z, -r - contact.clearance, tolerance);
  } else {
    ASSERT_NEAR(double(away - r), contact.clearance, tolerance);
    ASSERT_NEAR(distance(contact.point, place), contact.clearance + r, tolerance);
    if (away > tolerance) {
      ASSERT_FALSE(depth(triangles, place));
    }
  }
  ASSERT_EQ(contact.free(), contact.clearance >= 0);
  ASSERT_EQ(space.is_free(place), contact.free());
  ASSERT_LE(distance_from_feature(space.terrain(), contact.feature, contact.point), tolerance);
}

Point3 along(Point3 a, Point3 b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

/// Before the contact all is free, at it the ball touches, and behind it cuts in.
void check_motion(const BallFreeSpace& space, const Triangles& triangles, Point3 from, Point3 to) {
  const double r = space.radius(),
               tolerance = 1e-11 * std::max(scale_of(triangles, from, r), scale_of(triangles, to, r));
  SCOPED_TRACE(testing::Message() << "from " << from.x << ' ' << from.y << ' ' << from.z << " to " << to.x << ' '
                                  << to.y << ' ' << to.z << " R " << r);
  const auto cut = space.first_contact(from, to);
  const double until = cut ? cut->t : 1;
  const auto room = [&](double t) { return double(solid_distance(triangles, along(from, to, t)) - r); };
  ASSERT_EQ(!cut, space.is_free(std::array{from, to}));
  if (!space.is_free(from)) {
    ASSERT_TRUE(cut);
    ASSERT_EQ(until, 0);
    ASSERT_EQ(cut->contact.clearance, space.clearance(from).clearance);
    return;
  }
  for (int i = 0; i <= 64; ++i) ASSERT_GE(room(i * until / 64), -tolerance) << i * until / 64 << " of " << until;
  if (!cut) return;
  ASSERT_EQ(cut->contact.clearance, 0);
  ASSERT_NEAR(room(until), 0, tolerance);
  ASSERT_NEAR(distance(cut->place, cut->contact.point), r, tolerance);
  double deepest = 0;
  for (double step = 1 - until; step > 1e-13; step /= 1.5) deepest = std::min(deepest, room(until + step));
  ASSERT_LT(deepest, 0) << "t " << until;
}

bool without_area(const SmallTerrain::Triangle& t) {
  const Point3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z},
      v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
  return u.x * v.y == u.y * v.x && u.y * v.z == u.z * v.y && u.z * v.x == u.x * v.z;
}

class RandomBalls : public testing::TestWithParam<int> {};

TEST_P(RandomBalls, AgreeWithBruteForce) {
  const auto family = SmallTerrainFamily(GetParam());
  Random random(seed() + std::uint64_t(GetParam()));
  const int cases = int(40 * effort());
  int made = 0, free = 0, cut = 0, inside = 0, cuts = 0, clear = 0;
  for (int i = 0; i < cases; ++i) {
    std::vector<std::uint8_t> bytes(48);
    for (auto& b : bytes) b = std::uint8_t(random());
    const SmallTerrain c = decode_small_terrain(family, bytes);
    const auto terrain = terrain_of(c);
    if (!terrain) continue;
    ++made;
    Triangles triangles = triangles_of(c);
    std::erase_if(triangles, without_area);  // as the terrain does
    const double radii[] = {c.radius, 0.5, 1, std::numbers::sqrt2, uniform(random, 0.01, 4)};
    auto space = BallFreeSpace::build(*terrain, radii[i % 5]);
    ASSERT_TRUE(space.ok()) << space.error().text();
    SCOPED_TRACE(testing::Message() << c);
    const Point3 low = (*terrain)->lowest(), high = (*terrain)->highest(), origin = (*terrain)->origin();
    const double r = space->radius();
    const auto any = [&](bool lattice) {
      Point3 p{uniform(random, low.x - 2 * r, high.x + 2 * r), uniform(random, low.y - 2 * r, high.y + 2 * r),
               uniform(random, low.z - 2 * r, high.z + 2 * r)};
      p = {p.x + origin.x, p.y + origin.y, p.z + origin.z};
      if (lattice) p = {std::round(2 * p.x) / 2, std::round(2 * p.y) / 2, std::round(2 * p.z) / 2};
      return p;
    };
    for (int k = 0; k < 40; ++k) {
      const Point3 p = any(k % 2 == 0);
      check_place(*space, triangles, p);
      if (testing::Test::HasFatalFailure()) return;
      const Contact contact = space->clearance(p);
      ++(contact.free() ? free : contact.clearance < -r ? inside : cut);
    }
    for (int k = 0; k < 12; ++k) {
      const Point3 from = any(k % 2 == 0), to = any(k % 2 == 0);
      check_motion(*space, triangles, from, to);
      if (testing::Test::HasFatalFailure()) return;
      ++(space->first_contact(from, to) ? cuts : clear);
    }
  }
  EXPECT_GT(made, cases / 2);
  for (int count : {free, cut, inside, cuts, clear}) EXPECT_GT(count, 0);
}

INSTANTIATE_TEST_SUITE_P(Families, RandomBalls, testing::Range(0, int(SmallTerrainFamily::count)),
                         [](const auto& info) { return std::string(name(SmallTerrainFamily(info.param))); });

std::shared_ptr<const Terrain> mesh(std::vector<Point3> vertices,
                                    std::vector<std::array<Terrain::Index, 3>> triangles) {
  auto terrain = Terrain::from_triangles(std::move(vertices), std::move(triangles));
  return terrain ? std::make_shared<const Terrain>(std::move(*terrain)) : nullptr;
}
/// A square plate of side 10 at height 0.
std::shared_ptr<const Terrain> plate() {
  return mesh({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}}, {{0, 1, 2}, {0, 2, 3}});
}

TEST(BallFreeSpace, KindsOfContact) {
  const auto terrain = plate();
  const auto space = BallFreeSpace::build(terrain, 2);
  ASSERT_TRUE(space.ok());
  const auto at = [&](Point3 p) { return space->clearance(p); };
  const auto kind = [&](Point3 p) { return terrain->feature_kind(at(p).feature); };
  using Kind = Terrain::FeatureKind;
  EXPECT_EQ(kind({3, 2, 5}), Kind::face);
  EXPECT_EQ(at({3, 2, 5}).clearance, 3);
  EXPECT_EQ(at({3, 2, 5}).point, (Point3{3, 2, 0}));
  EXPECT_EQ(kind({5, 5, 2}), Kind::edge) << "the diagonal";
  EXPECT_EQ(at({5, 5, 2}).clearance, 0);
  EXPECT_EQ(kind({10, 10, 7}), Kind::vertex);
  EXPECT_EQ(at({13, 14, 0}).clearance, 3);
  EXPECT_EQ(kind({13, 14, 0}), Kind::vertex);
  EXPECT_EQ(at({13, 14, -50}).clearance, 3) << "beside the corner's wall";
  EXPECT_EQ(at({13, 14, -50}).point, (Point3{10, 10, -50}));
  EXPECT_EQ(kind({12, 4, -1}), Kind::edge);
  EXPECT_EQ(at({12, 4, -1}).clearance, 0);
  EXPECT_EQ(at({12, 4, -1}).point, (Point3{10, 4, -1}));
  EXPECT_EQ(at({11, 4, -1}).clearance, -1);
  EXPECT_EQ(at({3, 2, 0}).clearance, -2);
  EXPECT_EQ(at({3, 2, -5}).clearance, -7) << "R and how far the upper side is above";
  EXPECT_EQ(at({3, 2, -5}).point, (Point3{3, 2, 0}));
  EXPECT_EQ(kind({3, 2, -5}), Kind::face);
}

TEST(BallFreeSpace, SlidesAlongWhatItTouches) {
  const auto space = BallFreeSpace::build(plate(), 2);
  ASSERT_TRUE(space.ok());
  EXPECT_FALSE(space->first_contact(Point3{1, 1, 2}, Point3{9, 8, 2})) << "rolling on the plate";
  EXPECT_FALSE(space->first_contact(Point3{12, 1, -3}, Point3{12, 8, -3})) << "along the wall";
  EXPECT_FALSE(space->first_contact(Point3{-5, 5, 2}, Point3{15, 5, 2})) << "touching on the way";
  const auto into = space->first_contact(Point3{5, 5, 2}, Point3{5, 5, 1});
  ASSERT_TRUE(into);
  EXPECT_EQ(into->t, 0);
  const auto down = space->first_contact(Point3{4, 5, 12}, Point3{4, 5, -8});
  ASSERT_TRUE(down);
  EXPECT_NEAR(down->t, 0.5, 1e-15);
  const std::array<Point3, 4> way{Point3{-5, 5, -9}, Point3{-2, 5, -9}, Point3{-2, 5, 2}, Point3{5, 5, 1}};
  const auto failed = space->first_contact(way);
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->leg, 2u);
  EXPECT_FALSE(space->is_free(way));
  EXPECT_TRUE(space->is_free(std::span(way).first(3)));
  EXPECT_TRUE(space->is_free(std::span(way).first(1)));
}

TEST(BallFreeSpace, RadiiThatAreNone) {
  for (const double r : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e-17}) {
    const auto space = BallFreeSpace::build(plate(), r);
    ASSERT_FALSE(space.ok()) << r;
    EXPECT_EQ(space.error().code, ErrorCode::usage);
  }
  const auto space = BallFreeSpace::build(plate(), 1);
  EXPECT_FALSE(space->is_free(Point3{0, std::nan(""), 0}));
  EXPECT_TRUE(std::isnan(space->clearance({HUGE_VAL, 0, 0}).clearance));
  EXPECT_DOUBLE_EQ(space->clearance({1e200, 0, 0}).clearance, 1e200);
}

TEST(BallFreeSpace, SameBitsForAnyNumberOfThreads) {
  const auto space = BallFreeSpace::build(plate(), 1);
  Random random(seed());
  std::vector<Point3> places;
  for (int i = 0; i < 3000; ++i)
    places.push_back({uniform(random, -2, 12), uniform(random, -2, 12), uniform(random, -2, 3)});
  std::vector<Contact> one(places.size()), three(places.size());
  ASSERT_TRUE(space->clearance(places, one, Context{1, {}, nullptr}).ok());
  ASSERT_TRUE(space->clearance(places, three, Context{3, {}, nullptr}).ok());
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(one[i].clearance, three[i].clearance);
    EXPECT_EQ(one[i].feature, three[i].feature);
    EXPECT_EQ(one[i].point, space->clearance(places[i]).point);
  }
  EXPECT_FALSE(space->clearance(places, std::span(one).first(3)).ok());
}

}  // namespace
}  // namespace krepl::test
