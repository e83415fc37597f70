// The data of a page: chains, arcs, sums, provenance; and that what is written can be read back from the page.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "view/base64.hpp"
#include "view/page_data.hpp"
#include "view/render_page.hpp"

namespace {

using namespace krepl;
using namespace krepl::view;
constexpr double pi = std::numbers::pi;

input::ResultPiece segment(Point a, Point b) { return {false, a, {}, b, -1, -1, -1}; }
input::ResultPiece arc(Point a, Point m, Point b) { return {true, a, m, b, -1, -1, -1}; }

/// A stadium about (0,0)-(4,0) with radius 1, moved by `at`; counter-clockwise.
input::ResultRing stadium(Point at) {
  const auto p = [&](double x, double y) { return Point{at.x + x, at.y + y}; };
  return {{segment(p(0, -1), p(4, -1)), arc(p(4, -1), p(5, 0), p(4, 1)), segment(p(4, 1), p(0, 1)),
           arc(p(0, 1), p(-1, 0), p(0, -1))}};
}

input::ResultRing circle(Point center, double radius) {
  return {{arc({center.x - radius, center.y}, {center.x + radius, center.y}, {center.x - radius, center.y})}};
}

std::string decoded(const std::string& text) {
  std::string bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((bits += 6) >= 8) bytes += static_cast<char>(word >> (bits -= 8) & 255);
  }
  return bytes;
}

std::string element(const std::string& page, const std::string& id) {
  const std::size_t mark = page.find("id=\"" + id + "\">");
  EXPECT_NE(mark, std::string::npos) << id;
  const std::size_t begin = page.find('>', mark) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

template <class T>
std::vector<T> array(const std::string& page, const std::string& id) {
  const std::string bytes = decoded(element(page, id));
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST(ZoneLayers, StadiumHasExactAreaAndLengthFarFromTheOrigin) {
  for (const Point at : {Point{0, 0}, Point{5e6, -3e6}}) {
    auto layers = zone_layers({{1.0, {{stadium(at), {}}}, ""}});
    ASSERT_TRUE(layers.ok());
    const Layer& layer = layers->front();
    EXPECT_EQ(layer.kind, (std::vector<PieceKind>{PieceKind::segment, PieceKind::arc_left, PieceKind::segment,
                                                  PieceKind::arc_left}));
    EXPECT_EQ(layer.vertices.size(), 5u);
    EXPECT_EQ(layer.vertices.front(), layer.vertices.back());
    EXPECT_NEAR(layer.area, 8 + pi, 1e-12);
    EXPECT_NEAR(layer.perimeter, 8 + 2 * pi, 1e-12);
    ASSERT_EQ(layer.centers.size(), 2u);
    EXPECT_NEAR(layer.centers[0].x, at.x + 4, 1e-9);
    EXPECT_NEAR(layer.centers[0].y, at.y, 1e-9);
  }
}

TEST(ZoneLayers, ArcsBeyondHalfACircleAndClockwiseOnes) {
  // Three quarters of the unit circle counter-clockwise and the chord back: 3 pi / 4 + 1 / 2.
  const double h = std::sqrt(0.5);
  const input::ResultRing three_quarters{{arc({1, 0}, {-h, h}, {0, -1}), segment({0, -1}, {1, 0})}};
  auto layers = zone_layers({{std::nullopt, {{three_quarters, {}}}, ""}});
  ASSERT_TRUE(layers.ok());
  EXPECT_NEAR(layers->front().area, 3 * pi / 4 + 0.5, 1e-14);
  EXPECT_NEAR(layers->front().perimeter, 1.5 * pi + std::sqrt(2.0), 1e-14);

  // A quarter circle that cuts into a square: clockwise about the corner (1, 1).
  const input::ResultRing bitten{
      {segment({0, 0}, {1, 0}), arc({1, 0}, {1 - h, 1 - h}, {0, 1}), segment({0, 1}, {0, 0})}};
  layers = zone_layers({{1.0, {{bitten, {}}}, ""}});
  ASSERT_TRUE(layers.ok());
  EXPECT_EQ(layers->front().kind[1], PieceKind::arc_right);
  EXPECT_NEAR(layers->front().centers[0].x, 1, 1e-15);
  EXPECT_NEAR(layers->front().area, 1 - pi / 4, 1e-14);
}

TEST(ZoneLayers, FullCirclesAndHoles) {
  auto layers = zone_layers({{2.0, {{circle({10, 10}, 2), {circle({10, 10}, 1)}}, {circle({0, 0}, 0.5), {}}}, "here"}});
  ASSERT_TRUE(layers.ok());
  const Layer& layer = layers->front();
  EXPECT_EQ(layer.polygons, 2u);
  EXPECT_EQ(layer.hole_count(), 1u);
  EXPECT_EQ(layer.chain_kind, (std::vector<ChainKind>{ChainKind::outer, ChainKind::hole, ChainKind::outer}));
  EXPECT_EQ(layer.arc_count(), 3u);
  EXPECT_NEAR(layer.area, pi * (4 - 1 + 0.25), 1e-12);
  EXPECT_NEAR(layer.perimeter, 2 * pi * 3.5, 1e-12);
}

TEST(ZoneLayers, LargestRadiusBelowAndProvenanceKept) {
  input::ResultRing ring = stadium({0, 0});
  ring.pieces[0].source_feature = 7'000'000'000;
  ring.pieces[0].source_part = 3;
  ring.pieces[0].source_vertex = 12;
  auto layers = zone_layers({{1.0, {{ring, {}}}, ""}, {4.0, {{circle({0, 0}, 9), {}}}, ""}});
  ASSERT_TRUE(layers.ok());
  ASSERT_EQ(layers->size(), 2u);
  EXPECT_EQ((*layers)[0].radius, 4.0);
  EXPECT_TRUE((*layers)[0].source_part.empty());
  const Layer& small = (*layers)[1];
  EXPECT_EQ(small.parts, (std::vector<Layer::Part>{{7'000'000'000, 3}}));
  const std::uint32_t no = Layer::unknown;
  EXPECT_EQ(small.source_part, (std::vector<std::uint32_t>{0, no, no, no}));
  EXPECT_EQ(small.source_vertex, (std::vector<std::uint32_t>{12, no, no, no}));
}

TEST(ZoneLayers, ProvenanceThatStartsLateLeavesTheFirstPiecesUnknown) {
  input::ResultRing ring = stadium({0, 0});
  ring.pieces[2].source_part = 0;
  ring.pieces[2].source_vertex = 5;
  auto layers = zone_layers({{1.0, {{ring, {}}}, ""}});
  ASSERT_TRUE(layers.ok());
  const std::uint32_t no = Layer::unknown;
  EXPECT_EQ(layers->front().source_vertex, (std::vector<std::uint32_t>{no, no, 5, no}));
}

TEST(ZoneLayers, ArcThroughThreePointsOfALineIsASegment) {
  const input::ResultRing ring{{arc({0, 0}, {1, 0}, {2, 0}), segment({2, 0}, {2, 1}), segment({2, 1}, {0, 0})}};
  auto layers = zone_layers({{1.0, {{ring, {}}}, ""}});
  ASSERT_TRUE(layers.ok());
  EXPECT_EQ(layers->front().arc_count(), 0u);
  EXPECT_DOUBLE_EQ(layers->front().area, 1);
}

TEST(ZoneLayers, NothingAndNotFiniteAreErrors) {
  EXPECT_FALSE(zone_layers({}).ok());
  EXPECT_FALSE(zone_layers({{1.0, {}, ""}}).ok());
  input::ResultRing ring = stadium({0, 0});
  ring.pieces[1].middle.x = std::numeric_limits<double>::quiet_NaN();
  auto layers = zone_layers({{1.0, {{ring, {}}}, ""}});
  ASSERT_FALSE(layers.ok());
  EXPECT_NE(layers.error().text().find("not finite"), std::string::npos);
}

class ProfileFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    path_ = std::filesystem::temp_directory_path() /
            ("krepl_view_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".csv");
    std::ofstream(path_) << text;
    return path_.string();
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::filesystem::path path_;
};

const std::string header = "kind,x0,y0,x1,y1,cx,cy,segment\n";

TEST_F(ProfileFile, OnePointIsAHalfCircleBetweenHalfLines) {
  auto rows = read_profile_rows(
      write(header + "half_line,-2,-inf,-2,0,,,v0\narc,-2,0,2,0,0,0,v0\nhalf_line,2,0,2,-inf,,,v0\n"));
  ASSERT_TRUE(rows.ok()) << rows.error().text();
  auto layer = profile_layer(*rows);
  ASSERT_TRUE(layer.ok());
  EXPECT_EQ(layer->kind, (std::vector<PieceKind>{PieceKind::half_line, PieceKind::arc_right, PieceKind::half_line}));
  EXPECT_EQ(layer->radius, 2.0);
  EXPECT_NEAR(layer->perimeter, 2 * pi, 1e-14);
  EXPECT_EQ(layer->chain_kind, (std::vector<ChainKind>{ChainKind::open}));
  EXPECT_EQ(layer->source_vertex, (std::vector<std::uint32_t>{0, 0, 0}));
  for (const Point p : layer->vertices) EXPECT_TRUE(std::isfinite(p.y));
  EXPECT_LT(layer->vertices.front().y, -100);
}

TEST_F(ProfileFile, FaultsNameTheLine) {
  const struct {
    std::string rows, what;
  } cases[] = {
      {"", "holds no piece"},
      {"half_line,-2,-inf,-2,0,,,v0\nbump,-2,0,2,0,0,0,v0\n", "line 3"},
      {"half_line,-2,-inf,-2,0,,,v0\narc,-1,0,2,0,0,0,v0\n", "does not start where"},
      {"half_line,-2,-inf,-2,zero,,,v0\n", "not a number"},
      {"half_line,-2,0,-2,1,,,v0\n", "does not come from -inf"},
      {"segment,0,0,1\n", "8 columns"},
      {"segment,0,0,1,nan,,,s0\n", "not finite"},
  };
  for (const auto& c : cases) {
    auto rows = read_profile_rows(write(header + c.rows));
    ASSERT_FALSE(rows.ok()) << c.rows;
    EXPECT_NE(rows.error().text().find(c.what), std::string::npos) << rows.error().text();
  }
  EXPECT_FALSE(read_profile_rows(write("x,y\n1,2\n")).ok());
  EXPECT_FALSE(read_profile_rows("/nonexistent/profile.csv").ok());
}

TEST_F(ProfileFile, TerrainColumnsByName) {
  auto terrain = read_terrain_rows(write("name,z,x\na,5,1\nb,6,2.5\n"));
  ASSERT_TRUE(terrain.ok());
  EXPECT_EQ(*terrain, (std::vector<Point>{{1, 5}, {2.5, 6}}));
  EXPECT_FALSE(read_terrain_rows(write("a,b\n1,2\n")).ok());
}

TEST(Page, ArraysComeBackBitForBit) {
  auto layers = zone_layers({{0.1, {{stadium({1e-3, 1.0 / 3}), {circle({1, 0.3}, 0.1)}}}, ""}});
  ASSERT_TRUE(layers.ok());
  const PageData data{"t", "c", "m", *layers};
  const std::string page = render_page(data);
  const auto json = nlohmann::json::parse(element(page, "page"));
  const auto& stored = json["layers"][0];
  const Layer& layer = data.layers[0];
  EXPECT_EQ(stored["radius"], 0.1);
  EXPECT_EQ(stored["area"], layer.area);
  EXPECT_EQ(array<double>(page, stored["vertices"]).size(), 2 * layer.vertices.size());
  const auto vertices = array<Point>(page, stored["vertices"]);
  EXPECT_EQ(vertices, layer.vertices);
  EXPECT_EQ(array<std::uint32_t>(page, stored["vertexBegin"]), layer.vertex_begin);
  EXPECT_EQ(array<PieceKind>(page, stored["kind"]), layer.kind);
  EXPECT_EQ(array<Point>(page, stored["centers"]), layer.centers);
  EXPECT_EQ(page, render_page(data)) << "the same data must give the same bytes";
}

TEST(Page, TitlesCannotBreakThePage) {
  auto layers = zone_layers({{1.0, {{stadium({0, 0}), {}}}, ""}});
  ASSERT_TRUE(layers.ok());
  const std::string title = "</script><script>alert(1)</script> & \"{{data}}\"";
  const std::string page = render_page({title, "</title>", "m", *layers});
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("& \"{{"), std::string::npos) << "a quotation mark ends the attribute that holds the title";
  EXPECT_EQ(nlohmann::json::parse(element(page, "page"))["title"], title);
}

TEST(Page, NeedsNothingFromOutside) {
  auto layers = zone_layers({{1.0, {{stadium({0, 0}), {}}}, ""}});
  ASSERT_TRUE(layers.ok());
  const std::string page = render_page({"t", "", "", *layers});
  for (const char* mark : {"http:", "https:", "//cdn", "src=", "href=", "@import", "url("})
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
  EXPECT_EQ(page.find("{{"), std::string::npos);
}

TEST(Base64, KnownAnswers) {
  const auto encoded = [](const std::string& bytes) {
    std::string text;
    append_base64(text, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    return text;
  };
  EXPECT_EQ(encoded(""), "");  // RFC 4648, section 10
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe"), "//4=");
}

}  // namespace
