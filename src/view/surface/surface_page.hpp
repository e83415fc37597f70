#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "view/surface/shape.hpp"

namespace krepl::view {

struct SurfacePageData {
  std::string title;
  std::string crs;   ///< name of the coordinate system; empty if unknown
  std::string unit;  ///< of length, short; empty if unknown
  double max_error = 0;
  Shape surface;
  std::optional<Shape> terrain;  ///< with the surface's origin
};

struct SurfacePage {
  std::string html;
  std::size_t tiles = 0;
};

/// One HTML page that shows a surface, and the terrain below it if given. The same data give the same bytes.
/// Errors: cancelled; a program that was built without the page's script says so.
Result<SurfacePage> render_surface_page(const SurfacePageData& data, const Context& context = {});

}  // namespace krepl::view
