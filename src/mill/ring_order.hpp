#pragma once

#include <cstddef>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::mill {

/// The order in which rings that do not cross are cut: each before those inside of it, else as they are. Quadratic in
/// the number of rings whose bounding boxes contain each other.
std::vector<std::size_t> order_rings(const std::vector<std::vector<Point>>& rings);

}  // namespace krepl::mill
