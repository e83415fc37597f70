// G-code as moves: what each word means, and what is refused, with its line.
#include "input/gcode_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace krepl::test {

namespace {

using input::GCodeFile;
using input::parse_gcode;

GCodeFile read(std::string_view text, double millimetres = 1) {
  Result<GCodeFile> file = parse_gcode(text, millimetres);
  EXPECT_TRUE(file.ok()) << file.error().text();
  return file.ok() ? *file : GCodeFile{};
}

TEST(GCode, LinesRapidsAndModalWords) {
  const GCodeFile f = read(
      "%\nO0012\n(a comment) N10 G21 G90 g17 ; another\nT1 M6 S12000 M3\nG0 Z5\nG0 X1 Y2\n"
      "g1 z-1.5 f300\nX4\n\n  y 3 . 5\nG91 X1 Y-1\nG90G0Z+5\nM5\nM30\nG1 X99\n");
  EXPECT_EQ(f.path.start, (Point3{1, 2, 5}));
  ASSERT_EQ(f.path.moves.size(), 5u);
  EXPECT_EQ(f.path.moves[0].end, (Point3{1, 2, -1.5}));
  EXPECT_EQ(f.path.moves[0].kind, MoveKind::line);
  EXPECT_EQ(f.path.moves[0].feed, 300);
  EXPECT_EQ(f.path.moves[1].end, (Point3{4, 2, -1.5}));
  EXPECT_EQ(f.path.moves[2].end, (Point3{4, 3.5, -1.5}));
  EXPECT_EQ(f.path.moves[3].end, (Point3{5, 2.5, -1.5}));
  EXPECT_EQ(f.path.moves[4].kind, MoveKind::rapid);
  EXPECT_EQ(f.path.moves[4].end, (Point3{5, 2.5, 5}));
  EXPECT_EQ(f.line, (std::vector<std::size_t>{7, 8, 10, 11, 12}));
  EXPECT_TRUE(f.notes.empty());
}

TEST(GCode, ArcsByCentreAndRadius) {
  const GCodeFile f = read(
      "G0 X10 Y0 Z1\nG3 X0 Y10 I-10 J0 F100\nG2 X10 Y0 R10\nG3 X0 Y10 R-10\nG90.1 G2 X10 Y0 Z0 I0 J0\n"
      "G91.1 G2 I-10\nG18 G3 X12 Z2 K2\nG19 G2 Y2 Z4 J2 K0\n");
  const auto& m = f.path.moves;
  ASSERT_EQ(m.size(), 7u);
  EXPECT_EQ(m[0].centre.x, 0);
  EXPECT_EQ(m[0].kind, MoveKind::counter_clockwise);
  EXPECT_NEAR(m[1].centre.x, 0, 1e-12);  // the shorter way back about the same centre
  EXPECT_NEAR(m[1].centre.y, 0, 1e-12);
  EXPECT_NEAR(m[2].centre.x, 10, 1e-12);  // the longer way
  EXPECT_NEAR(m[2].centre.y, 10, 1e-12);
  EXPECT_EQ(m[3].centre.x, 0);
  EXPECT_EQ(m[3].end.z, 0);
  EXPECT_EQ(m[4].end, m[3].end);  // a full circle
  EXPECT_EQ(m[5].plane, ArcPlane::zx);
  EXPECT_EQ(m[5].centre.z, 2);
  EXPECT_EQ(m[5].centre.x, 10);
  EXPECT_EQ(m[6].plane, ArcPlane::yz);
  EXPECT_EQ(m[6].centre.y, 2);
}

TEST(GCode, InchesBecomeTheUnitOfThePart) {
  const GCodeFile f = read("G20 G0 X1 Y2 Z1\nG1 Z0 F10\nG3 X0 Y3 I-1 J0\nG21 G1 X25.4\n");
  EXPECT_EQ(f.path.start, (Point3{25.4, 50.8, 25.4}));
  EXPECT_EQ(f.path.moves[0].feed, 254);
  EXPECT_NEAR(f.path.moves[1].centre.x, 0, 1e-12);
  EXPECT_EQ(f.path.moves[2].end.x, 25.4);
  EXPECT_NEAR(read("G20 G0 X1 Y2 Z1\nG1 X2 F10\n", 25.4).path.moves[0].end.x, 2, 1e-15);
}

TEST(GCode, WhatIsRefusedNamesItsLine) {
  const char* const start = "G0 X0 Y0 Z0\nF100\n";
  for (const auto& [text, what] : {std::pair{"G1 A5", "A5 is not read"},
                                   {"G81 Z-3 R1", "G81 is not read"},
                                   {"G41 D1", "G41 is not read"},
                                   {"G92 X0", "G92 is not read"},
                                   {"G55", "G55 is not read"},
                                   {"G93", "G93 is not read"},
                                   {"G1.04 X1", "G1.04 is not read"},
                                   {"M98 P1", "M98 is not read"},
                                   {"G1 X#1", "X is followed by no number"},
                                   {"#1=3", "expressions"},
                                   {"G1 X[1+2]", "X is followed by no number"},
                                   {"o100 sub", "subprograms"},
                                   {"G1 X1 X2", "X is there twice"},
                                   {"G1 X1 (open", "comment"},
                                   {"G1 X1.2.3", "expressions"},
                                   {"G1 X", "X is followed by no number"},
                                   {"G1 X1 F0", "without a feed"},
                                   {"G2 X5 Y5", "without its centre"},
                                   {"G2 X5 Y5 I1 J0", "whose ends are"},
                                   {"G2 X5 Y0 R1", "too short"},
                                   {"G2 X0 Y0 R1", "ends where it begins"},
                                   {"G2 X5 Y0 R3 I2", "both"},
                                   {"G2 X5 Y0 I2.5 K1", "outside of the arc's plane"},
                                   {"G2 X5 Y0 I2.5 P2", "several turns"},
                                   {"G1 X1 I2", "straight move"},
                                   {"G80 X3", "without G0"}}) {
    const Result<GCodeFile> file = parse_gcode(std::string(start) + text + "\nG1 X1\n");
    ASSERT_FALSE(file.ok()) << text;
    EXPECT_NE(file.error().what.find(what), std::string::npos) << text << ": " << file.error().text();
    EXPECT_EQ(file.error().where, "line 3") << text;
  }
  EXPECT_FALSE(parse_gcode("").ok());
  EXPECT_FALSE(parse_gcode("G21\n").ok());
  EXPECT_FALSE(parse_gcode("G1 X1 Y1 Z1 F1\n").ok());   // from where?
  EXPECT_FALSE(parse_gcode("G91 G0 X1 Y1 Z1\n").ok());  // from where?
  EXPECT_FALSE(parse_gcode("T1\nG0 X0 Y0 Z0\nG1 X1 F1\nT2 M6\nG1 X2\n").ok());
}

TEST(GCode, LongArcsMayBeOffByWhatMachinesAllow) {
  EXPECT_TRUE(parse_gcode("G0 X100 Y0 Z0\nG3 X0 Y100.05 I-100 J0 F9\n").ok());
  EXPECT_FALSE(parse_gcode("G0 X100 Y0 Z0\nG3 X0 Y100.5 I-100 J0 F9\n").ok());
  EXPECT_TRUE(parse_gcode("G0 X1 Y0 Z0\nG3 X0 Y1.004 I-1 J0 F9\n").ok());
}

}  // namespace

}  // namespace krepl::test
