#include "view/surface/surface_page.hpp"

#include "view/assets.hpp"
#include "view/page_parts.hpp"
#include "view/surface/layer_writer.hpp"

namespace krepl::view {

namespace {

using Json = nlohmann::ordered_json;

template <class Items, class Kind>
Json counts_by_kind(const Items& items, std::initializer_list<std::pair<const char*, Kind>> names) {
  Json counts = Json::object();
  for (const auto& [name, kind] : names) {
    std::size_t count = 0;
    for (const auto& item : items) count += item.kind == kind ? 1 : 0;
    counts[name] = count;
  }
  return counts;
}

}  // namespace

Result<SurfacePage> render_surface_page(const SurfacePageData& data, const Context& context) {
  if (*surface_script == '\0')
    return Error{ErrorCode::usage, "this krepl was built without the page for surfaces", "",
                 "install nodejs and npm, and build again with -DKREPL_SURFACE_PAGE=ON"};
  using Face = Shape::FaceKind;
  using Line = Shape::LineKind;
  SurfacePage page;
  std::string block;
  ArrayWriter arrays(block);
  LayerWriter layers(arrays, context);
  const Shape& surface = data.surface;
  Json json;
  json["title"] = data.title;
  json["crs"] = data.crs;
  json["unit"] = data.unit;
  json["radius"] = surface.radius;
  json["maxError"] = data.max_error;
  json["origin"] = {surface.origin.x, surface.origin.y, surface.origin.z};
  json["features"] = surface.features.size();
  json["faces"] = counts_by_kind<std::vector<Shape::Face>, Face>(
      surface.faces, {{"plane", Face::plane}, {"cylinder", Face::cylinder}, {"sphere", Face::sphere}});
  json["edges"] = counts_by_kind<std::vector<Shape::Line>, Line>(
      surface.lines, {{"seam", Line::seam}, {"valley", Line::valley}, {"rim", Line::rim}});
  json["layers"] = Json::array();
  Result<Json> layer = layers.write(surface, "surface");
  if (!layer) return layer.error();
  json["layers"].push_back(std::move(*layer));
  if (data.terrain) {
    layer = layers.write(*data.terrain, "terrain");
    if (!layer) return layer.error();
    json["layers"].push_back(std::move(*layer));
  }
  page.tiles = layers.tiles();
  block += "<script type=\"application/json\" id=\"page\">" + json_in_html(json) + "</script>";
  const std::string title = html_escaped(data.title);
  page.html = filled(surface_template, {title, surface_style, block, surface_script});
  return page;
}

}  // namespace krepl::view
