#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// Words and numbers of a text line by line, for the text formats of meshes. Errors name the line.
class TextScanner {
 public:
  /// How lines are told apart; 0 means that the format has no such sign.
  struct Signs {
    char comment = 0;       ///< starts a comment that reaches to the end of its line
    char continuation = 0;  ///< at the end of a line: the next one belongs to it
  };
  TextScanner(std::string_view text, Signs signs, const Context& context)
      : text_(text), signs_(signs), context_(context) {
    if (text_.starts_with("\xEF\xBB\xBF")) position_ = 3;  // byte order mark
  }

  /// Moves to the next line that has a word; false at the end and when cancelled.
  bool next();
  /// The next word of the line, empty at its end.
  std::string_view word();
  /// The next word of this line or of those that follow; empty at the end of the text.
  std::string_view flowing_word();

  /// The value of a word; `what` names it in errors. Not finite or no number: an error.
  Result<double> number(std::string_view word, const char* what) const;
  Result<std::int64_t> integer(std::string_view word, const char* what) const;
  /// The next three words of the line.
  Result<Point3> point();

  Error error(const std::string& what, const std::string& remedy = "correct the file") const;
  /// The text has ended too early, or reading was cancelled.
  Error end_error(const std::string& what) const;

  std::size_t line() const { return line_; }
  std::size_t position() const { return position_; }
  bool cancelled() const { return cancelled_; }

 private:
  bool load_line();

  std::string_view text_, rest_;
  Signs signs_;
  const Context& context_;
  std::size_t position_ = 0, line_ = 0;
  bool continues_ = false, cancelled_ = false;
};

/// In quotes, cut to a length that fits a message, without control characters.
std::string quoted(std::string_view text);

/// ASCII letters in lower case.
std::string lower_case(std::string_view text);

}  // namespace krepl::input
