#include "input/text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace krepl::input {

namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string shown;
  for (const char c : text.substr(0, longest)) shown += c >= ' ' && c <= '~' ? c : '?';
  return "'" + shown + (text.size() > longest ? "...'" : "'");
}

std::string lower_case(std::string_view text) {
  std::string result;
  for (const char c : text) result += c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return result;
}

bool TextScanner::load_line() {
  if (position_ >= text_.size()) return false;
  if (line_ % 4096 == 0 && context_.cancelled()) {
    cancelled_ = true;
    return false;
  }
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  rest_ = text_.substr(position_, end - position_);
  position_ = end + 1;
  ++line_;
  if (signs_.comment != 0) rest_ = rest_.substr(0, rest_.find(signs_.comment));
  rest_ = trimmed(rest_);
  continues_ = signs_.continuation != 0 && !rest_.empty() && rest_.back() == signs_.continuation;
  if (continues_) rest_ = trimmed(rest_.substr(0, rest_.size() - 1));
  return true;
}

bool TextScanner::next() {
  while (continues_ && load_line()) {
  }
  do {
    if (!load_line()) {
      rest_ = {};
      return false;
    }
  } while (rest_.empty() && !continues_);
  return true;
}

std::string_view TextScanner::word() {
  while (rest_.empty()) {
    if (!continues_ || !load_line()) return {};
  }
  const auto end = std::find_if(rest_.begin(), rest_.end(), blank);
  const std::string_view found = rest_.substr(0, std::size_t(end - rest_.begin()));
  rest_ = trimmed(rest_.substr(found.size()));
  return found;
}

std::string_view TextScanner::flowing_word() {
  for (;;) {
    if (const std::string_view found = word(); !found.empty()) return found;
    if (!next()) return {};
  }
}

Result<double> TextScanner::number(std::string_view word, const char* what) const {
  if (word.empty()) return error(std::string(what) + " is missing");
  std::string_view digits = word;
  if (digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || status == std::errc::invalid_argument) {
    return error(std::string(what) + " " + quoted(word) + " is not a number");
  }
  if (status == std::errc::result_out_of_range)
    return error(std::string(what) + " " + quoted(word) + " is out of the range of numbers");
  if (!std::isfinite(value)) return error(std::string(what) + " is not finite");
  return value;
}

Result<std::int64_t> TextScanner::integer(std::string_view word, const char* what) const {
  if (word.empty()) return error(std::string(what) + " is missing");
  std::string_view digits = word;
  if (digits.front() == '+') digits.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || status != std::errc{}) {
    return error(std::string(what) + " " + quoted(word) + " is not a whole number");
  }
  return value;
}

Result<Point3> TextScanner::point() {
  Point3 p;
  const std::pair<const char*, double*> coordinates[] = {{"x", &p.x}, {"y", &p.y}, {"z", &p.z}};
  for (const auto& [name, coordinate] : coordinates) {
    const Result<double> value = number(word(), name);
    if (!value) return value.error();
    *coordinate = *value;
  }
  return p;
}

Error TextScanner::error(const std::string& what, const std::string& remedy) const {
  return {ErrorCode::input, what, "line " + std::to_string(line_), remedy};
}

Error TextScanner::end_error(const std::string& what) const {
  if (cancelled_) return {ErrorCode::cancelled, "interrupted while reading", "", ""};
  return {ErrorCode::input, what, "line " + std::to_string(line_), "the file seems to be cut off: get it again"};
}

}  // namespace krepl::input
