#pragma once

#include <map>
#include <optional>
#include <vector>

#include "solid/borders.hpp"
#include "solid/brep_builder.hpp"

namespace krepl::solid {

/// The corners and vertical edges over each vertex of the plane where walls meet. Walls that bound the same piece of
/// the solid share vertical edges: where only a line joins two pieces, each has its own, so that no edge has more than
/// two faces.
class Columns {
 public:
  using Index = Surface::Index;

  /// Adds the corners of `borders` to the builder with their own numbers, and below the outline those of the floor, if
  /// any.
  Columns(const Surface& surface, const Topology& topology, const Borders& borders, std::optional<double> floor,
          BrepBuilder& builder);

  /// The edges of the wall of half-edge h at h's origin, from above; they run upwards.
  const std::vector<int>& edges(Index h) const { return edges_.at(h); }
  /// The floor's corner below the origin of h.
  int floor_corner(Index h) const { return floor_.at(h); }

 private:
  struct Crossing {
    std::size_t place;  // in the column's half-edges, counter-clockwise
    bool rising;
  };
  struct Column {
    std::vector<Index> around;
    std::vector<int> corners;  // from above
  };
  bool has_wall(Index h) const;
  int corner_or_floor(Index corner, Index h) const;
  void make(Index h);
  std::vector<std::vector<Crossing>> crossings(const Column& column) const;
  bool encloses(const Column& column, Crossing from, Crossing to) const;

  const Surface& surface_;
  const Topology& topology_;
  const Borders& borders_;
  std::optional<double> floor_height_;
  BrepBuilder& builder_;
  std::map<Index, std::vector<int>> edges_;
  std::map<Index, int> floor_;
};

}  // namespace krepl::solid
