#include "view/render_page.hpp"

#include "view/assets.hpp"
#include "view/page_parts.hpp"

namespace krepl::view {

namespace {

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
  const std::string title = html_escaped(data.title);
  return filled(page_template, {title, page_style, block, page_script});
}

}  // namespace krepl::view
