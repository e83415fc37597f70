#pragma once

#include <cstddef>
#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/tool_path.hpp"

namespace krepl::output {

/// Which controller a program is for. GRBL changes no tools and knows no tool lengths; its program ends without M6 and
/// G43.
enum class GcodePost { linuxcnc, grbl };

struct GcodeOptions {
  GcodePost post = GcodePost::linuxcnc;
  bool inches = false;  ///< G20 instead of G21; coordinates are not converted
  int decimals = 4;     ///< of coordinates
  double below_centre =
      0;  ///< how far the written Z is below the path's control point: a ball's radius if it is that of the tip
  double spindle_speed = 0;  ///< revolutions a minute; 0: the program does not start the spindle
  int tool_number = 1;
  double tool_diameter = 0;
  std::string tool_name;            ///< for the comment, as "ball-nose"
  bool has_centre = true;           ///< for the comment: what Z means if it is that of the control point
  std::string part_name, strategy;  ///< for the comment
};

/// Words of at most this many decimals are exact in what a controller reads.
inline constexpr int most_decimals = 7;

/// A tool path as a program of G-code: absolute coordinates, exact path mode (G61), lines G1, arcs G2 and G3 with
/// centres by I, J and K, one move a block; words that do not change are left out. Coordinates are rounded to the
/// nearest last decimal, which moves nothing if they are multiples of it. Returns the number of lines written. Errors:
/// the file cannot be written; cancelled.
Result<std::size_t> write_gcode(const std::string& path, const ToolPath& tool_path, const GcodeOptions& options,
                                const Context& context = {});

}  // namespace krepl::output
