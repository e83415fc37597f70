// Programs as LinuxCNC's interpreter (rs274) understands them, move by move.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>

#include "mill/path_check.hpp"
#include "output/gcode_file.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {
namespace {

/// One line of the interpreter's output that moves the tool.
struct CanonicalMove {
  std::string name;
  std::vector<double> numbers;
};

struct Interpretation {
  bool accepted = false;
  std::string complaint;
  std::vector<CanonicalMove> moves;
  std::string text;
};

bool has_interpreter() { return std::system("command -v rs274 >/dev/null 2>&1") == 0; }

Interpretation interpret(const std::string& program, const std::filesystem::path& directory) {
  std::ofstream(directory / "tool.tbl") << "T1 P1 D1 Z0\nT7 P7 D1 Z0\n";
  std::ofstream(directory / "rs274.var") << "5161 0\n5162 0\n5163 0\n5220 1\n";
  const auto out = directory / "canonical.txt", error = directory / "error.txt";
  const std::string command = "cd '" + directory.string() + "' && rs274 -g -t tool.tbl -v rs274.var '" + program +
                              "' >canonical.txt 2>error.txt";
  Interpretation result;
  result.accepted = std::system(command.c_str()) == 0;
  std::stringstream complaint;
  complaint << std::ifstream(error).rdbuf();
  result.complaint = complaint.str();
  std::ifstream in(out);
  for (std::string line; std::getline(in, line);) {
    result.text += line + "\n";
    for (const char* name : {"STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED"}) {
      const std::size_t at = line.find(std::string(name) + "(");
      if (at == std::string::npos) continue;
      CanonicalMove move{name, {}};
      std::stringstream numbers(line.substr(at + std::string(name).size() + 1));
      for (double x; numbers >> x;) {
        move.numbers.push_back(x);
        if (numbers.peek() == ',') numbers.ignore();
      }
      result.moves.push_back(move);
    }
  }
  return result;
}

/// The largest difference between a path and what the interpreter makes of its program; -1 where the kinds of moves
/// differ.
double worst_difference(const ToolPath& path, double below_centre, const std::vector<CanonicalMove>& moves,
                        std::size_t first) {
  double worst = 0;
  std::size_t n = first;
  Point3 at = path.start;
  const auto look = [&](double a, double b) { worst = std::max(worst, std::abs(a - b)); };
  for (const Move& m : path.moves) {
    const bool arc = m.kind == MoveKind::clockwise || m.kind == MoveKind::counter_clockwise;
    if (!arc && m.end == at) continue;
    if (n == moves.size()) return -1;
    const CanonicalMove& c = moves[n++];
    const Point3 end{m.end.x, m.end.y, m.end.z - below_centre},
        centre{m.centre.x, m.centre.y, m.centre.z - below_centre};
    at = m.end;
    if (c.name != (arc                         ? "ARC_FEED"
                   : m.kind == MoveKind::rapid ? "STRAIGHT_TRAVERSE"
                                               : "STRAIGHT_FEED") ||
        c.numbers.size() < 6)
      return -1;
    if (!arc) {
      look(c.numbers[0], end.x), look(c.numbers[1], end.y), look(c.numbers[2], end.z);
      continue;
    }
    // Ends, centre, sense, and the coordinate along the axis.
    if (m.plane == ArcPlane::xy) {
      look(c.numbers[0], end.x), look(c.numbers[1], end.y), look(c.numbers[2], centre.x), look(c.numbers[3], centre.y);
      look(c.numbers[5], end.z);
    } else if (m.plane == ArcPlane::zx) {
      look(c.numbers[0], end.z), look(c.numbers[1], end.x), look(c.numbers[2], centre.z), look(c.numbers[3], centre.x);
      look(c.numbers[5], end.y);
    } else {
      look(c.numbers[0], end.y), look(c.numbers[1], end.z), look(c.numbers[2], centre.y), look(c.numbers[3], centre.z);
      look(c.numbers[5], end.x);
    }
    if (c.numbers[4] != (m.kind == MoveKind::clockwise ? -1 : 1)) return -1;
  }
  return n == moves.size() ? worst : -1;
}

class Programs : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_interpreter()) GTEST_SKIP() << "rs274 is not installed (Debian: linuxcnc-uspace)";
    directory_ = std::filesystem::temp_directory_path() /
                 ("krepl-gcode-" + std::to_string(std::rand()) + "-" + std::to_string(seed()));
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override {
    if (!directory_.empty()) std::filesystem::remove_all(directory_);
  }

  void expect_same(const std::shared_ptr<const Terrain>& part, const ParallelOptions& o,
                   const output::GcodeOptions& gcode) {
    const auto milled = mill_parallel(part, o);
    ASSERT_TRUE(milled) << milled.error().text();
    arcs_ += milled->report.arcs;
    expect_read(milled->path, gcode);
  }

  void expect_read(const ToolPath& path, const output::GcodeOptions& gcode) {
    const std::string program = (directory_ / "part.ngc").string();
    const auto lines = output::write_gcode(program, path, gcode);
    ASSERT_TRUE(lines) << lines.error().text();
    const Interpretation found = interpret(program, directory_);
    EXPECT_TRUE(found.accepted) << found.complaint
                                << found.text.substr(found.text.size() > 500 ? found.text.size() - 500 : 0);
    EXPECT_NE(found.text.find("PROGRAM_END"), std::string::npos) << found.complaint;
    EXPECT_NE(found.text.find(gcode.inches ? "CANON_UNITS_INCHES" : "CANON_UNITS_MM"), std::string::npos);
    // The two moves to the start come first.
    const double worst = worst_difference(path, gcode.below_centre, found.moves, 2);
    EXPECT_GE(worst, 0) << "another kind or number of moves";
    EXPECT_LE(worst, 1e-4) << "rs274 prints four decimals";
    moves_ += found.moves.size();
  }

  std::filesystem::path directory_;
  std::size_t arcs_ = 0, moves_ = 0;
};

TEST_F(Programs, AreWhatTheInterpreterDoes) {
  std::mt19937 random(seed());
  for (int k = 0; k < 16; ++k) {
    std::vector<std::uint8_t> bytes(40);
    for (auto& b : bytes) b = std::uint8_t(random());
    SmallTerrain c = decode_small_terrain(k % 2 == 0 ? SmallTerrainFamily::grid : SmallTerrainFamily::soup, bytes);
    c.radius = 1.5;
    const auto part = terrain_of(c);
    if (!part) continue;
    ParallelOptions o;
    output::GcodeOptions gcode;
    o.tool.radius = c.radius, o.step_over = 0.5, o.angle = 90 * (k % 4);
    gcode.post = k % 3 == 0 ? output::GcodePost::grbl : output::GcodePost::linuxcnc;
    if (k % 3 == 0) o.accuracy.arc_error = 0.002;
    gcode.inches = k % 5 == 0;
    gcode.decimals = gcode.inches ? 5 : 4;
    o.accuracy.unit = std::pow(10.0, -gcode.decimals);
    o.accuracy.control_point = k % 7 == 0 ? ControlPoint::centre : ControlPoint::tip;
    gcode.below_centre = k % 7 == 0 ? 0 : c.radius;
    gcode.spindle_speed = k % 2 * 9000, gcode.tool_number = k % 4 == 0 ? 7 : 1;
    gcode.part_name = "soup (with) umlaut \xc3\xa4", gcode.strategy = "parallel", gcode.tool_name = "ball-nose";
    expect_same(*part, o, gcode);
  }
  RoughOptions rough;
  rough.tool.radius = 1.5, rough.step_over = 1, rough.step_down = 1;
  const auto block = Terrain::from_grid({3, 3, {0, 0}, 5, 5, Terrain::Split::rising}, {0, 0, 0, 0, 3, 0, 0, 0, 1});
  ASSERT_TRUE(block);
  const auto roughed = mill_rough(std::make_shared<const Terrain>(*block), rough);
  ASSERT_TRUE(roughed) << roughed.error().text();
  output::GcodeOptions gcode;
  gcode.below_centre = 1.5;
  expect_read(roughed->path, gcode);
  // A pocket, entered down a helix.
  const auto pocket = Terrain::from_grid({5, 5, {0, 0}, 4, 4, Terrain::Split::rising},
                                         {3, 3, 3, 3, 3, 3, 0, 0, 0, 3, 3, 0, 0, 0, 3, 3, 0, 0, 0, 3, 3, 3, 3, 3, 3});
  ASSERT_TRUE(pocket);
  const auto entered = mill_rough(std::make_shared<const Terrain>(*pocket), rough);
  ASSERT_TRUE(entered) << entered.error().text();
  std::size_t helices = 0;
  Point3 before = entered->path.start;
  for (const Move& m : entered->path.moves) helices += m.kind == MoveKind::counter_clockwise && m.end.z < before.z, before = m.end;
  EXPECT_GT(helices, 5u);
  expect_read(entered->path, gcode);
  WaterlineOptions around;
  around.tool.radius = 1.5, around.step_down = 0.4;
  for (const bool chords : {false, true}) {
    if (chords) around.accuracy.arc_error = 0.002, gcode.post = output::GcodePost::grbl;
    const auto waterlines = mill_waterline(std::make_shared<const Terrain>(*block), around);
    ASSERT_TRUE(waterlines) << waterlines.error().text();
    EXPECT_GT(waterlines->report.arcs, 10u);
    expect_read(waterlines->path, gcode);
  }
  for (const char* tool : {"flat:3", "bull:3:0.5", "cone:3:60", "taper:3:40:0.5"}) {
    const auto other = std::make_shared<const Terrain>(*block);
    ParallelOptions passes;
    passes.tool.cutter = *Cutter::parse(tool), passes.step_over = 1;
    WaterlineOptions levels;
    levels.tool = passes.tool, levels.step_down = 0.8;
    output::GcodeOptions tip;
    tip.tool_name = tool, tip.has_centre = false;
    const auto along = mill_parallel(other, passes), waterlines = mill_waterline(other, levels);
    ASSERT_TRUE(along && waterlines) << tool;
    expect_read(along->path, tip);
    expect_read(waterlines->path, tip);
  }
  // A valley of two slopes along a diagonal: no number of it is round.
  const auto valley = Terrain::from_grid({3, 3, {0, 0}, 5, 4, Terrain::Split::falling}, {5, 2.5, 0, 2.5, 0, 2.5, 0, 2.5, 5});
  ASSERT_TRUE(valley);
  PencilOptions along;
  along.tool.radius = 1.5;
  ScallopOptions over;
  over.tool.radius = 1.5, over.scallop = 0.2;
  for (const int decimals : {4, 3}) {
    gcode.decimals = decimals, gcode.post = decimals == 4 ? output::GcodePost::linuxcnc : output::GcodePost::grbl;
    along.accuracy.unit = over.accuracy.unit = std::pow(10.0, -decimals);
    along.accuracy.tolerance = over.accuracy.tolerance = 0.02;
    const auto pencil = mill_pencil(std::make_shared<const Terrain>(*valley), along);
    ASSERT_TRUE(pencil) << pencil.error().text();
    EXPECT_GT(pencil->report.lines, 0u);
    expect_read(pencil->path, gcode);
    const auto scallop = mill_scallop(std::make_shared<const Terrain>(*valley), over);
    ASSERT_TRUE(scallop) << scallop.error().text();
    EXPECT_GT(scallop->report.lines, 20u);
    expect_read(scallop->path, gcode);
  }
  EXPECT_GT(arcs_, 50u);
  EXPECT_GT(moves_, 1000u);
}

}  // namespace
}  // namespace krepl::test
