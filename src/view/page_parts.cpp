#include "view/page_parts.hpp"

namespace krepl::view {

std::string html_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

/// "</script>" in a string would end the element that holds the JSON; "<" stands in strings only.
std::string json_in_html(const nlohmann::ordered_json& value) {
  const std::string plain = value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string escaped;
  for (const char c : plain) {
    if (c == '<')
      escaped += "\\u003c";
    else
      escaped += c;
  }
  return escaped;
}

std::string filled(std::string_view text, const PageFill& fill) {
  std::string page;
  page.reserve(text.size() + fill.style.size() + fill.data.size() + fill.script.size() + 10 * fill.title.size());
  while (!text.empty()) {
    const std::size_t mark = text.find("{{");
    page += text.substr(0, mark);
    if (mark == std::string_view::npos) break;
    const std::size_t end = text.find("}}", mark);
    const std::string_view name = text.substr(mark + 2, end - mark - 2);
    if (name == "title")
      page += fill.title;
    else if (name == "style")
      page += fill.style;
    else if (name == "script")
      page += fill.script;
    else if (name == "data")
      page += fill.data;
    text.remove_prefix(end + 2);
  }
  return page;
}

}  // namespace krepl::view
