#pragma once

#include <vector>

#include "arcs/bodies.hpp"
#include "krepl/context.hpp"
#include "krepl/zone.hpp"

namespace krepl::arcs {

/// Borders by number: eight to a body.
using BorderId = std::uint64_t;
inline BorderId border_id(Index body, int k) { return BorderId{body} << 3 | BorderId(k); }
inline Index body_of(BorderId id) { return Index(id >> 3); }
inline std::size_t place_of(BorderId id) { return std::size_t(id & 7); }

/// A stretch of a body's border that no other body covers, between the borders it comes from and goes on upon.
struct Uncovered {
  BorderId border, from, to;
  Vector<quad> start, end;
  double span;  // arcs: the diamond angle, 4 for a full turn
};

/// All of them, by border and parameter. Empty if cancelled. Bodies are independent of each other, so any number of
/// threads gives the same. Expected O(n log n) where few bodies meet in a place.
std::vector<Uncovered> uncovered_stretches(const Bodies& bodies, const Context& context, ZoneCounters& counters);

}  // namespace krepl::arcs
