// Terrains and results from files: what is taken, and which line is named where it is not.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "input/profile_reader.hpp"

namespace krepl::test {

namespace {

class Files : public testing::Test {
 protected:
  Files() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    directory_ = std::filesystem::temp_directory_path() /
                 ("krepl-reader-" + std::string(info->name()) + std::to_string(::getpid()));
    std::filesystem::create_directories(directory_);
  }
  ~Files() override { std::filesystem::remove_all(directory_); }
  std::string file(const std::string& name, const std::string& content) {
    const auto path = directory_ / name;
    std::ofstream(path, std::ios::binary) << content;
    return path.string();
  }
  Result<input::TerrainLine> terrain(const std::string& content, const std::string& name = "t.csv") {
    return input::read_terrain_line({file(name, content), "", ""});
  }
  std::string error(const std::string& content, const std::string& name = "t.csv") {
    const auto data = terrain(content, name);
    return data ? "no error" : data.error().what + " @ " + data.error().where;
  }
  std::filesystem::path directory_;
};

TEST_F(Files, CsvInManyDresses) {
  const std::vector<Point> points{{0, 1.5}, {2, -3}, {2, 4e3}};
  const char* texts[] = {"x,z\n0,1.5\n2,-3\n2,4e3\n",
                         "x,z\r\n0,1.5\r\n2,-3\r\n2,4e3",
                         "\xEF\xBB\xBFX , Z\n 0 , 1.5 \n\n2,-3\n# remark\n2,+4000\n",
                         "name;z;x\na;1.5;0\nb;-3;2\nc;4e3;2\n",
                         "\"x\"\t\"z\"\n0\t1.5\n2\t-3\n2\t4000\n"};
  for (const char* text : texts) {
    const auto data = terrain(text);
    ASSERT_TRUE(data.ok()) << data.error().text();
    EXPECT_EQ(data->points, points) << text;
  }
}

TEST_F(Files, CsvErrorsNameTheLine) {
  EXPECT_EQ(error("x,y\n1,2\n"), "has no column 'z' @ line 1");
  EXPECT_EQ(error("x,z\n1,2\n\n# note\n2,\n"), "z is missing @ line 5");
  EXPECT_EQ(error("x,z\n1,2\n3\n"), "z is missing @ line 3");
  EXPECT_EQ(error("x,z\n1,2\n3,4m\n"), "z '4m' is not a number @ line 3");
  EXPECT_EQ(error("x,z\n1,nan\n"), "z is not finite @ line 2");
  EXPECT_EQ(error("x,z\n-inf,2\n"), "x is not finite @ line 2");
  EXPECT_EQ(error("x,z\n1,1e999\n"), "z '1e999' is out of the range of numbers @ line 2");
  EXPECT_EQ(error("x,z\n1,2\n0.5,2\n"), "x decreases from 1 to 0.5 @ line 3");
  EXPECT_EQ(error("x,z\n"), "has no points @ ");
  EXPECT_NE(error(""), "no error");
  EXPECT_NE(error("\n\n"), "no error");
  EXPECT_FALSE(input::read_terrain_line({(directory_ / "missing.csv").string(), "", ""}).ok());
  EXPECT_FALSE(input::read_terrain_line({directory_.string(), "", ""}).ok());
  EXPECT_FALSE(input::read_terrain_line({file("u.csv", "x,z\n1,2\n"), "layer", ""}).ok());
}

TEST_F(Files, LineInAVectorFile) {
  const auto flat = terrain("LINESTRING (0 5, 2 6, 2 8, 7 1)\n", "t.wkt");
  ASSERT_TRUE(flat.ok()) << flat.error().text();
  EXPECT_EQ(flat->points, (std::vector<Point>{{0, 5}, {2, 6}, {2, 8}, {7, 1}}));
  const auto solid = terrain("LINESTRING Z (0 0 5, 3 4 6, 3 4 8, 0 0 1)\n", "u.wkt");
  ASSERT_TRUE(solid.ok()) << solid.error().text();
  EXPECT_EQ(solid->points, (std::vector<Point>{{0, 5}, {5, 6}, {5, 8}, {10, 1}}));
  EXPECT_EQ(solid->notes.size(), 1u);
}

TEST_F(Files, VectorErrorsNameTheFeature) {
  EXPECT_EQ(error("POINT (1 2)\n", "a.wkt"), "a POINT is not one line @ line 1");
  EXPECT_EQ(error("LINESTRING (0 0, 1 1)\nLINESTRING (2 0, 3 1)\n", "b.wkt"), "has more than one line @ line 2");
  EXPECT_EQ(error("LINESTRING (0 0, 2 1, 1 1)\n", "c.wkt"), "x decreases from 2 to 1 @ line 1, vertex 2");
  EXPECT_EQ(error("SRID=4326;LINESTRING (0 0, 2 1)\n", "d.wkt"), "coordinates are in degrees @ ");
}

TEST_F(Files, ResultsAreReadBack) {
  const auto rows = input::read_profile(file("r.csv",
      "kind,x0,y0,x1,y1,cx,cy,segment\nhalf_line,-1,-inf,-1,0,,,v0\narc,-1,0,0,1,0,0,v0\nsegment,0,1,3,1,,,s12\n"));
  ASSERT_TRUE(rows.ok()) << rows.error().text();
  ASSERT_EQ(rows->size(), 3u);
  EXPECT_EQ((*rows)[0].start.y, -HUGE_VAL);
  EXPECT_EQ((*rows)[1].kind, input::ProfileRecord::Kind::arc);
  EXPECT_EQ((*rows)[1].center, (Point{0, 0}));
  EXPECT_TRUE((*rows)[2].by_segment);
  EXPECT_EQ((*rows)[2].cause, 12u);
  EXPECT_EQ((*rows)[2].line, 4u);
}

TEST_F(Files, ResultErrorsNameTheLine) {
  const std::string header = "kind,x0,y0,x1,y1,cx,cy,segment\n";
  const auto where = [&](const std::string& text) {
    const auto rows = input::read_profile(file("e.csv", text));
    return rows ? std::string("no error") : rows.error().where;
  };
  EXPECT_EQ(where(header + "curve,0,0,1,1,,,s0\n"), "line 2");
  EXPECT_EQ(where(header + "segment,0,0,1,1,,,x0\n"), "line 2");
  EXPECT_EQ(where(header + "segment,0,0,1,1,,,s\n"), "line 2");
  EXPECT_EQ(where(header + "segment,0,0,1,inf,,,s0\n"), "line 2");
  EXPECT_EQ(where(header + "arc,0,0,1,1,,,v0\n"), "line 2");
  EXPECT_EQ(where("kind,x0,y0\n"), "line 1");
  EXPECT_NE(where(header), "no error");
}

}  // namespace

}  // namespace krepl::test
