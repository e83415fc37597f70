// The verifier must see what is wrong: each test spoils a right result in one way.
#include <gtest/gtest.h>

#include <cmath>

#include "support/environment.hpp"
#include "terrain_case.hpp"

namespace krepl::test {

namespace {

using Record = input::ProfileRecord;

class Spoiled : public testing::Test {
 protected:
  Spoiled() {
    std::mt19937_64 random(seed());
    terrain_ = families()[0].make(random, 300);
    records_ = records_of(profile_of(terrain_, radius_));
  }
  /// Names of the checks that fail.
  std::string failed() const {
    verify::ProfileCheckOptions options;
    options.radius = radius_;
    const auto report = verify::check_profile(terrain_, records_, options);
    if (!report) return "error: " + report.error().text();
    std::string names;
    for (const verify::Check& check : report->checks)
      if (!check.ok()) names += (names.empty() ? "" : ", ") + check.name;
    return names;
  }
  std::size_t first(Record::Kind kind, std::size_t after = 10) const {
    while (records_[after].kind != kind) ++after;
    return after;
  }
  Terrain terrain_;
  double radius_ = 0.4;
  std::vector<Record> records_;
};

TEST_F(Spoiled, NotAtAll) { EXPECT_EQ(failed(), ""); }

TEST_F(Spoiled, VertexMovedTwoTolerances) {
  const double by = 2e-9 * 150 * 1.2;  // S is half the width, about 150
  const std::size_t k = first(Record::Kind::arc);
  records_[k].end.y += by, records_[k + 1].start.y += by;
  EXPECT_NE(failed().find("distance to the terrain"), std::string::npos) << failed();
}

TEST_F(Spoiled, PieceLeftOut) {
  records_.erase(records_.begin() + std::ptrdiff_t(first(Record::Kind::segment)));
  EXPECT_NE(failed().find("continuity"), std::string::npos);
}

TEST_F(Spoiled, BumpCutOff) {
  // The boundary of the terrain without its bump: continuous, and right but for the bump.
  terrain_ = {{0, 0}, {10, 0}, {11, 5}, {12, 0}, {22, 0}};
  radius_ = 1;
  const auto right = records_of(profile_of(terrain_, radius_));
  records_ = records_of(profile_of({{0, 0}, {10, 0}, {12, 0}, {22, 0}}, radius_));
  for (Record& r : records_) {  // causes of the terrain with the bump
    if (r.by_segment && r.cause == 1) r.cause = 0;
    else if (r.cause >= (r.by_segment ? 2u : 3u)) ++r.cause;
    else if (r.cause == 2) r.cause = 3;
  }
  EXPECT_EQ(failed().find("continuity"), std::string::npos) << failed();
  EXPECT_NE(failed().find("not below the terrain"), std::string::npos) << failed();
  EXPECT_NE(failed().find("height against the envelope"), std::string::npos) << failed();
}

TEST_F(Spoiled, ArcTheOtherWayRound) {
  const std::size_t k = first(Record::Kind::arc);
  std::swap(records_[k].start, records_[k].end);
  EXPECT_NE(failed().find("direction"), std::string::npos);
}

TEST_F(Spoiled, WrongCause) {
  ++records_[first(Record::Kind::arc)].cause;
  EXPECT_NE(failed().find("radius and distance of cause"), std::string::npos);
}

TEST_F(Spoiled, CauseOutOfRange) {
  records_[first(Record::Kind::segment)].cause = 299;
  EXPECT_NE(failed().find("form"), std::string::npos);
}

TEST_F(Spoiled, KindsMixedUp) {
  records_[first(Record::Kind::segment)].by_segment = false;
  EXPECT_NE(failed().find("form"), std::string::npos);
}

TEST_F(Spoiled, HalfLineMissingOrElsewhere) {
  const auto right = records_;
  records_.pop_back();
  EXPECT_NE(failed().find("form"), std::string::npos);
  records_ = right;
  records_.front().start.x -= 1e-6, records_.front().end.x -= 1e-6;
  EXPECT_NE(failed().find("continuity"), std::string::npos);
  records_ = right;
  records_[5].kind = Record::Kind::half_line;
  EXPECT_NE(failed().find("form"), std::string::npos);
}

TEST_F(Spoiled, OtherRadius) {
  radius_ = 0.4 + 1e-6;
  EXPECT_NE(failed().find("distance to the terrain"), std::string::npos);
}

TEST_F(Spoiled, OtherTerrain) {
  terrain_[150].y += 5;
  EXPECT_NE(failed(), "");
}

TEST_F(Spoiled, NonsenseIsRefused) {
  radius_ = 0;
  EXPECT_EQ(failed().rfind("error", 0), 0u);
  radius_ = 0.4;
  terrain_.clear();
  EXPECT_EQ(failed().rfind("error", 0), 0u);
}

TEST(Verifier, TakesAHundredThousandSegments) {
  std::mt19937_64 random(seed());
  const Terrain terrain = families()[1].make(random, 100'000);
  for (const double radius : {1.0, 1000.0}) {
    const auto fault = fault_in(terrain, radius);
    EXPECT_FALSE(fault) << *fault;
  }
}

}  // namespace

}  // namespace krepl::test
