// Reading networks: which geometry becomes which part, under which number. Messages are tested in tests/cli.
#include <gtest/gtest.h>

#include "input/network_reader.hpp"
#include "support/temporary_file.hpp"

namespace krepl::test {
namespace {

class NetworkReader : public testing::Test {
 protected:
  Result<input::NetworkData> read(const std::string& text, input::NetworkRequest request = {}) {
    request.path = directory_.write("in.wkt", text);
    return input::read_network(request);
  }
  /// The vertices of a part in absolute coordinates.
  static std::vector<Point> part(const Network& network, std::uint32_t p) {
    std::vector<Point> points;
    for (std::uint32_t v : network.part(p)) {
      points.push_back({network.origin().x + network.vertices()[v].x, network.origin().y + network.vertices()[v].y});
    }
    return points;
  }
  TemporaryDirectory directory_;
};

TEST_F(NetworkReader, PartsKeepOrderKindAndLineNumber) {
  Result<input::NetworkData> data = read(
      "# a comment\n"
      "MULTILINESTRING ((0 0, 1 2, 3 1), (5 5, 6 6))\n"
      "\n"
      "POLYGON ((10 10, 14 10, 14 14, 10 10), (11 10.5, 12 10.5, 12 11, 11 10.5))\r\n"
      "MULTIPOINT ((20 20), (21 21))\n");
  ASSERT_TRUE(data.ok()) << data.error().text();
  const Network& network = *data->network;
  EXPECT_EQ(data->features, 3u);
  EXPECT_TRUE(data->notes.empty());
  EXPECT_EQ(data->crs, "");
  ASSERT_EQ(network.part_count(), 6u);
  std::vector<std::int64_t> features;
  std::vector<bool> rings;
  for (std::uint32_t p = 0; p < 6; ++p) {
    features.push_back(network.part_feature(p));
    rings.push_back(network.part_is_ring(p));
  }
  EXPECT_EQ(features, (std::vector<std::int64_t>{2, 2, 4, 4, 5, 5}));
  EXPECT_EQ(rings, (std::vector<bool>{false, false, true, true, false, false}));
  EXPECT_EQ(part(network, 0), (std::vector<Point>{{0, 0}, {1, 2}, {3, 1}}));
  EXPECT_EQ(part(network, 5), (std::vector<Point>{{21, 21}}));
  EXPECT_TRUE(network.has_polygons());
}

TEST_F(NetworkReader, CoordinatesAreReadWithoutLoss) {
  Result<input::NetworkData> data = read("LINESTRING (0.1 0.30000000000000004, 5e-324 1.7976931348623157e300)\n");
  ASSERT_TRUE(data.ok()) << data.error().text();
  data = read("LINESTRING (672345.12345678912 3981234.9876543210, 672346.1 3981235.2)\n");
  ASSERT_TRUE(data.ok()) << data.error().text();
  EXPECT_EQ(part(*data->network, 0).front(), (Point{672345.12345678912, 3981234.9876543210}));
}

TEST_F(NetworkReader, EmptyPartsAreLeftOutAndEmptyFeaturesNoted) {
  Result<input::NetworkData> data = read("LINESTRING EMPTY\nMULTILINESTRING (EMPTY, (0 0, 1 1))\nPOINT EMPTY\n");
  ASSERT_TRUE(data.ok()) << data.error().text();
  EXPECT_EQ(data->network->part_count(), 1u);
  EXPECT_EQ(data->features, 1u);
  ASSERT_EQ(data->notes.size(), 1u);
  EXPECT_EQ(data->notes[0], "note: 2 features without geometry are left out");
}

TEST_F(NetworkReader, LinesLongerThanTheBuffer) {
  std::string text = "LINESTRING (0 0";
  for (int i = 1; i < 100000; ++i) text += ", " + std::to_string(i) + " " + std::to_string(i % 7);
  Result<input::NetworkData> data = read("POINT (-1 -1)\n" + text + ")");
  ASSERT_TRUE(data.ok()) << data.error().text();
  EXPECT_EQ(data->network->part(1).size(), 100000u);
  EXPECT_EQ(data->network->part_feature(1), 2);
}

TEST_F(NetworkReader, ErrorsAreValues) {
  EXPECT_EQ(read("POINT (1 1)\nPOINT 2 2\n").error().where, "line 2: 'POINT 2 2'");
  EXPECT_EQ(read("").error().code, ErrorCode::input);
  input::NetworkRequest request;
  request.crs = "nonsense";
  EXPECT_EQ(read("POINT (1 1)\n", request).error().code, ErrorCode::usage);
}

TEST_F(NetworkReader, CancelEndsReading) {
  std::atomic<bool> cancel{true};
  Context context;
  context.cancel = &cancel;
  input::NetworkRequest request;
  request.path = directory_.write("in.wkt", "POINT (1 1)\n");
  Result<input::NetworkData> data = input::read_network(request, context);
  ASSERT_FALSE(data.ok());
  EXPECT_EQ(data.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace krepl::test
