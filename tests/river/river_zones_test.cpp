// The union of the zones of all sub-rivers, and of all main stems with what comes to them, is the zone of the whole
// river to the last ring [thesis, section 3.3]. The parts' zones are krepl's; GEOS unites them, with chords of a known
// depth.
#include <geos_c.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "krepl/zone.hpp"
#include "river/river_case.hpp"
#include "support/environment.hpp"
#include "support/wkt_file.hpp"
#include "support/zone_case.hpp"

namespace krepl::test {
namespace {

using Index = RiverNetwork::Index;

void ignore(const char*, void*) {}

class GeosUnion {
 public:
  explicit GeosUnion(double largest_step) : handle_(GEOS_init_r()), step_(largest_step) {
    GEOSContext_setNoticeMessageHandler_r(handle_, ignore, nullptr);
    GEOSContext_setErrorMessageHandler_r(handle_, ignore, nullptr);
  }
  ~GeosUnion() { GEOS_finish_r(handle_); }
  GeosUnion(const GeosUnion&) = delete;
  GeosUnion& operator=(const GeosUnion&) = delete;

  /// The share of the radius by which chords lie inside arcs.
  double depth() const { return 1 - std::cos(step_ / 2); }

  struct Answer {
    RingCounts rings;
    double area = 0;
  };
  std::optional<Answer> unite(const std::vector<Zone>& zones) {
    std::vector<GEOSGeometry*> polygons;
    for (const Zone& zone : zones) {
      for (std::uint32_t p = 0; p < zone.polygon_count(); ++p) polygons.push_back(polygon(zone, zone.polygon(p)));
    }
    GEOSGeometry* all =
        GEOSGeom_createCollection_r(handle_, GEOS_GEOMETRYCOLLECTION, polygons.data(), unsigned(polygons.size()));
    GEOSGeometry* united = GEOSUnaryUnion_r(handle_, all);
    GEOSGeom_destroy_r(handle_, all);
    if (united == nullptr) return std::nullopt;
    Answer answer;
    GEOSArea_r(handle_, united, &answer.area);
    for (int i = 0, n = GEOSGetNumGeometries_r(handle_, united); i < n; ++i) {
      ++answer.rings.outer;
      answer.rings.holes += std::size_t(GEOSGetNumInteriorRings_r(handle_, GEOSGetGeometryN_r(handle_, united, i)));
    }
    GEOSGeom_destroy_r(handle_, united);
    return answer;
  }

 private:
  GEOSGeometry* polygon(const Zone& zone, const Zone::Polygon& from) {
    std::vector<GEOSGeometry*> holes;
    for (std::uint32_t hole : from.holes) holes.push_back(ring(zone, hole));
    return GEOSGeom_createPolygon_r(handle_, ring(zone, from.outer), holes.data(), unsigned(holes.size()));
  }
  GEOSGeometry* ring(const Zone& zone, std::uint32_t r) {
    std::vector<Point> points;
    for (std::uint32_t e = zone.ring_begin(r); e < zone.ring_begin(r + 1); ++e) {
      const Zone::Piece piece = zone.piece(e);
      points.push_back(piece.start);
      if (piece.kind != Zone::Kind::arc) continue;
      const double from = std::atan2(piece.start.y - piece.center.y, piece.start.x - piece.center.x);
      double span = std::atan2(piece.end.y - piece.center.y, piece.end.x - piece.center.x) - from;
      if (span <= 0) span += 2 * std::numbers::pi;
      if (span > 6.2 && piece.start != piece.end) continue;  // no longer than rounding
      const int count = int(std::ceil(span / step_));
      for (int i = 1; i < count; ++i) {
        const double angle = from + span * i / count;
        points.push_back(
            {piece.center.x + zone.radius() * std::cos(angle), piece.center.y + zone.radius() * std::sin(angle)});
      }
    }
    points.push_back(points.front());
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(handle_, unsigned(points.size()), 2);
    for (unsigned i = 0; i < points.size(); ++i) GEOSCoordSeq_setXY_r(handle_, sequence, i, points[i].x, points[i].y);
    return GEOSGeom_createLinearRing_r(handle_, sequence);
  }

  GEOSContextHandle_t handle_;
  double step_;
};

RiverLines read_lines(const std::filesystem::path& path) {
  RiverLines lines;
  for (const InputPart& part : read_wkt_file(path)) lines.push_back(part.vertices);
  return lines;
}

Zone zone_of_network(Network network, double radius) {
  auto zone = compute_zone(std::make_shared<const Network>(std::move(network)), {radius});
  EXPECT_TRUE(zone.ok()) << (zone ? "" : zone.error().text());
  return std::move(*zone);
}

Zone zone_of_part(const RiverNetwork& rivers, const std::vector<Index>& members, double radius) {
  return zone_of_network(std::move(*rivers.network(members)), radius);
}

struct Parts {
  std::vector<std::vector<Index>> sub_rivers, stems, whole{1};
};
Parts parts_of(const RiverNetwork& rivers) {
  Parts parts;
  std::map<Index, std::vector<Index>> by_stem;
  for (Index s = 0; s < rivers.sub_rivers().size(); ++s) {
    parts.sub_rivers.push_back({s});
    by_stem[rivers.sub_rivers()[s].stem].push_back(s);
    parts.whole[0].push_back(s);
  }
  for (auto& entry : by_stem) parts.stems.push_back(std::move(entry.second));
  return parts;
}

/// Counts and area of the union against the whole; true if rings could be compared (none that is thinner than the
/// chords).
bool check_union(GeosUnion& geos, const RiverNetwork& rivers, const std::vector<std::vector<Index>>& members,
                 const Zone& whole, bool stable) {
  std::vector<Zone> zones;
  for (const auto& part : members) zones.push_back(zone_of_part(rivers, part, whole.radius()));
  const auto united = geos.unite(zones);
  if (!united) return false;
  const double rounding = 1e-9 * whole.area();
  EXPECT_GE(whole.area() - united->area, -rounding);
  EXPECT_LE(whole.area() - united->area, 1.01 * geos.depth() * whole.radius() * whole.perimeter() + rounding);
  if (!stable) return false;
  EXPECT_EQ(counts(whole), united->rings);
  return true;
}

/// Both unions against the whole, and the whole against the zone of the lines as they came.
std::size_t check_zones(GeosUnion& geos, const RiverNetwork& rivers, Network input, double radius) {
  const Parts parts = parts_of(rivers);
  const Zone whole = zone_of_part(rivers, parts.whole[0], radius), raw = zone_of_network(std::move(input), radius);
  // Lines are moved by a grid's pitch at most, and a zone's radius enlarged by a few.
  EXPECT_NEAR(whole.area(), raw.area(), 1e-9 * raw.area() + 10 * rivers.report().grid * raw.perimeter());
  EXPECT_NEAR(whole.perimeter(), raw.perimeter(), 1e-7 * raw.perimeter());
  const Zone inner = zone_of_part(rivers, parts.whole[0], radius * (1 - 1.01 * geos.depth()));
  const Zone outer = zone_of_part(rivers, parts.whole[0], radius * (1 + 1e-9));
  const bool stable = counts(inner) == counts(outer);
  EXPECT_TRUE(!stable || counts(whole) == counts(raw));
  return std::size_t(check_union(geos, rivers, parts.sub_rivers, whole, stable)) +
         std::size_t(check_union(geos, rivers, parts.stems, whole, stable));
}

TEST(RiverZones, PartsMakeTheWholeOfAnyLines) {
  GeosUnion geos(std::numbers::pi / 256);
  std::mt19937_64 random(seed());
  std::size_t compared = 0, tried = 0;
  for (int k = 0; k < int(120 * effort()); ++k) {
    const bool on_grid = k % 2 == 0;
    const RiverLines lines = on_grid ? grid_lines(random) : free_lines(random);
    const auto rivers = RiverNetwork::build(network_of(lines));
    if (!rivers) continue;
    if (rivers->report().ignored_points > 0) continue;  // they have zones too, but are no rivers
    const double radius = (on_grid ? 0.1 : 1) * double(1 + random() % 40) / 8;
    compared += check_zones(geos, *rivers, network_of(lines), radius);
    tried += 2;
    if (HasFailure()) return;
  }
  std::printf("rings compared in %zu unions of %zu\n", compared, tried);
  EXPECT_GT(compared, tried / 2);
}

TEST(RiverZones, PartsMakeTheWholeOfRealRivers) {
  const auto data = data_directory();
  if (!data) GTEST_SKIP() << "no directory of real data; set KREPL_DATA";
  GeosUnion geos(std::numbers::pi / 1024);
  std::size_t compared = 0, tried = 0;
  for (const char* name : {"river_walker_epsg32610_mm.wkt", "river_new_hope_epsg32617_mm.wkt"}) {
    const auto path = *data / "vector" / name;
    if (!std::filesystem::exists(path)) continue;
    const RiverLines lines = read_lines(path);
    const auto rivers = RiverNetwork::build(network_of(lines));
    ASSERT_TRUE(rivers.ok());
    EXPECT_EQ(rivers->report().rivers, 1u);
    double length = 0;
    for (const auto& reach : rivers->reaches()) length += reach.length;
    const double mean = length / double(network_of(lines).segments().size());
    for (double radius : {0.7, 3.0, 10.0, 30.0}) {
      SCOPED_TRACE(std::string(name) + " at " + std::to_string(radius) + " mean lengths");
      compared += check_zones(geos, *rivers, network_of(lines), radius * mean);
      tried += 2;
    }
  }
  if (tried == 0) GTEST_SKIP() << "no river files in the directory of real data";
  std::printf("rings compared in %zu unions of %zu\n", compared, tried);
  EXPECT_GT(compared, 0u);
}

}  // namespace
}  // namespace krepl::test
