#pragma once

#include <random>

#include "drop_case.hpp"

namespace krepl::test {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high);
/// 10^uniform
double exponential(Random& random, double low, double high);

/// A case from a grid; missing samples are NaN.
DropCase grid_case(std::string name, const Terrain::Grid& grid, std::vector<double> heights);
/// A case from triangles.
DropCase mesh_case(std::string name, std::vector<Point3> vertices, std::vector<std::array<Terrain::Index, 3>> triangles);
/// The same terrain as a mesh.
DropCase as_mesh(const DropCase& grid);

/// Random terrains of one kind.
struct DropFamily {
  const char* name;
  DropCase (*make)(Random&);
};
const std::vector<DropFamily>& drop_families();

/// A radius from 0.01 to 100 cells, now and then a whole number of them.
double any_radius(Random& random, const DropCase& c);
/// A place in or about the terrain, now and then over a vertex, an edge, or at distance R from one.
Point any_place(Random& random, const DropCase& c, double radius);

}  // namespace krepl::test
