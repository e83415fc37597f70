#include "input/json_scanner.hpp"

#include <charconv>
#include <cstring>

namespace krepl::input {

namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 20;
constexpr std::size_t longest_token = 4096;  // a number may have many digits
constexpr int deepest = 64;

}  // namespace

JsonScanner::JsonScanner(std::FILE* file) : file_(file), buffer_(buffer_size) {}

void JsonScanner::fill() {
  if (end_ - at_ >= longest_token || file_ == nullptr) return;
  std::memmove(buffer_.data(), buffer_.data() + at_, end_ - at_);
  passed_ += at_, end_ -= at_, at_ = 0;
  const std::size_t got = std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_);
  end_ += got;
  if (got == 0) file_ = nullptr;
}

char JsonScanner::peek() {
  for (;;) {
    if (end_ - at_ < longest_token) fill();
    if (at_ == end_) return '\0';
    const char c = buffer_[at_];
    if (c != ' ' && c != '\n' && c != '\r' && c != '\t') return c;
    line_ += c == '\n';
    ++at_;
  }
}

bool JsonScanner::fail(std::string_view what) {
  if (failure_.empty()) failure_ = what;
  return false;
}

std::string JsonScanner::place() const {
  return "line " + std::to_string(line_) + ", byte " + std::to_string(passed_ + at_ + 1);
}

bool JsonScanner::next_is(char c) { return peek() == c; }

bool JsonScanner::expect(char c) {
  const char found = peek();
  if (found == c) return take();
  if (found == '\0' && at_ == end_) return fail("the file ends early");
  return fail(std::string("'") + c + "' expected");
}

bool JsonScanner::number(double& value) {
  const char first = peek();
  if (first != '-' && (first < '0' || first > '9')) return fail("a number expected");
  const auto [stop, status] = std::from_chars(buffer_.data() + at_, buffer_.data() + end_, value);
  if (status != std::errc{}) return fail("a number that no double holds");
  at_ = std::size_t(stop - buffer_.data());
  return true;
}

bool JsonScanner::index(std::uint32_t& value) {
  const char first = peek();
  if (first < '0' || first > '9') return fail("an index expected");
  const auto [stop, status] = std::from_chars(buffer_.data() + at_, buffer_.data() + end_, value);
  if (status != std::errc{}) return fail("an index that is too large");
  at_ = std::size_t(stop - buffer_.data());
  if (at_ < end_ && (buffer_[at_] == '.' || buffer_[at_] == 'e' || buffer_[at_] == 'E'))
    return fail("an index expected");
  return true;
}

bool JsonScanner::null() {
  if (peek() != 'n') return false;
  if (end_ - at_ < 4 || std::memcmp(buffer_.data() + at_, "null", 4) != 0) return false;
  at_ += 4;
  return true;
}

bool JsonScanner::string(std::string& value) {
  value.clear();
  if (!expect('"')) return false;
  for (;;) {
    if (end_ - at_ < longest_token) fill();
    if (at_ == end_) return fail("the file ends early");
    const char c = buffer_[at_++];
    if (c == '"') return true;
    // No name that counts has an escape: one that does is kept as it stands and matches nothing.
    value += c;
    if (c == '\\' && at_ < end_) value += buffer_[at_++];
  }
}

bool JsonScanner::skip_value() {
  std::string text;
  const char first = peek();
  if (first == '"') return string(text);
  if (first == '[' || first == '{') {
    if (++depth_ > deepest) return fail("nested too deeply");
    const bool taken =
        first == '[' ? array([&] { return skip_value(); }) : object([&](const std::string&) { return skip_value(); });
    --depth_;
    return taken;
  }
  for (const std::string_view word : {"null", "true", "false"}) {
    if (end_ - at_ < word.size() || std::memcmp(buffer_.data() + at_, word.data(), word.size()) != 0) continue;
    at_ += word.size();
    return true;
  }
  double value;
  return number(value);
}

bool JsonScanner::end() { return (peek() == '\0' && at_ == end_) || fail("more text after the end of the object"); }

}  // namespace krepl::input
