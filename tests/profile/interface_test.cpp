// What the public functions refuse, and what they promise about storage, counters and cancelling.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/environment.hpp"
#include "terrain_case.hpp"

namespace krepl::test {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

Error error_of(Terrain terrain, double radius, unsigned threads = 1) {
  Context context;
  context.threads = threads;
  const auto result = compute_profile(std::move(terrain), radius, context);
  if (!result) return result.error();
  ADD_FAILURE() << "no error";
  return {};
}

TEST(Refused, Radius) {
  for (const double radius : {0.0, -1.0, nan, infinity, -infinity, 1e-200, 1e200}) {
    EXPECT_EQ(error_of({{0, 0}}, radius).code, ErrorCode::usage) << radius;
    const auto stream = ProfileStream::open(radius, [](auto) {});
    ASSERT_FALSE(stream.ok());
    EXPECT_EQ(stream.error().code, ErrorCode::usage);
  }
}

TEST(Refused, Terrain) {
  EXPECT_EQ(error_of({}, 1).code, ErrorCode::input);
  EXPECT_EQ(error_of({{0, 0}, {1, 0}, {0.5, 0}}, 1).where, "vertex 2");
  for (const double bad : {nan, infinity, -infinity, 1e200})
    for (std::size_t at = 0; at < 4; ++at)
      for (const bool in_x : {true, false}) {
        Terrain terrain{{0, 0}, {1, 0}, {2, 0}, {3, 0}};
        (in_x ? terrain[at].x : terrain[at].y) = bad;
        // -infinity in x is found where x decreases, at the same vertex.
        EXPECT_EQ(error_of(terrain, 1).where, "vertex " + std::to_string(at)) << bad << " at " << at;
        EXPECT_EQ(error_of(terrain, 1).code, ErrorCode::input);
      }
}

TEST(Refused, TheFirstBadVertexIsNamedWhateverTheNumberOfThreads) {
  std::mt19937_64 random(seed());
  Terrain terrain = families()[0].make(random, 5000);
  terrain[4000].y = nan;
  terrain[1234].x = terrain[1233].x - 1e-9;
  for (const unsigned threads : {1u, 2u, 4u}) {
    ProfileEngine engine;
    engine.set_block_size(100);
    std::vector<ProfilePiece> pieces(profile_capacity(terrain.size()));
    Context context;
    context.threads = threads;
    const auto result = engine.compute(terrain, 3, pieces, context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().where, "vertex 1234");
  }
  auto stream = ProfileStream::open(3, [](auto) {});
  ASSERT_TRUE(stream.ok());
  const Status pushed = stream->push(terrain);
  ASSERT_FALSE(pushed.ok());
  EXPECT_EQ(pushed.error().where, "vertex 1234");
  EXPECT_FALSE(stream->push({1e9, 0}).ok());
  EXPECT_FALSE(stream->finish().ok());
}

TEST(Refused, TooLittleStorage) {
  const Terrain terrain{{0, 0}, {1, 0}};
  std::vector<ProfilePiece> pieces(profile_capacity(2) - 1);
  ProfileEngine engine;
  const auto result = engine.compute(terrain, 1, pieces);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::usage);
}

TEST(Refused, EmptyStream) {
  auto stream = ProfileStream::open(1, [](auto) {});
  ASSERT_TRUE(stream.ok());
  EXPECT_TRUE(stream->push(std::span<const Point>{}).ok());
  EXPECT_FALSE(stream->finish().ok());
}

TEST(Context, CancelledBeforeTheEnd) {
  std::mt19937_64 random(seed());
  const Terrain terrain = families()[0].make(random, 500000);
  std::atomic<bool> cancel{true};
  for (const unsigned threads : {1u, 2u}) {
    Context context;
    context.threads = threads;
    context.cancel = &cancel;
    const auto result = compute_profile(terrain, 3, context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
  }
}

TEST(Context, ProgressEndsAtOne) {
  std::mt19937_64 random(seed());
  const Terrain terrain = families()[0].make(random, 500000);
  for (const unsigned threads : {1u, 2u}) {
    double last = 0;
    bool rising = true;
    Context context;
    context.threads = threads;
    context.progress = [&](double f) { rising = rising && f >= last, last = f; };
    ASSERT_TRUE(compute_profile(terrain, 3, context).ok());
    EXPECT_TRUE(rising);
    EXPECT_GT(last, 0.9);
    EXPECT_LE(last, 1.0);
  }
}

TEST(Engine, KeepsNothingFromEarlierRuns) {
  std::mt19937_64 random(seed());
  ProfileEngine engine;
  std::vector<ProfilePiece> pieces(profile_capacity(3000));
  for (int i = 0; i < 100; ++i) {
    const Terrain terrain = families()[std::size_t(i) % families().size()].make(random, 1 + random() % 2000);
    const double radius = any_radius(random, terrain);
    const auto count = engine.compute(terrain, radius, pieces, {});
    ASSERT_TRUE(count.ok());
    const Profile fresh = profile_of(terrain, radius);
    ASSERT_EQ(*count, fresh.pieces.size());
    ASSERT_TRUE(std::equal(fresh.pieces.begin(), fresh.pieces.end(), pieces.begin()));
  }
}

TEST(Stream, HoldsTheWindowOnly) {
  auto stream = ProfileStream::open(50, [](auto) {});
  ASSERT_TRUE(stream.ok());
  std::mt19937_64 random(seed());
  std::uniform_real_distribution<double> height(0, 1e-3);  // low: most of the window stays visible
  for (int i = 0; i < 1'000'000; ++i) ASSERT_TRUE(stream->push({double(i), height(random)}).ok());
  ASSERT_TRUE(stream->finish().ok());
  // At most 2 pieces a segment in [x - R, x] and beside its ends. What waits for being taken off in bulk is not counted.
  EXPECT_LE(stream->counters().largest_stack, 2u * (50 + 2) + 2);
}

TEST(Stream, DeliversEachPieceAsSoonAsItIsFinal) {
  double delivered = -infinity;
  auto stream = ProfileStream::open(10, [&](std::span<const ProfileRow> rows) { delivered = rows.back().end.x; });
  ASSERT_TRUE(stream.ok());
  for (int i = 0; i < 10000; ++i) {
    ASSERT_TRUE(stream->push({double(i), double(i % 2) / 10}).ok());
    if (i > 20) {
      ASSERT_GT(delivered, i - 10 - 2.5);  // one piece ends within two steps left of x - R
    }
  }
}

TEST(LinearTime, EachPieceIsHiddenAtMostOnce) {
  std::mt19937_64 random(seed());
  for (const Family& family : families())
    for (const double radius : {0.3, 3.0, 300.0}) {
      const Profile profile = profile_of(family.make(random, 20000), radius);
      EXPECT_LE(profile.counters.pops, 2 * profile.counters.segments) << family.name;
    }
}

}  // namespace

}  // namespace krepl::test
