// How much of the parallel run is done twice. That its bits are right is tested with the other ways to run.
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/profile/terrains.hpp"
#include "terrain_case.hpp"

namespace krepl::test {

namespace {

/// A run in blocks of so many segments; a test fails where its pieces are not those of one sweep.
ProfileCounters in_blocks(const Terrain& terrain, double radius, std::size_t size) {
  ProfileEngine engine;
  engine.set_block_size(size);
  Context one_thread;
  one_thread.threads = 1;
  std::vector<ProfilePiece> pieces(profile_capacity(terrain.size()));
  const auto count = engine.compute(terrain, radius, pieces, one_thread);
  if (!count) {
    ADD_FAILURE() << count.error().text();
    return {};
  }
  const Profile whole = profile_of(terrain, radius);
  EXPECT_TRUE(std::ranges::equal(whole.pieces, std::span(pieces).first(*count)))
      << "radius " << radius << ", blocks of " << size;
  return engine.counters();
}

/// Segments repeated before two sweeps are compared for the first time; nearly always they agree then.
constexpr std::size_t first_portion = 16;

TEST(Blocks, RepeatFewSegmentsOnEveryKindOfTerrain) {
  constexpr std::size_t segments = 100'000;
  for (const bench::Kind kind : bench::all_kinds) {
    const Terrain& terrain = bench::terrain(kind, segments);
    for (const double radius : {0.01, 0.3, 1.0, 2.0, 5.0, 7.0, 10.0, 100.0, 10'000.0})
      for (const std::size_t size : {std::size_t{256}, std::size_t{4096}}) {
        const std::size_t blocks = (segments + size - 1) / size;
        EXPECT_LE(in_blocks(terrain, radius, size).replayed_segments, first_portion * blocks)
            << bench::name(kind) << ", radius " << radius << ", blocks of " << size;
      }
  }
}

TEST(Blocks, RepeatFewSegmentsOfFlatGroundWithASmallDisk) {
  const Terrain& terrain = bench::terrain(bench::Kind::flat, 100'000);
  const ProfileCounters counters = in_blocks(terrain, 1, 10'000);
  EXPECT_EQ(counters.segments, 100'000u);
  EXPECT_EQ(counters.replayed_segments, 9 * first_portion);  // the first block is taken as it is
}

TEST(Blocks, AreJoinedWherePiecesBesideTheSeamHaveNoLength) {
  // Two of three disks on tips just touch the next needle at its tip's height: the wall there shows with length zero. Some
  // seams would lie right behind such a wall.
  Terrain needles;
  double x = 0;
  for (int i = 0; i < 2000; ++i, x += i % 3 == 0 ? 1 : 2)
    for (const double y : {0.0, 5.0, 0.0}) needles.push_back({x, y});
  for (std::size_t size = 300; size < 306; ++size) {
    const ProfileCounters counters = in_blocks(needles, 1, size);
    EXPECT_GT(counters.collapsed_pieces, 1000u);
    EXPECT_LE(counters.replayed_segments, first_portion * (needles.size() / size + 1)) << "blocks of " << size;
  }
}

TEST(Blocks, CountWhatTheyHold) {
  // A block narrower than 2R keeps everything. On a convex chain this is two pieces a segment and the first two, until the
  // wall at the end hides most of them.
  Terrain chain;
  const std::size_t segments = 1024;
  for (std::size_t i = 0; i <= segments; ++i) {
    const double x = double(i) / double(segments) - 0.5;
    chain.push_back({1.5 * x, -0.01 * x * x});
  }
  chain.push_back({chain.back().x, 50});
  EXPECT_EQ(in_blocks(chain, 1, segments + 1).largest_stack, 2 * segments + 2);
  EXPECT_LT(profile_of(chain, 1).counters.largest_stack, 2 * segments);
}

}  // namespace

}  // namespace krepl::test
