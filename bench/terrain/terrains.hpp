#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "krepl/terrain.hpp"

namespace bench {

/// Heights on a grid, row by row from least y; NaN where there are none.
struct Samples {
  krepl::Terrain::Grid grid;
  std::vector<double> heights;
  double cell() const;
  double at(std::size_t column, std::size_t row) const { return heights[row * grid.columns + column]; }
};

/// An ESRI ASCII grid (cell centres or corners alike, the place does not matter), with cells of the given size, or of
/// the file's if that is 0. Empty if it cannot be read.
Samples read_samples(const std::string& path, double cell);

/// A square piece of a fractal surface (midpoint displacement, seed 1) with cells of 1 and slopes like those of
/// mountains, of about the given number of triangles: smaller ones are corners of larger ones. At most 2 million.
Samples made(std::size_t triangles);

/// Null if there is no terrain.
std::shared_ptr<const krepl::Terrain> as_grid(const Samples& samples);
/// The same triangles one by one; samples must be complete.
std::shared_ptr<const krepl::Terrain> as_mesh(const Samples& samples);

}  // namespace bench
