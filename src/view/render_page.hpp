#pragma once

#include <string>

#include "view/page_data.hpp"

namespace krepl::view {

/// One HTML page that shows the data in a browser and needs nothing else: style, script and data are in it. The arrays
/// are little-endian in base64, coordinates as doubles. The same data give the same bytes.
std::string render_page(const PageData& data);

}  // namespace krepl::view
