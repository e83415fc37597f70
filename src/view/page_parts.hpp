#pragma once

#include <bit>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "view/base64.hpp"

namespace krepl::view {

static_assert(std::endian::native == std::endian::little, "the page reads little-endian arrays");

std::string html_escaped(std::string_view text);

/// JSON as it can stand in a script element.
std::string json_in_html(const nlohmann::ordered_json& value);

/// Adds script elements with arrays in them.
class ArrayWriter {
 public:
  explicit ArrayWriter(std::string& html) : html_(html) {}

  /// Returns the element's id: a0, a1, ...
  template <class T>
  std::string add(const std::vector<T>& values) {
    const std::string id = "a" + std::to_string(count_++);
    add(id, values);
    return id;
  }
  template <class T>
  void add(const std::string& id, const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    html_ += "<script type=\"text/plain\" id=\"" + id + "\">";
    append_base64(html_, reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T));
    html_ += "</script>\n";
  }

 private:
  std::string& html_;
  int count_ = 0;
};

/// What stands for the marks {{title}}, {{style}}, {{data}} and {{script}} of a template.
struct PageFill {
  std::string_view title, style, data, script;
};
std::string filled(std::string_view page_template, const PageFill& fill);

}  // namespace krepl::view
