#pragma once

#include <string_view>
#include <vector>

#include "krepl/error.hpp"

namespace krepl::input {

/// A letter in capitals and its number.
struct GCodeWord {
  char letter;
  double value;
};

/// The words of one line, without comments and line numbers. `line` is its number, for errors.
Result<std::vector<GCodeWord>> gcode_words(std::string_view text, std::size_t line);

/// "line 12"
std::string gcode_place(std::size_t line);

/// "G90.1", "X-3"
std::string gcode_text(const GCodeWord& word);

}  // namespace krepl::input
