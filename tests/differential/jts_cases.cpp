#include "jts_cases.hpp"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "support/wkt_file.hpp"

namespace krepl::test {
namespace {

struct Element {
  std::string attributes, content;
};

/// The first element of that name at or after `at`, which moves behind it; elements of one name do not nest in these
/// files.
bool next_element(const std::string& text, const std::string& name, std::size_t& at, Element& element) {
  for (std::size_t begin = text.find("<" + name, at); begin != std::string::npos;
       begin = text.find("<" + name, begin + 1)) {
    const std::size_t after = begin + 1 + name.size();
    if (text.find_first_of(" \t\r\n>", after) != after) continue;  // a longer name
    const std::size_t open = text.find('>', after), close = text.find("</" + name + ">", after);
    if (open == std::string::npos || close == std::string::npos || close < open)
      throw std::runtime_error("<" + name + "> does not end");
    element = {text.substr(after, open - after), text.substr(open + 1, close - open - 1)};
    at = close;
    return true;
  }
  return false;
}

std::string attribute(const std::string& attributes, const std::string& name) {
  const std::size_t at = attributes.find(name + "=");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + name.size() + 2;
  return attributes.substr(begin, attributes.find(attributes[begin - 1], begin) - begin);
}

/// Words with one blank between them.
std::string one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!blank) line += c;
    if (blank && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

std::string inner_text(const std::string& text, const std::string& name) {
  std::size_t at = 0;
  Element element;
  return next_element(text, name, at, element) ? one_line(element.content) : "";
}

}  // namespace

std::string JtsCase::name() const {
  char text[32];
  std::snprintf(text, sizeof text, " %d, %g", number, distance);
  return file + text;
}

std::vector<JtsCase> read_jts_cases(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  std::vector<JtsCase> all;
  std::size_t at = 0;
  Element part, op;
  for (int number = 1; next_element(text, "case", at, part); ++number) {
    JtsCase base;
    base.file = path.stem().string();
    base.number = number;
    base.description = inner_text(part.content, "desc");
    base.input = inner_text(part.content, "a");
    std::size_t inside = 0;
    while (next_element(part.content, "op", inside, op)) {
      JtsCase c = base;
      c.operation = attribute(op.attributes, "name");
      c.distance = std::strtod(attribute(op.attributes, "arg2").c_str(), nullptr);
      c.expected = one_line(op.content);
      all.push_back(std::move(c));
    }
  }
  return all;
}

}  // namespace krepl::test
