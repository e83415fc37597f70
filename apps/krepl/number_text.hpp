#pragma once

#include <charconv>
#include <string>

namespace krepl::app {

/// Appends the fewest digits that give the same double back; never -0.
inline void append_number(std::string& text, double x) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, x == 0 ? 0.0 : x).ptr);
}

}  // namespace krepl::app
