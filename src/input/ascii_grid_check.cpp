#include "input/ascii_grid_check.hpp"

#include <cpl_vsi.h>

#include <memory>
#include <vector>

#include "input/text_scanner.hpp"
#include "ogr/message_capture.hpp"

namespace krepl::input {

namespace {

/// Counts the words after the header's lines, which begin with a name.
class WordCounter {
 public:
  void add(const char* text, std::size_t length) {
    for (std::size_t i = 0; i < length; ++i) {
      if (in_header_)
        read_header(text[i]);
      else
        read_body(text[i]);
    }
  }
  std::size_t count() const { return count_; }

 private:
  static bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  void read_header(char c) {
    if (!named_ && !blank(c))
      line_ += c;
    else if (!named_ && !line_.empty())
      end_word(c);
    if (c == '\n') named_ = false;
  }

  /// After the first word of a line: a name, or the first number.
  void end_word(char c) {
    const std::string word = lower_case(line_);
    const bool name = word[0] >= 'a' && word[0] <= 'z' && word.substr(0, 3) != "nan" && word.substr(0, 3) != "inf";
    named_ = name;
    line_.clear();
    if (name) return;
    in_header_ = false;
    count_ = 1;
    read_body(c);
  }

  void read_body(char c) {
    const bool word = !blank(c);
    count_ += word && !in_word_;
    in_word_ = word;
  }

  bool in_header_ = true, named_ = false, in_word_ = false;
  std::string line_;
  std::size_t count_ = 0;
};

}  // namespace

Status check_ascii_grid(const std::string& vsi_path, std::size_t samples, const Context& context) {
  ogr::MessageCapture messages;
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(VSIFOpenL(vsi_path.c_str(), "rb"), VSIFCloseL);
  if (!file) return messages.error(ErrorCode::io, "cannot be read");
  WordCounter words;
  std::vector<char> block(std::size_t{1} << 20);
  for (std::size_t got = block.size(); got == block.size();) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    got = VSIFReadL(block.data(), 1, block.size(), file.get());
    words.add(block.data(), got);
  }
  if (words.count() >= samples) return std::monostate{};
  return Error{ErrorCode::input,
               "ends after " + std::to_string(words.count()) + " of " + std::to_string(samples) + " samples", "",
               "the file seems to be cut off: get it again"};
}

}  // namespace krepl::input
