#include "view/surface/surface_page.hpp"

#include <fmt/format.h>

#include <array>

#include "view/assets.hpp"
#include "view/page_parts.hpp"
#include "view/surface/height_pyramid.hpp"
#include "view/surface/tile_encoding.hpp"
#include "view/surface/tile_tree.hpp"

namespace krepl::view {

namespace {

using Json = nlohmann::ordered_json;

/// Twelve numbers a tile; the order is that of page/layer.js.
std::vector<double> tile_table(const TileTree& tree) {
  std::vector<double> table;
  for (const TileTree::Tile& t : tree.tiles())
    table.insert(table.end(),
                 {double(t.depth), double(t.column), double(t.row), double(t.first_child), double(t.children),
                  double(t.last - t.first), t.low.x, t.low.y, t.low.z, t.high.x, t.high.y, t.high.z});
  return table;
}

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

class LayerWriter {
 public:
  LayerWriter(ArrayWriter& arrays, const Context& context) : arrays_(arrays), context_(context) {}

  Result<Json> write(const Shape& shape, const std::string& role);
  std::size_t tiles() const { return tiles_; }

 private:
  ArrayWriter& arrays_;
  const Context& context_;
  std::size_t tiles_ = 0;
};

Result<Json> LayerWriter::write(const Shape& shape, const std::string& role) {
  const TileTree tree(shape);
  const HeightPyramid pyramid(shape, tree.low(), tree.side(), std::max(1, tree.sampled_levels()));
  Json layer;
  layer["role"] = role;
  layer["low"] = {tree.low().x, tree.low().y};
  layer["side"] = tree.side();
  layer["sampledLevels"] = tree.sampled_levels();
  layer["triangles"] = shape.triangles.size();
  layer["tiles"] = arrays_.add(tile_table(tree));
  for (std::size_t i = 0; i < tree.tiles().size(); ++i) {
    if (context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    if (context_.progress) context_.progress(double(i) / double(tree.tiles().size()));
    const TileTree::Tile& tile = tree.tiles()[i];
    const std::string id = fmt::format("{}-{}", role, i);
    if (tile.children == 0)
      arrays_.add(id, encode_leaf(shape, tree, tile));
    else if (tile.depth < pyramid.levels())
      arrays_.add(id, encode_samples(pyramid, tile));
  }
  tiles_ += tree.tiles().size();
  return layer;
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
