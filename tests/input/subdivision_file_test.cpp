// Reading of subdivisions: what is right is read whole, what is wrong is named with its place.
#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "input/subdivision_file.hpp"
#include "support/temporary_file.hpp"

namespace krepl::test {
namespace {

using input::SubdivisionFile;

const std::string right = R"({"krepl":"subdivision","version":1,"radius":2.5,
"features":[{"kind":"vertex","at":[[1,2,3]]},{"at":[[1,2,3],[4,5,6]],"kind":"edge","note":{"a":[1,null,true,"x\"]"]}}],
"vertices":[[0.1,-2e-3,3]],
"edges":[{"kind":"rim","curve":"circle","features":[0,null],"points":[[1,0,0],[0,1,0],[1,0,0]]},
  {"kind":"seam","curve":"line","features":[1,0],"points":[[1,0,0],[0,1,0],[2,1,0],[1,0,0]]}],
"half_edges":[[0,1,2,3,4],[5,6,7,8,9]],
"later":[[],{},-1.5e3],
"faces":[{"feature":null,"outer":null,"inner":[1,0]},{"feature":0,"outer":0,"inner":[]},{"feature":1,"outer":1,"inner":[2]}]}
)";

Result<SubdivisionFile> read(const std::string& text) {
  const TemporaryDirectory directory;
  return input::read_subdivision(directory.write("subdivision.json", text));
}

TEST(SubdivisionFile, ReadsAll) {
  const auto file = read(right);
  ASSERT_TRUE(file.ok()) << file.error().text();
  const SubdivisionFile& f = file.value();
  EXPECT_EQ(f.radius, 2.5);
  ASSERT_EQ(f.features.size(), 2u);
  EXPECT_EQ(f.features[1].count, 2);
  EXPECT_EQ(f.features[1].at[1], (Point3{4, 5, 6}));
  EXPECT_EQ(f.vertices[0], (Point3{0.1, -2e-3, 3}));
  ASSERT_EQ(f.edges.size(), 2u);
  EXPECT_EQ(f.edges[0].kind, SubdivisionFile::EdgeKind::rim);
  EXPECT_EQ(f.edges[0].curve, SubdivisionFile::Curve::circle);
  EXPECT_EQ(f.edges[0].feature[1], SubdivisionFile::none);
  EXPECT_EQ(f.edges[1].first, 3u);
  EXPECT_EQ(f.points_end(0), 3u);
  EXPECT_EQ(f.points_end(1), 7u);
  EXPECT_EQ(f.half_edges[1].edge, 9u);
  EXPECT_EQ(f.faces[0].outer, SubdivisionFile::none);
  EXPECT_EQ(f.inner_end(0), 2u);
  EXPECT_EQ(f.inner_end(1), 2u);
  EXPECT_EQ(f.inner[2], 2u);
}

TEST(SubdivisionFile, ReadsMoreThanItsBufferHolds) {
  std::string vertices;
  for (int i = 0; i < 200'000; ++i) vertices += (i > 0 ? ",\n[" : "[") + std::to_string(i) + ".125,0,-1e-17]";
  std::string text = right;
  text.replace(text.find("[0.1,-2e-3,3]"), 13, vertices);
  const auto file = read(text);
  ASSERT_TRUE(file.ok()) << file.error().text();
  ASSERT_EQ(file.value().vertices.size(), 200'000u);
  for (int i = 0; i < 200'000; ++i) ASSERT_EQ(file.value().vertices[std::size_t(i)].x, i + 0.125);
}

TEST(SubdivisionFile, NamesWhatIsWrong) {
  const struct {
    std::string from, to, what;
  } faults[] = {
      {"\"version\":1", "\"version\":2", "version"},
      {"\"subdivision\"", "\"zone\"", "subdivision"},
      {"\"radius\":2.5,", "", "no \"radius\""},
      {"\"radius\":2.5", "\"radius\":2.5,\"radius\":3", "twice"},
      {"\"radius\":2.5", "\"radius\":NaN", "a number expected"},
      {"\"radius\":2.5", "\"radius\":1e999", "a number that no double holds"},
      {"[0.1,-2e-3,3]", "[0.1,-2e-3]", "vertices[0]"},
      {"[0.1,-2e-3,3]", "[0.1,-2e-3,3,4]", "more than three numbers"},
      {"[5,6,7,8,9]", "[5,6,7,8]", "half_edges[1]"},
      {"[5,6,7,8,9]", "[5,6,7,8.5,9]", "an index expected"},
      {"[5,6,7,8,9]", "[5,6,7,-8,9]", "an index expected"},
      {"[5,6,7,8,9]", "[5,6,7,8000000000,9]", "too large"},
      {"\"seam\"", "\"seem\"", "edges[1]"},
      {"[1,0]", "[1,0,1]", "more than two features"},
      {"[2,1,0],[1,0,0]]}],", "[2,1,0],[1,0,0]]}", "expected"},
      {",[0,1,0],[1,0,0]]},", ",[0,1,0]]},", "fewer than three points"},
      {"{\"feature\":0,\"outer\":0,", "{\"feature\":0,", "faces[1]"},
      {"\"at\":[[1,2,3]]", "\"at\":[[1,2,3],[1,2,4]]", "features[0]"},
      {"\"inner\":[2]}]}", "\"inner\":[2]}]} {}", "more text"},
      {"\"inner\":[2]}]}", "\"inner\":[2", "ends early"},
  };
  for (const auto& [from, to, what] : faults) {
    std::string text = right;
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
    const auto file = read(text);
    ASSERT_FALSE(file.ok()) << to;
    EXPECT_EQ(file.error().code, ErrorCode::input);
    EXPECT_NE(file.error().text().find(what), std::string::npos) << to << " gave " << file.error().text();
    EXPECT_NE(file.error().text().find("line "), std::string::npos);
  }
  EXPECT_FALSE(read("").ok());
  EXPECT_FALSE(read("[1]").ok());
  EXPECT_FALSE(input::read_subdivision("/nowhere/at all.json").ok());
}

TEST(SubdivisionFile, EndsAnywhere) {
  // Cut at each place: never more than an error.
  for (std::size_t n = 0; n + 2 < right.size(); n += 3) EXPECT_FALSE(read(right.substr(0, n)).ok()) << n;
}

TEST(SubdivisionFile, IsToldFromOtherJson) {
  const TemporaryDirectory directory;
  EXPECT_TRUE(input::looks_like_subdivision(directory.write("a.json", right)));
  EXPECT_FALSE(
      input::looks_like_subdivision(directory.write("b.json", R"({"type":"FeatureCollection","features":[]})")));
  EXPECT_FALSE(input::looks_like_subdivision("/nowhere.json"));
}

TEST(SubdivisionFile, StopsWhenToldTo) {
  const std::atomic<bool> stop{true};
  Context context;
  context.cancel = &stop;
  const TemporaryDirectory directory;
  const auto result = input::read_subdivision(directory.write("subdivision.json", right), context);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace krepl::test
