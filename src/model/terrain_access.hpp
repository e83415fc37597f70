#pragma once

#include <cstddef>
#include <vector>

#include "krepl/terrain.hpp"

namespace krepl {

/// A terrain as it is stored, for algorithms to which a TerrainWindow costs too much: no copies, no checks.
class TerrainAccess {
 public:
  using Index = Terrain::Index;
  using Cell = Terrain::Cell;
  using Edge = Terrain::Edge;
  using Triangle = Terrain::Triangle;

  explicit TerrainAccess(const Terrain& terrain) : t_(terrain) {}

  // Grids. Features: 6 * sample + k, k as terrain_grid.cpp says.
  const std::vector<double>& heights() const { return t_.height_; }
  Cell cell(std::size_t column, std::size_t row) const { return t_.cell(column, row); }
  double grid_x(std::size_t column) const { return t_.grid_x(column); }
  double grid_y(std::size_t row) const { return t_.grid_y(row); }

  // Meshes. Features: vertices, then edges, then triangles.
  const std::vector<Point3>& vertices() const { return t_.vertex_; }
  const std::vector<Edge>& edges() const { return t_.edge_; }
  const std::vector<Triangle>& triangles() const { return t_.triangle_; }

 private:
  const Terrain& t_;
};

}  // namespace krepl
