#pragma once

#include <cstddef>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/terrain.hpp"

namespace krepl::simulate {

/// Places in rows, relative to the terrain's origin.
struct Dexels {
  Point first;
  double cell;
  std::size_t columns, rows;
  Point place(std::size_t column, std::size_t row) const {
    return {first.x + double(column) * cell, first.y + double(row) * cell};
  }
};

/// Height of the terrain's upper side over each dexel, -infinity where it has none. Every triangle that is not vertical
/// is drawn; its border counts as inside. Linear time.
std::vector<double> part_heights(const Terrain& part, const Dexels& dexels, const Context& context);

}  // namespace krepl::simulate
