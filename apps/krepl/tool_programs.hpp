#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"
#include "input/gcode_reader.hpp"
#include "krepl/cutter.hpp"
#include "krepl/error.hpp"
#include "krepl/simulation.hpp"

namespace krepl::app {

class Session;

/// Programs of G-code and the block that they cut, as given.
struct ProgramOptions {
  std::vector<std::string> before;
  std::string path, tool, stock, cell, unit, control_point;
};

/// The same, understood.
struct ProgramSetup {
  Cutter cutter;
  StockOptions stock;  ///< cell is 0 if it was not given
  double millimetres = 1;
  bool centre = false;  ///< the control point
};

/// A program with its tool.
struct Program {
  std::string name;
  Cutter cutter;
  input::GCodeFile file;  ///< its control point as ToolPath has it
};

/// --before, --stock, --cell, --unit, --control-point; `cell_default` is what the help says of a cell that is not given.
void add_program_options(Verb& verb, ProgramOptions& options, const std::string& cell_default);

/// What --control-point says: the centre, else the tip. An error (usage) if it is neither.
Result<bool> steers_centre(const std::string& control_point);

/// Errors (usage): what is wrong with which option.
Result<ProgramSetup> program_setup(const ProgramOptions& options);

/// Those of --before in their order, then PATH. Errors name the file.
Result<std::vector<Program>> read_programs(const ProgramOptions& options, const ProgramSetup& setup, Session& session);

/// By the extension: .ngc, .nc, .gcode, .tap.
bool is_tool_path(const std::string& path);

}  // namespace krepl::app
