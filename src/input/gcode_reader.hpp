#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/tool_path.hpp"

namespace krepl::input {

/// A program for a milling machine of three axes, as moves of the point that it steers.
struct GCodeFile {
  ToolPath path;  ///< in the unit of the part; from the first place of which all three coordinates are known
  std::vector<std::size_t> line;   ///< of each move in the file, from 1
  std::vector<std::string> notes;  ///< what was read and left aside
};

/// Reads the language that LinuxCNC, GRBL and most CAM programs share: G0 G1 G2 G3 with X Y Z, I J K or R, and F;
/// planes G17 G18 G19; units G20 G21; distances G90 G91, of arc centres G90.1 G91.1; comments in parentheses and after
/// a semicolon; line numbers; words in any order, spaces anywhere, capital letters or not. Modal words count until they
/// are changed. At the start: G17 G21 G90 G91.1 G94.
///
/// Words that move nothing are read over (spindle, coolant, tool table, work offset 1, path blending, dwell). All else,
/// which might move the tool elsewhere, is an Error that names line and word: other axes, canned cycles, tool
/// compensation, offsets, scaling, variables and expressions, subprograms, a second tool.
///
/// Further errors: a number that is none; a move before all coordinates are known, without a feed, or without a motion
/// word; an arc without a centre, of radius zero, or whose ends differ in their distance from it by more than 0.005 mm
/// and 0.1 % (LinuxCNC allows about as much); a radius too short for its ends; no move at all; cancelled.
///
/// `millimetres` is what the part's unit is in millimetres: 1 by default; the file's own unit (G20, G21) is converted.
Result<GCodeFile> read_gcode(const std::string& path, double millimetres = 1, const Context& context = {});
Result<GCodeFile> parse_gcode(std::string_view text, double millimetres = 1, const Context& context = {});

}  // namespace krepl::input
