// Shares of owners: they cover the zone without overlap, and each place belongs to the nearest, by brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "krepl/voronoi.hpp"
#include "support/zone_property.hpp"

namespace krepl::test {
namespace {

constexpr double pi = std::numbers::pi;

/// A share's rings as fine polygons.
class Share {
 public:
  explicit Share(const OwnerZone& zone) {
    for (const OwnerZone::Polygon& polygon : zone.polygons) {
      add(polygon.outer);
      for (const OwnerZone::Ring& hole : polygon.holes) add(hole);
    }
  }
  bool contains(Point p) const {
    bool inside = false;
    for (const auto& ring : rings_) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point a = ring[i], b = ring[(i + 1) % ring.size()];
        if ((a.y <= p.y) == (b.y <= p.y)) continue;
        const double cross = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        inside ^= (cross < 0) == (a.y < b.y);
      }
    }
    return inside;
  }

 private:
  void add(const OwnerZone::Ring& ring) {
    std::vector<Point> points;
    for (const OwnerZone::Curve& c : ring.curves) {
      if (c.kind != OwnerZone::Kind::arc) {
        points.insert(points.end(), c.points.begin(), c.points.end() - 1);
        continue;
      }
      const double x = c.points[0].x - c.center.x, y = c.points[0].y - c.center.y;
      const double u = c.points[1].x - c.center.x, v = c.points[1].y - c.center.y;
      double angle = std::atan2(x * v - y * u, x * u + y * v);
      if (angle <= 0 || c.points[0] == c.points[1]) angle += 2 * pi;
      const int steps = 1 + int(std::abs(angle) * 60);
      for (int i = 0; i < steps; ++i) {
        const double a = angle * i / steps;
        points.push_back({c.center.x + x * std::cos(a) - y * std::sin(a), c.center.y + x * std::sin(a) + y * std::cos(a)});
      }
    }
    rings_.push_back(std::move(points));
  }
  std::vector<std::vector<Point>> rings_;
};

struct Shared {
  std::vector<OwnerZone> shares;
  double zone_area = 0;
};

/// Every part its own owner, rings of one feature the same; in the order of the parts.
std::vector<std::uint32_t> owners_of(const ZoneCase& c) {
  std::vector<std::uint32_t> owner;
  std::map<std::int64_t, std::uint32_t> known;
  for (const InputPart& part : c.parts) {
    const auto next = std::uint32_t(owner.size());
    owner.push_back(part.ring ? known.emplace(part.feature, next).first->second : next);
  }
  return owner;
}

Result<Shared> share(const ZoneCase& c, double max_error) {
  auto network = network_of(c);
  if (!network) return network.error();
  auto diagram = VoronoiDiagram::build(std::make_shared<const Network>(std::move(*network)));
  if (!diagram) return diagram.error();
  auto shares = diagram->owner_zones(c.radius, owners_of(c), max_error);
  if (!shares) return shares.error();
  auto zone = diagram->zone({c.radius});
  if (!zone) return zone.error();
  return Shared{std::move(*shares), zone->area()};
}

/// What is wrong with the shares, or nothing.
std::optional<std::string> fault_in_shares(const ZoneCase& c, const Shared& s, int samples) {
  double area = 0, length = 0, largest = 0;
  for (const InputPart& part : c.parts)
    for (const Point& p : part.vertices) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  const double step = 0x1p-52 * largest;
  for (const OwnerZone& zone : s.shares) {
    double own = 0;
    for (const auto& polygon : zone.polygons) {
      if (!(polygon.outer.area > 0)) return "an outer ring that runs clockwise";
      own += polygon.outer.area;
      for (const auto& hole : polygon.holes) own += hole.area;
    }
    if (!(std::abs(own - zone.area) <= 1e-9 * zone.area)) return "the area of a share is not that of its rings";
    area += zone.area, length += zone.perimeter;
  }
  // Pieces that coordinates can hardly tell are contracted in the zone.
  if (!(std::abs(area - s.zone_area) <= 1e-9 * s.zone_area + 4 * step * length))
    return "areas add up to " + std::to_string(area) + " for " + std::to_string(s.zone_area);

  const auto owner = owners_of(c);
  std::map<std::uint32_t, verify::Obstacle> obstacles;
  std::map<std::uint32_t, std::vector<InputPart>> parts;
  for (std::size_t i = 0; i < c.parts.size(); ++i) parts[owner[i]].push_back(c.parts[i]);
  for (const auto& [o, list] : parts) obstacles.emplace(o, verify::Obstacle(list));
  std::map<std::uint32_t, Share> share;
  for (const OwnerZone& zone : s.shares) share.emplace(zone.owner, Share(zone));

  std::mt19937_64 random(7);
  verify::Box box;
  for (const auto& [o, obstacle] : obstacles) box.add(obstacle.box());
  box = box.grown(c.radius);
  const double size = double(std::max(box.x1 - box.x0, box.y1 - box.y0));
  const double tolerance = 1e-4 * c.radius + 1e-9 * size + 64 * step;
  std::uniform_real_distribution<double> x{double(box.x0), double(box.x1)}, y{double(box.y0), double(box.y1)};
  for (int i = 0; i < samples; ++i) {
    const Point p{x(random), y(random)};
    double nearest = HUGE_VAL, second = HUGE_VAL;
    std::uint32_t expected = 0;
    bool in_polygon = false;
    for (const auto& [o, obstacle] : obstacles) {  // ascending
      if (obstacle.in_polygon(p)) {
        expected = o, in_polygon = true;
        break;
      }
      const double d = double(obstacle.distance(p));
      if (d < nearest) second = nearest, nearest = d, expected = o;
      else second = std::min(second, d);
    }
    if (!in_polygon && (second - nearest < tolerance || std::abs(nearest - c.radius) < tolerance)) continue;
    bool on_ring = false;
    for (const auto& [o, obstacle] : obstacles) on_ring |= obstacle.has_polygons() && obstacle.distance(p) < tolerance;
    if (on_ring) continue;
    const bool covered = in_polygon || nearest < c.radius;
    for (const auto& [o, polygons] : share) {
      if (polygons.contains(p) != (covered && o == expected))
        return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ") is in the share of " + std::to_string(o) +
               " or not, but belongs to " + (covered ? std::to_string(expected) : "none");
    }
    if (covered && !share.contains(expected)) return "no share for " + std::to_string(expected);
  }
  return std::nullopt;
}

std::vector<OwnerZone> sound_shares(const ZoneCase& c) {
  const auto shared = share(c, 1e-6 * c.radius);
  EXPECT_TRUE(shared.ok()) << (shared.ok() ? "" : shared.error().text()) << '\n' << text(c);
  if (!shared.ok()) return {};
  const auto fault = fault_in_shares(c, *shared, 2000);
  EXPECT_FALSE(fault) << *fault << '\n' << text(c);
  return shared->shares;
}

TEST(Owners, TwoPointsShareALensEvenly) {
  const auto shares = sound_shares({{point(0, 0), point(1, 0)}, 1});
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_NEAR(shares[0].area, shares[1].area, 1e-12);
  EXPECT_NEAR(shares[0].area, pi - (pi / 3 - std::sqrt(3) / 4), 1e-12);
}

TEST(Owners, ApartTheyKeepTheirOwn) {
  const auto shares = sound_shares({{point(0, 0), line({{10, 0}, {20, 0}})}, 1});
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_NEAR(shares[0].area, pi, 1e-12);
  EXPECT_NEAR(shares[1].area, pi + 20, 1e-12);
}

TEST(Owners, LinesThatCrossHaveTwoWedgesEach) {
  const auto shares = sound_shares({{line({{-10, 0}, {10, 0}}), line({{0, -10}, {0, 10}})}, 1});
  ASSERT_EQ(shares.size(), 2u);
  for (const OwnerZone& zone : shares) EXPECT_EQ(zone.polygons.size(), 2u);
  EXPECT_NEAR(shares[0].area, shares[1].area, 1e-11);
}

TEST(Owners, AParabolaBetweenAPointAndALine) {
  const auto shares = sound_shares({{point(0, 1), line({{-10, 0}, {10, 0}})}, 1.5});
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_GT(shares[0].deviation, 0);
  EXPECT_LE(shares[0].deviation, 1.5e-6);
  EXPECT_EQ(shares[0].deviation, shares[1].deviation);
}

TEST(Owners, ALineTwiceBelongsToTheFirst) {
  const auto shares = sound_shares({{line({{0, 0}, {5, 1}}), line({{0, 0}, {5, 1}})}, 1});
  ASSERT_EQ(shares.size(), 1u);
  EXPECT_EQ(shares[0].owner, 0u);
}

TEST(Owners, PolygonsKeepTheirInside) {
  const InputPart square = ring({{0, 0}, {20, 0}, {20, 20}, {0, 20}}, 1);
  const auto one = sound_shares({{square, line({{10, 10}, {40, 10}})}, 1});  // a line that leaves the polygon
  ASSERT_EQ(one.size(), 2u);
  EXPECT_GT(one[0].area, 400);
  // Overlapping polygons: the first takes what both have.
  const auto two = sound_shares({{square, ring({{10, 10}, {30, 10}, {30, 30}, {10, 30}}, 2)}, 1});
  ASSERT_EQ(two.size(), 2u);
  EXPECT_GT(two[0].area - two[1].area, 99);
  // One in the other, and in its hole; a shared side.
  sound_shares({{ring({{5, 5}, {15, 5}, {15, 15}, {5, 15}}, 2), square}, 1});
  sound_shares({{square, ring({{5, 5}, {15, 5}, {15, 15}, {5, 15}}, 2)}, 1});
  sound_shares({{square, ring({{4, 4}, {16, 4}, {16, 16}, {4, 16}}, 1), point(10, 10)}, 3});
  const auto beside = sound_shares({{square, ring({{20, 0}, {40, 0}, {40, 20}, {20, 20}}, 2)}, 1});
  EXPECT_NEAR(beside[0].area, beside[1].area, 1e-9);
}

class OwnersOfAllFamilies : public PropertyTest {};

TEST_P(OwnersOfAllFamilies, ShareTheZone) {
  holds("shared", [](const ZoneCase& c) {
    const auto shared = share(c, 1e-6 * c.radius);
    // About one in a thousand has no diagram, and a tiny input ends before a large radius; both say so (docs/voronoi.md).
    for (const char* known : {"could not be certified", "beyond the horizon"})
      if (!shared && shared.error().what.find(known) != std::string::npos) return;
    if (!shared) RC_LOG() << shared.error().text() << '\n';
    RC_ASSERT(shared.ok());
    const auto fault = fault_in_shares(c, *shared, 100);
    if (fault) RC_LOG() << *fault << '\n';
    RC_ASSERT(!fault);
  });
}

KREPL_FOR_ALL_FAMILIES(OwnersOfAllFamilies);

}  // namespace
}  // namespace krepl::test
