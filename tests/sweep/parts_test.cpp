// The sweep's own parts and promises: rungs of the ladder, paths, what is refused, the same bytes for any number of
// threads.
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "krepl/sweep.hpp"
#include "support/environment.hpp"
#include "support/zone_case.hpp"
#include "support/zone_generators.hpp"
#include "sweep/paths.hpp"
#include "zone/precision.hpp"

namespace krepl::test {
namespace {

using sweep::Geometry;
using sweep::Index;
using sweep::wide;

std::shared_ptr<const Network> shared(const ZoneCase& c) {
  auto network = network_of(c);
  EXPECT_TRUE(network.ok());
  return std::make_shared<const Network>(std::move(*network));
}

zone::Instance instance_of(const Network& network, double radius) {
  const auto precision = zone::precision_for(network, radius);
  EXPECT_TRUE(precision.ok());
  return {network, radius, precision->effective_radius, precision->resolution, {}};
}

std::vector<ZoneCase> random_cases(int count) {
  std::mt19937_64 random(seed());
  std::vector<ZoneCase> cases;
  for (int i = 0; i < count; ++i) {
    std::vector<std::uint8_t> bytes(2 + random() % 60);
    for (auto& b : bytes) b = std::uint8_t(random());
    cases.push_back(decode(bytes));
  }
  return cases;
}

/// A bound of the error is one: what the next rungs find lies within it.
TEST(SweepLadder, ErrorBoundsHold) {
  std::size_t places = 0, told = 0;
  for (const ZoneCase& c : random_cases(int(150 * effort()) + 1)) {
    auto made = network_of(c);
    if (!made || !zone::precision_for(*made, c.radius)) continue;
    const zone::Instance instance = instance_of(*made, c.radius);
    const Geometry geometry(instance, {});
    const Index n = std::min<Index>(instance.element_count(), 24);
    for (Index e = 0; e < n; ++e) {
      for (Index f = 0; f < n; ++f) {
        if (e == f || !geometry.may_cross(e, f)) continue;
        const auto exact = geometry.crosses<wide>(e, f);
        const auto quick = geometry.crosses<double>(e, f);
        EXPECT_LE(abs(exact.value - quick.value), wide(quick.error) + exact.error) << text(c);
        if (exact.sign() <= 0) continue;
        sweep::Vertex v;
        v.from = e, v.to = f;
        const auto p = geometry.place<wide>(v);
        const auto q = geometry.place<sweep::quad>(v);
        ++places;
        EXPECT_LE(abs(p.at.x - kernel::widened(q.at.x)), kernel::widened(q.error) + p.error) << text(c);
        EXPECT_LE(abs(p.at.y - kernel::widened(q.at.y)), kernel::widened(q.error) + p.error) << text(c);
        if (quick.sign() <= 0) continue;  // double precision does not know that it exists
        ++told;
        const auto d = geometry.place<double>(v);
        EXPECT_LE(abs(p.at.x - d.at.x), wide(d.error) + p.error) << text(c);
        EXPECT_LE(abs(p.at.y - d.at.y), wide(d.error) + p.error) << text(c);
      }
    }
  }
  EXPECT_GT(places, 1000u);
  EXPECT_GT(told, places / 2);
}

TEST(SweepPaths, EachSegmentOnceAndNoVertexTwice) {
  for (const ZoneCase& c : random_cases(200)) {
    auto made = network_of(c);
    if (!made || !zone::precision_for(*made, c.radius)) continue;
    const zone::Instance instance = instance_of(*made, c.radius);
    for (const Index longest : {Index(1), Index(3), sweep::none}) {
      const sweep::Paths paths = sweep::take_apart(instance, longest);
      std::set<Index> seen;
      for (Index p = 0; p < paths.count(); ++p) {
        std::set<Index> vertices;
        ASSERT_LT(paths.begin[p], paths.begin[p + 1]);
        EXPECT_LE(paths.begin[p + 1] - paths.begin[p], longest);
        for (Index i = paths.begin[p]; i < paths.begin[p + 1]; ++i) {
          const Index e = paths.step[i];
          if (!instance.is_side(e)) {
            EXPECT_TRUE(seen.insert(e).second);
            continue;
          }
          EXPECT_TRUE(seen.insert(e >> 1).second);
          if (i == paths.begin[p])
            vertices.insert(instance.ends(e).from);
          else
            EXPECT_EQ(instance.ends(paths.step[i - 1]).to, instance.ends(e).from);
          EXPECT_TRUE(vertices.insert(instance.ends(e).to).second) << text(c);
        }
      }
      EXPECT_EQ(seen.size(), instance.site_count());
    }
  }
}

TEST(SweepZone, SoundByBruteForce) {
  for (ZoneCase& c : random_cases(int(150 * effort()) + 1)) {
    auto made = network_of(c);
    if (!made) continue;
    const auto zone = compute_zone_by_sweep(std::make_shared<const Network>(std::move(*made)), {c.radius});
    if (!zone) {
      EXPECT_NE(zone.error().code, ErrorCode::computation) << zone.error().text() << text(c);
      continue;
    }
    EXPECT_EQ(fault_in(*zone, c, 0.005).value_or("sound"), "sound") << text(c);
  }
}

ZoneCase walks(int lines, int steps) {
  std::mt19937_64 random(seed());
  std::uniform_real_distribution<double> step(-1, 1);
  ZoneCase c;
  for (int i = 0; i < lines; ++i) {
    std::vector<Point> vertices{{30 * step(random), 30 * step(random)}};
    for (int k = 0; k < steps; ++k)
      vertices.push_back({vertices.back().x + step(random), vertices.back().y + step(random)});
    c.parts.push_back(line(vertices));
  }
  return c;
}

TEST(SweepZone, SameForAnyNumberOfThreads) {
  const auto network = shared(walks(60, 100));
  for (const double radius : {0.05, 0.5, 5.0}) {
    std::vector<Zone::Piece> first;
    std::uint64_t crossings = 0;
    for (const unsigned threads : {1u, 2u, 5u}) {
      Context context;
      context.threads = threads;
      SweepCounters counters;
      const auto zone = compute_zone_by_sweep(network, {radius}, context, &counters);
      ASSERT_TRUE(zone.ok()) << zone.error().text();
      std::vector<Zone::Piece> pieces;
      for (std::uint32_t e = 0; e < zone->piece_count(); ++e) pieces.push_back(zone->piece(e));
      if (threads == 1) first = pieces, crossings = counters.crossings;
      ASSERT_EQ(first.size(), pieces.size());
      EXPECT_EQ(crossings, counters.crossings);
      for (std::size_t e = 0; e < pieces.size(); ++e) {
        ASSERT_TRUE(pieces[e].start == first[e].start && pieces[e].end == first[e].end &&
                    pieces[e].source == first[e].source && pieces[e].kind == first[e].kind);
      }
    }
  }
}

TEST(SweepZone, RefusesWhatTheOtherEnginesRefuse) {
  const auto network = shared({{line({{0, 0}, {10, 0}})}});
  for (const double radius : {0.0, -1.0, std::nan(""), 1e-15}) {
    const auto zone = compute_zone_by_sweep(network, {radius});
    ASSERT_FALSE(zone.ok()) << radius;
    EXPECT_EQ(zone.error().code, ErrorCode::usage);
  }
}

TEST(SweepZone, TooManyCrossingsAreAnErrorWithoutRounds) {
  const auto network = shared(walks(1, 300));
  SweepOptions options{5, SweepOptions::CleanUp::neighbours, 1000};
  const auto refused = compute_zone_by_sweep(network, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::computation);
  EXPECT_NE(refused.error().what.find("more than 1000 crossings"), std::string::npos);
  options.clean_up = SweepOptions::CleanUp::rounds;
  EXPECT_TRUE(compute_zone_by_sweep(network, options).ok());
}

TEST(SweepZone, CancellingEndsWithCancelled) {
  const std::atomic<bool> stop{true};
  Context context;
  context.cancel = &stop;
  for (const auto clean_up : {SweepOptions::CleanUp::rounds, SweepOptions::CleanUp::neighbours}) {
    const auto zone = compute_zone_by_sweep(shared(walks(60, 200)), {1, clean_up}, context);
    ASSERT_FALSE(zone.ok());
    EXPECT_EQ(zone.error().code, ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace krepl::test
