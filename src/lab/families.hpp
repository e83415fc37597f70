#pragma once

#include <span>

#include "lab/construction.hpp"
#include "lab/random.hpp"

namespace krepl::lab {

/// A kind of random terrains. `make` gets as near to `triangles` as the kind allows, never above; the radius is drawn
/// too.
struct Family {
  const char* name;
  const char* what;
  std::size_t least_triangles;
  /// False if projections of its triangles overlap: no terrain, so conjecture 4.5.6 says nothing about it.
  bool terrain;
  Construction (*make)(Random& random, std::size_t triangles);
};

/// All of them. Precondition of make: triangles >= least_triangles.
std::span<const Family> families();

}  // namespace krepl::lab
