// Zones of lines with arcs in relation to others: of the zone's own border, of chords, of the same input moved, turned
// and scaled, of lines without arcs by the other engine, with other numbers of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/curve_generators.hpp"
#include "support/environment.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {
namespace {

/// Runs the check on random cases of all families, each with its zone.
template <class Check>
void for_random_zones(std::uint64_t offset, int cases, Check&& check) {
  std::mt19937_64 random(seed() + offset);
  for (int f = 0; f < int(CurveFamily::count); ++f) {
    for (int k = 0; k < int(cases * effort()); ++k) {
      const ZoneCase c = random_curves(CurveFamily(f), random);
      SCOPED_TRACE(std::string(name(CurveFamily(f))) + ": " + text(c));
      const auto zone = curve_zone_of(c);
      if (!zone && zone.error().code == ErrorCode::usage) continue;  // an arc around the whole world
      ASSERT_TRUE(zone.ok()) << zone.error().text();
      check(c, *zone, random);
    }
  }
}

/// The zone as polygons with arcs, as a file would hold them.
std::vector<InputPart> as_input(const Zone& zone) {
  std::vector<InputPart> rings;
  std::int64_t feature = 0;
  for (const input::ResultPolygon& polygon : plain(zone)) {
    const auto add = [&](const input::ResultRing& ring) {
      InputPart part = curve_ring({ring.pieces.front().start}, {}, feature);
      for (const input::ResultPiece& piece : ring.pieces) {
        if (piece.arc) {
          part.middles.push_back(std::uint32_t(part.vertices.size()));
          part.vertices.push_back(piece.middle);
        }
        part.vertices.push_back(piece.end);
      }
      rings.push_back(part);
    };
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
    ++feature;
  }
  return rings;
}

TEST(CurveRelations, AZoneOfAZoneIsThatOfTheSum) {
  for_random_zones(20, 40, [](const ZoneCase& c, const Zone& zone, std::mt19937_64& random) {
    const double more = c.radius * double(1 + random() % 8) / 4;
    const auto second = curve_zone_of({as_input(zone), more});
    ASSERT_TRUE(second.ok()) << second.error().text();
    const ZoneCase sum{c.parts, c.radius + more};
    const auto at_once = curve_zone_of(sum);
    ASSERT_TRUE(at_once.ok()) << at_once.error().text();
    const double tolerance = std::max(1e-9 * at_once->scale(), 64 * zone.network().resolution());
    EXPECT_NEAR(second->area(), at_once->area(), tolerance * at_once->perimeter());
    const auto fault = fault_in(*second, sum);
    EXPECT_FALSE(fault.has_value()) << *fault << "\nthen " << more;
  });
}

InputPart with_chords(const InputPart& part, int chords) {
  InputPart out = part;
  out.vertices.assign(1, part.vertices.front()), out.middles.clear();
  auto middle = part.middles.begin();
  for (std::size_t i = 1; i < part.vertices.size(); ++i) {
    if (middle != part.middles.end() && *middle == i) {
      ++middle;
      if (const auto arc = verify::CircularArc::through(part.vertices[i - 1], part.vertices[i], part.vertices[i + 1])) {
        for (int k = 1; k < chords; ++k) {
          const verify::Vec p = arc->at(verify::Real(k) / chords);
          out.vertices.push_back({double(p.x), double(p.y)});
        }
        ++i;
      }
    }
    out.vertices.push_back(part.vertices[i]);
  }
  return out;
}

// Rings are left out: what two of them enclose between them may be there with chords and not with arcs.
TEST(CurveRelations, ChordsComeNear) {
  constexpr int chords = 400;
  for_random_zones(40, 10, [](const ZoneCase& c, const Zone& zone, std::mt19937_64&) {
    if (std::any_of(c.parts.begin(), c.parts.end(), [](const InputPart& p) { return p.ring; })) return;
    ZoneCase linear = c;
    double off = 0;
    for (InputPart& part : linear.parts) {
      for (const std::uint32_t m : part.middles) {
        const auto arc = verify::CircularArc::through(part.vertices[m - 1], part.vertices[m], part.vertices[m + 1]);
        if (arc) off = std::max(off, double(arc->r * (1 - std::cos(arc->sweep() / chords / 2))));
      }
      part = with_chords(part, chords);
    }
    if (off > c.radius / 10) return;  // an arc so wide that the chords are none
    const auto other = zone_of(linear);
    ASSERT_TRUE(other.ok()) << other.error().text();
    // Within `off` of each other: the zones lie between those of radii off less and off more.
    const auto inner = curve_zone_of({c.parts, c.radius - off}), outer = curve_zone_of({c.parts, c.radius + off});
    ASSERT_TRUE(inner.ok() && outer.ok());
    const double slack = 1e-9 * zone.scale() * zone.perimeter();
    EXPECT_LE(other->area(), outer->area() + slack);
    EXPECT_GE(other->area(), inner->area() - slack);
  });
}

template <class Motion>
ZoneCase moved(const ZoneCase& c, double scale, Motion&& motion) {
  ZoneCase out = c;
  out.radius *= scale;
  for (InputPart& part : out.parts)
    for (Point& p : part.vertices) p = motion(p);
  return out;
}

TEST(CurveRelations, TurnedAndScaledItIsTheSame) {
  for_random_zones(60, 10, [](const ZoneCase& c, const Zone& zone, std::mt19937_64&) {
    const double slack = 1e-9 * zone.scale() * zone.perimeter() + 64 * zone.network().resolution() * zone.perimeter();
    const auto turned = curve_zone_of(moved(c, 1, [](Point p) { return Point{-p.y, p.x}; }));
    const auto scaled = curve_zone_of(moved(c, 0.125, [](Point p) { return Point{p.x / 8, p.y / 8}; }));
    const auto mirrored = curve_zone_of(moved(c, 1, [](Point p) { return Point{-p.x, p.y}; }));
    ASSERT_TRUE(turned.ok() && scaled.ok() && mirrored.ok());
    EXPECT_NEAR(turned->area(), zone.area(), slack);
    EXPECT_NEAR(64 * scaled->area(), zone.area(), slack);
    EXPECT_NEAR(mirrored->area(), zone.area(), slack);
    EXPECT_EQ(counts(*scaled), counts(zone));
  });
}

TEST(CurveRelations, LinesWithoutArcsAreAsByTheOtherEngine) {
  std::mt19937_64 random(seed() + 80);
  for (int f = 0; f < int(Family::count); ++f) {
    for (int k = 0; k < int(10 * effort()); ++k) {
      std::vector<std::uint8_t> bytes(3 + random() % 40);
      for (auto& b : bytes) b = std::uint8_t(random());
      const ZoneCase c = decode(Family(f), bytes);
      SCOPED_TRACE(text(c));
      const auto zone = curve_zone_of(c), other = zone_of(c);
      ASSERT_TRUE(zone.ok()) << zone.error().text();
      ASSERT_TRUE(other.ok()) << other.error().text();
      EXPECT_NEAR(zone->area(), other->area(),
                  std::max(1e-11 * zone->scale(), 64 * zone->network().resolution()) * other->perimeter());
      const auto fault = fault_in(*zone, c);
      EXPECT_FALSE(fault.has_value()) << *fault;
    }
  }
}

TEST(CurveRelations, AnyNumberOfThreadsGivesTheSameBits) {
  std::mt19937_64 random(seed() + 90);
  ZoneCase c;
  for (int k = 0; k < 300; ++k) {  // far more bodies than one thread takes at a time
    ZoneCase more = random_curves(CurveFamily(k % 3 == 0 ? int(CurveFamily::fillets) : int(CurveFamily::grid)), random);
    for (InputPart& part : more.parts) {
      if (std::abs(part.vertices.front().x) > 1e4) continue;  // those that are shifted far
      for (Point& p : part.vertices) p = {p.x + 7 * (k % 17), p.y + 7 * (k / 17)};
      c.parts.push_back(part);
    }
  }
  c.radius = 0.5;
  Context one, three;
  one.threads = 1, three.threads = 3;
  const auto a = curve_zone_of(c, one), b = curve_zone_of(c, three);
  ASSERT_TRUE(a.ok()) << a.error().text();
  ASSERT_TRUE(b.ok()) << b.error().text();
  ASSERT_EQ(a->piece_count(), b->piece_count());
  for (std::uint32_t e = 0; e < a->piece_count(); ++e) {
    const Zone::Piece p = a->piece(e), q = b->piece(e);
    ASSERT_TRUE(p.start == q.start && p.end == q.end && p.center == q.center && p.source == q.source) << e;
  }
  const auto fault = fault_in(*a, c);
  EXPECT_FALSE(fault.has_value()) << *fault;
}

}  // namespace
}  // namespace krepl::test
