#pragma once

#include <cstddef>
#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "view/page_parts.hpp"
#include "view/surface/shape.hpp"

namespace krepl::view {

/// Shapes as layers of a page in space: quadtrees of tiles, which page/layer.js reads.
class LayerWriter {
 public:
  LayerWriter(ArrayWriter& arrays, const Context& context) : arrays_(arrays), context_(context) {}

  /// Adds the tiles to the page and returns what describes them. Roles: "surface", or "terrain" for shapes whose vertices are to
  /// be kept as doubles. Errors: cancelled.
  Result<nlohmann::ordered_json> write(const Shape& shape, const std::string& role);
  /// Of all shapes written.
  std::size_t tiles() const { return tiles_; }

 private:
  ArrayWriter& arrays_;
  const Context& context_;
  std::size_t tiles_ = 0;
};

}  // namespace krepl::view
