#pragma once

#include <optional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/zone.hpp"
#include "zone/gaps.hpp"

namespace krepl::zone {

/// Closed rings of pieces, one after the other: ring r is pieces begin[r] .. begin[r+1). Piece e runs on element[e] from
/// vertex[e] to the vertex of the next piece of its ring.
struct Rings {
  std::vector<Index> begin{0};
  std::vector<Index> element;
  std::vector<Point> vertex;

  Index ring_count() const { return Index(begin.size() - 1); }
  Index next(Index ring, Index piece) const { return piece + 1 < begin[ring + 1] ? piece + 1 : begin[ring]; }
};

/// Links pieces (sorted by element) by their labels and lays them out ring by ring, every ring from its lowest piece.
/// A label without its counterpart is an ErrorCode::computation that names the place. O(pieces).
Result<Rings> link_pieces(const Instance& instance, const std::vector<Piece>& pieces, const Context& context);

/// Contracts pieces shorter than `resolution` or that stray from the element on both sides of them by less, and drops rings
/// that are thinner; counts both. O(pieces).
Rings contract(const Instance& instance, Rings rings, double resolution, const Context& context, ZoneCounters& counters);

/// Twice the signed area that piece e of the ring contributes relative to `base` (Green's theorem, arcs included).
double twice_area(const Instance& instance, Index element, Point start, Point end, Point base);

}  // namespace krepl::zone
