#pragma once

#include <cstddef>
#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::input {

/// GDAL reads an ASCII grid that ends within its last row as if zeros followed. Counts the numbers after the header:
/// fewer than `samples` are an Error.
Status check_ascii_grid(const std::string& vsi_path, std::size_t samples, const Context& context);

}  // namespace krepl::input
