#include "support/wkt_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "support/environment.hpp"

namespace krepl::test {

namespace {

class WktReader {
 public:
  WktReader(const std::string& text, std::int64_t& feature, std::vector<InputPart>& parts)
      : text_(text), feature_(feature), parts_(parts) {}

  void geometry() {
    const std::string kind = word();
    if (kind == "POINT")
      one_of([&] { in_brackets([&] { parts_.push_back(line({position()})); }); });
    else if (kind == "LINESTRING")
      one_of([&] { parts_.push_back(line(chain())); });
    else if (kind == "POLYGON")
      one_of([&] { polygon(); });
    else if (kind == "MULTIPOINT")
      many([&] {
        peek() == '(' ? in_brackets([&] { parts_.push_back(line({position()})); })
                      : parts_.push_back(line({position()}));
      });
    else if (kind == "MULTILINESTRING")
      many([&] { parts_.push_back(line(chain())); });
    else if (kind == "MULTIPOLYGON")
      many([&] { polygon(); });
    else if (kind == "GEOMETRYCOLLECTION")
      many([&] { geometry(); });
    else
      fail("unknown geometry '" + kind + "'");
  }
  bool at_end() { return skip(), at_ == text_.size(); }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(what + " at character " + std::to_string(at_));
  }

 private:
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  char peek() { return skip(), at_ < text_.size() ? text_[at_] : '\0'; }
  void expect(char c) {
    if (peek() != c) fail(std::string("expected ") + c);
    ++at_;
  }
  std::string word() {
    skip();
    std::string w;
    while (at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_])))
      w += char(std::toupper(text_[at_++]));
    return w;
  }
  bool empty() {
    if (!std::isalpha(static_cast<unsigned char>(peek()))) return false;
    if (word() != "EMPTY") fail("expected ( or EMPTY");
    return true;
  }
  double number() {
    skip();
    char* end = nullptr;
    const double value = std::strtod(text_.c_str() + at_, &end);
    if (end == text_.c_str() + at_) fail("expected a number");
    at_ = std::size_t(end - text_.c_str());
    return value;
  }
  Point position() {
    const double x = number();
    return {x, number()};
  }
  template <class F>
  void in_brackets(F&& f) {
    expect('('), f(), expect(')');
  }
  template <class F>
  void one_of(F&& f) {
    if (!empty()) f();
  }
  template <class F>
  void many(F&& f) {
    if (empty()) return;
    expect('('), f();
    while (peek() == ',') ++at_, f();
    expect(')');
  }
  std::vector<Point> chain() {
    std::vector<Point> v;
    many([&] { v.push_back(position()); });
    return v;
  }
  void polygon() {
    many([&] { parts_.push_back(ring(chain(), feature_)); });
    ++feature_;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::int64_t& feature_;
  std::vector<InputPart>& parts_;
};

}  // namespace

std::vector<InputPart> parse_wkt(const std::string& text, std::int64_t& feature) {
  std::vector<InputPart> parts;
  WktReader reader(text, feature, parts);
  reader.geometry();
  if (!reader.at_end()) reader.fail("text after the geometry");
  return parts;
}

std::string read_text(const std::filesystem::path& path) {
  const bool packed = path.extension() == ".gz";
  std::FILE* file = packed ? popen(("gzip -dc '" + path.string() + "'").c_str(), "r") : std::fopen(path.c_str(), "rb");
  if (file == nullptr) throw std::runtime_error("cannot open " + path.string());
  std::string text;
  char block[1 << 16];
  for (std::size_t n; (n = std::fread(block, 1, sizeof block, file)) > 0;) text.append(block, n);
  if ((packed ? pclose(file) : std::fclose(file)) != 0) throw std::runtime_error("cannot read " + path.string());
  return text;
}

std::vector<InputPart> read_wkt_file(const std::filesystem::path& path) {
  std::istringstream lines(read_text(path));
  std::vector<InputPart> all;
  std::int64_t feature = 0;
  for (std::string text; std::getline(lines, text);) {
    if (text.find_first_not_of(" \t\r") == std::string::npos || text[0] == '#') continue;
    auto parts = parse_wkt(text, feature);
    std::move(parts.begin(), parts.end(), std::back_inserter(all));
  }
  return all;
}

std::vector<std::filesystem::path> real_wkt_files() {
  std::vector<std::filesystem::path> found;
  const auto data = data_directory();
  if (!data || !std::filesystem::is_directory(*data / "vector")) return found;
  for (const auto& entry : std::filesystem::directory_iterator(*data / "vector"))
    if (entry.path().string().find(".wkt") != std::string::npos) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace krepl::test
