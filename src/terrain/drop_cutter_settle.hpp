#pragma once

#include "krepl/drop_cutter.hpp"
#include "model/terrain_access.hpp"
#include "terrain/drop_cutter_search.hpp"

namespace krepl::drop {

/// From the highest feature to the contact: computes the touched point, and goes down to the edge or vertex of the feature
/// that the point lies on.
class Settle {
 public:
  Settle(const Terrain& terrain, double extent) : terrain_(terrain), t_(terrain), extent_(extent) {}

  Terrain::FeatureKind kind(Index feature) const { return terrain_.feature_kind(feature); }
  DropCutter::Contact contact(const Search& search) const;

 private:
  struct Sides {
    std::array<Index, 3> vertex, edge;  // features; edge i runs between vertex i and vertex (i + 1) % 3
  };
  Sides sides_of_face(Index face) const;
  std::array<Index, 2> ends_of_edge(Index edge) const;
  void settle_face(const Search& search, double tolerance, DropCutter::Contact& contact) const;
  void settle_edge(const Search& search, double tolerance, DropCutter::Contact& contact) const;

  const Terrain& terrain_;
  TerrainAccess t_;
  double extent_;
};

}  // namespace krepl::drop
