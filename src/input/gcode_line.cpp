#include "input/gcode_line.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <string>

#include "input/text_scanner.hpp"

namespace krepl::input {
namespace {

/// The line without comments, spaces and small letters.
Result<std::string> bare(std::string_view text, std::size_t line) {
  std::string result;
  bool comment = false;
  for (const char c : text) {
    if (comment) {
      comment = c != ')';
    } else if (c == '(') {
      comment = true;
    } else if (c == ';') {
      break;
    } else if (!std::isspace(static_cast<unsigned char>(c))) {
      result += char(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  if (comment) return Error{ErrorCode::input, "a comment is not closed", gcode_place(line), "add a parenthesis"};
  return result;
}

}  // namespace

std::string gcode_place(std::size_t line) { return "line " + std::to_string(line); }

std::string gcode_text(const GCodeWord& word) { return fmt::format("{}{}", word.letter, word.value); }

Result<std::vector<GCodeWord>> gcode_words(std::string_view text, std::size_t line) {
  const Result<std::string> bared = bare(text, line);
  if (!bared) return bared.error();
  std::string_view rest = *bared;
  std::vector<GCodeWord> words;
  if (rest == "%") return words;
  if (rest.starts_with('/')) rest.remove_prefix(1);  // a line that a switch of the machine would leave out
  while (!rest.empty()) {
    const char letter = rest[0];
    if (letter < 'A' || letter > 'Z') {
      return Error{ErrorCode::input, "expressions and variables are not read: " + quoted(rest), gcode_place(line),
                   "have the program written out in plain numbers"};
    }
    rest.remove_prefix(1);
    if (rest.starts_with('+')) rest.remove_prefix(1);
    double value = 0;
    // Plain digits only: a following E is a letter of its own.
    const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), value, std::chars_format::fixed);
    if (status != std::errc{} || !std::isfinite(value)) {
      return Error{ErrorCode::input, fmt::format("{} is followed by no number: {}", letter, quoted(rest)),
                   gcode_place(line), "correct the file; variables and expressions are not read"};
    }
    rest.remove_prefix(std::size_t(end - rest.data()));
    if (letter == 'O' && !rest.empty()) {  // alone it is the program's number
      return Error{ErrorCode::input, "subprograms are not read: O" + quoted(rest), gcode_place(line),
                   "have the program written out"};
    }
    if (letter != 'N' && letter != 'O') words.push_back({letter, value});
  }
  return words;
}

}  // namespace krepl::input
