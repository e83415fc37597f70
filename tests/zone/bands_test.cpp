// Bands between zones: closed forms, areas that add up, and the verifier's checks on random networks.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "krepl/shape.hpp"
#include "support/zone_case.hpp"
#include "support/zone_property.hpp"

namespace krepl::test {
namespace {

constexpr double pi = std::numbers::pi;

std::shared_ptr<const Network> shared(const ZoneCase& c) { return std::make_shared<const Network>(*network_of(c)); }

Result<Zone> band_of(const std::shared_ptr<const Network>& network, double inner, double outer, const Context& context = {}) {
  const auto small = compute_zone(network, {inner}, context), large = compute_zone(network, {outer}, context);
  if (!small) return small.error();
  if (!large) return large.error();
  return zone_band(*small, *large, context);
}

/// What is wrong with a band, by validate() and by the verifier, which sees its pieces only.
std::optional<std::string> fault_in_band(const Zone& band, const ZoneCase& c, double inner, double outer) {
  if (auto wrong = band.validate()) return wrong;
  verify::ZoneCheckOptions options;
  options.radius = outer, options.inner = inner, options.effort = 0.02;
  const auto report = verify::check_zone(plain(band), verify::Obstacle(c.parts), options);
  if (!report) return report.error().text();
  for (const auto& check : report->checks)
    if (!check.ok()) return check.name + ", worst " + std::to_string(check.worst);
  return std::nullopt;
}

void expect_band(const ZoneCase& c, double inner, double outer, double area, RingCounts rings) {
  const auto band = band_of(shared(c), inner, outer);
  ASSERT_TRUE(band.ok()) << band.error().text();
  EXPECT_EQ(fault_in_band(*band, c, inner, outer).value_or("sound"), "sound");
  EXPECT_EQ(counts(*band), rings);
  EXPECT_NEAR(band->area(), area, 1e-12 * area);
  EXPECT_EQ(band->radius(), outer);
  EXPECT_EQ(band->inner_radius(), inner);
}

TEST(Bands, ClosedForms) {
  expect_band({{point(3, 4)}}, 1, 2, 3 * pi, {1, 1});
  expect_band({{line({{0, 0}, {10, 0}})}}, 1, 3, 40 + 8 * pi, {1, 1});
  // Round a square, and within it: the inside is filled in the polygon's zone, a second band in the line's.
  const std::vector<Point> square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  expect_band({{ring(square)}}, 1, 2, 40 + 3 * pi, {1, 1});
  auto closed = square;
  closed.push_back(square[0]);
  expect_band({{line(closed)}}, 1, 2, 40 + 3 * pi + 64 - 36, {2, 2});
  // The larger zones have merged, the smaller ones not; the hole between four disks is filled up.
  const double lens = 2 * std::acos(0.75) * 4 - 1.5 * std::sqrt(7.0);
  expect_band({{point(0, 0), point(3, 0)}}, 1, 2, 8 * pi - lens - 2 * pi, {1, 2});
}

TEST(Bands, DisksThatTouchEachOther) {
  const ZoneCase c{{point(0, 0), point(0, 3)}};  // the outer border is two arcs of all but a full turn
  expect_band(c, 1, 1.5, 2 * 1.25 * pi, {1, 2});
  expect_band(c, 1.5, 2, 8 * pi - (16 * std::acos(0.75) / 2 - 1.5 * std::sqrt(7.0)) - 4.5 * pi, {1, 1});
}

TEST(Bands, PiecesAreThoseOfTheZones) {
  const auto network = shared({{line({{0, 0}, {10, 0}, {13, 9}})}});
  const auto inner = compute_zone(network, {1}), outer = compute_zone(network, {2});
  ASSERT_TRUE(inner.ok() && outer.ok());
  const auto band = zone_band(*inner, *outer);
  ASSERT_TRUE(band.ok());
  ASSERT_EQ(band->piece_count(), inner->piece_count() + outer->piece_count());
  for (std::uint32_t e = 0; e < band->piece_count(); ++e) {
    const bool is_inner = e >= outer->piece_count();
    EXPECT_EQ(band->is_inner(e), is_inner);
    EXPECT_EQ(band->piece(e).radius, is_inner ? 1 : 2);
    if (!is_inner) {
      EXPECT_EQ(band->piece(e).start, outer->piece(e).start);
    }
    if (is_inner && band->piece(e).kind == Zone::Kind::arc) {
      EXPECT_TRUE(band->piece(e).clockwise);
    }
  }
  EXPECT_FALSE(outer->is_inner(0));
  EXPECT_EQ(outer->inner_radius(), 0);
}

TEST(Bands, TheVerifierSeesWrongOnes) {
  const ZoneCase c{{line({{0, 0}, {10, 0}, {13, 9}}), point(20, 5)}};
  const auto band = band_of(shared(c), 1, 2);
  ASSERT_TRUE(band.ok());
  EXPECT_EQ(fault_in_band(*band, c, 1, 2).value_or("sound"), "sound");
  EXPECT_TRUE(fault_in_band(*band, c, 1.0001, 2));
  EXPECT_TRUE(fault_in_band(*band, c, 1, 2.0001));
  EXPECT_TRUE(fault_in_band(*band, c, 0, 2));
  const auto whole = compute_zone(shared(c), {2});
  EXPECT_TRUE(fault_in_band(*whole, c, 1, 2));
}

TEST(Bands, WithArcs) {
  const ZoneCase c{{curve({{0, 0}, {5, 5}, {10, 0}, {20, 0}}, {1})}};
  const auto curves = std::make_shared<const CurveNetwork>(*curve_network_of(c));
  const auto inner = compute_zone(curves, {1}), outer = compute_zone(curves, {2});
  ASSERT_TRUE(inner.ok() && outer.ok());
  const auto band = zone_band(*inner, *outer);
  ASSERT_TRUE(band.ok()) << band.error().text();
  EXPECT_EQ(fault_in_band(*band, c, 1, 2).value_or("sound"), "sound");
  EXPECT_NEAR(band->area(), outer->area() - inner->area(), 1e-12 * outer->area());
}

TEST(Bands, Refused) {
  const auto network = shared({{line({{0, 0}, {10, 0}})}}), other = shared({{line({{0, 0}, {10, 1}})}});
  const auto one = compute_zone(network, {1}), two = compute_zone(network, {2}), elsewhere = compute_zone(other, {2});
  const auto nearly = compute_zone(network, {1 + 1e-12});
  ShapeOptions flat;
  flat.distance = 2, flat.cap = Cap::flat;
  const auto with_ends = compute_shape(network, flat);
  ASSERT_TRUE(one.ok() && two.ok() && elsewhere.ok() && nearly.ok() && with_ends.ok());
  const auto band = zone_band(*one, *two);
  ASSERT_TRUE(band.ok());
  const Zone* pairs[][2] = {{&*two, &*one}, {&*one, &*one}, {&*one, &*nearly}, {&*one, &*elsewhere}, {&*one, &*with_ends}, {&*band, &*two}};
  for (const auto& [inner, outer] : pairs) {
    const auto refused = zone_band(*inner, *outer);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::usage);
  }
}

using BandProperty = PropertyTest;

TEST_P(BandProperty, AreasAddUpAndBandsAreSound) {
  holds("bands", [&](const ZoneCase& c) {
    auto made = network_of(c);
    if (!made) return;
    const auto network = std::make_shared<const Network>(std::move(*made));
    const double radii[] = {c.radius / 4, c.radius, 1.5 * c.radius};
    std::vector<Zone> zones;
    for (const double radius : radii) {
      auto zone = compute_zone(network, {radius});
      if (!zone) return;  // finer than the coordinates
      zones.push_back(std::move(*zone));
    }
    double sum = zones[0].area();
    for (int i = 1; i < 3; ++i) {
      const auto band = zone_band(zones[std::size_t(i) - 1], zones[std::size_t(i)]);
      if (!band) RC_LOG() << band.error().text() << '\n';
      RC_ASSERT(band.ok());
      const auto fault = fault_in_band(*band, c, radii[i - 1], radii[i]);
      if (fault) RC_LOG() << *fault << '\n';
      RC_ASSERT(!fault);
      sum += band->area();
    }
    RC_ASSERT(std::abs(sum - zones[2].area()) <= 1e-9 * sum);
  });
}

KREPL_FOR_ALL_FAMILIES(BandProperty);

}  // namespace
}  // namespace krepl::test
