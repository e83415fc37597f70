#include "view/surface/layer_writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "view/surface/height_pyramid.hpp"
#include "view/surface/tile_encoding.hpp"
#include "view/surface/tile_tree.hpp"

namespace krepl::view {

namespace {

/// Twelve numbers a tile; the order is that of page/layer.js.
std::vector<double> tile_table(const TileTree& tree) {
  std::vector<double> table;
  for (const TileTree::Tile& t : tree.tiles())
    table.insert(table.end(),
                 {double(t.depth), double(t.column), double(t.row), double(t.first_child), double(t.children),
                  double(t.last - t.first), t.low.x, t.low.y, t.low.z, t.high.x, t.high.y, t.high.z});
  return table;
}

}  // namespace

Result<nlohmann::ordered_json> LayerWriter::write(const Shape& shape, const std::string& role) {
  const TileTree tree(shape);
  const HeightPyramid pyramid(shape, tree.low(), tree.side(), std::max(1, tree.sampled_levels()));
  nlohmann::ordered_json layer;
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

}  // namespace krepl::view
