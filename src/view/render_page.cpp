#include "view/render_page.hpp"

#include <fmt/format.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <string_view>
#include <type_traits>

#include "view/assets.hpp"
#include "view/base64.hpp"

namespace krepl::view {

namespace {

static_assert(std::endian::native == std::endian::little, "the page reads little-endian arrays");

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

/// Adds script elements with arrays in them and hands out their ids.
class ArrayWriter {
 public:
  explicit ArrayWriter(std::string& html) : html_(html) {}

  template <class T>
  std::string add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::string id = fmt::format("a{}", count_++);
    html_ += "<script type=\"text/plain\" id=\"" + id + "\">";
    append_base64(html_, reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T));
    html_ += "</script>\n";
    return id;
  }

 private:
  std::string& html_;
  int count_ = 0;
};

nlohmann::ordered_json layer_json(const Layer& layer, ArrayWriter& arrays) {
  nlohmann::ordered_json json;
  json["role"] = layer.role;
  json["name"] = layer.name;
  json["radius"] = layer.radius ? nlohmann::ordered_json(*layer.radius) : nlohmann::ordered_json(nullptr);
  json["polygons"] = layer.polygons;
  json["area"] = layer.area;
  json["perimeter"] = layer.perimeter;
  json["vertices"] = arrays.add(layer.vertices);
  json["vertexBegin"] = arrays.add(layer.vertex_begin);
  json["chainKind"] = arrays.add(layer.chain_kind);
  json["kind"] = arrays.add(layer.kind);
  json["centers"] = arrays.add(layer.centers);
  json["sourcePart"] = arrays.add(layer.source_part);
  json["sourceVertex"] = arrays.add(layer.source_vertex);
  std::vector<double> parts;  // doubles: feature numbers may exceed 32 bits
  for (const Layer::Part& part : layer.parts) {
    parts.push_back(static_cast<double>(part.feature));
    parts.push_back(static_cast<double>(part.part));
  }
  json["parts"] = arrays.add(parts);
  return json;
}

void append_filled(std::string& page, std::string_view text, const std::string& title, const std::string& data) {
  while (!text.empty()) {
    const std::size_t mark = text.find("{{");
    page += text.substr(0, mark);
    if (mark == std::string_view::npos) return;
    const std::size_t end = text.find("}}", mark);
    const std::string_view name = text.substr(mark + 2, end - mark - 2);
    if (name == "title")
      page += title;
    else if (name == "style")
      page += page_style;
    else if (name == "script")
      page += page_script;
    else if (name == "data")
      page += data;
    text.remove_prefix(end + 2);
  }
}

}  // namespace

std::string render_page(const PageData& data) {
  std::string block;
  ArrayWriter arrays(block);
  nlohmann::ordered_json json;
  json["title"] = data.title;
  json["crs"] = data.crs;
  json["unit"] = data.unit;
  json["layers"] = nlohmann::ordered_json::array();
  for (const Layer& layer : data.layers) json["layers"].push_back(layer_json(layer, arrays));
  block += "<script type=\"application/json\" id=\"page\">" + json_in_html(json) + "</script>";
  std::string page;
  page.reserve(block.size() + 200000);
  append_filled(page, page_template, html_escaped(data.title), block);
  return page;
}

}  // namespace krepl::view
