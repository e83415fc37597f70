#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "krepl/context.hpp"

namespace krepl::model {

/// A point of an integer grid, |x| and |y| at most 2^53, so that double precision holds it exactly.
struct GridPoint {
  std::int64_t x = 0, y = 0;
  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};

/// A segment between two vertices, which may not be the same one. Its sense is kept.
struct GridSegment {
  std::uint32_t a = 0, b = 0;
  friend bool operator==(const GridSegment&, const GridSegment&) = default;
};

/// Segments that meet at vertices only.
struct Noding {
  struct Fragment {
    std::uint32_t from, to;  ///< vertices; never the same one
    std::uint32_t segment;   ///< the segment that it is a part of, and with whose sense it runs
  };
  std::vector<GridPoint> vertices;  ///< the given ones, then the new ones by their coordinates
  std::vector<Fragment> fragments;  ///< segment by segment, each from its start to its end; equal ones are not merged
  std::size_t touches = 0;          ///< how often a segment was cut at a given vertex that is not one of its ends
};

/// Cuts segments where they cross, touch and overlap, by snap rounding [hobby1999]: every vertex and every crossing
/// makes the grid's pixel around it hot, and every segment that passes a hot pixel is led through its centre.
///
/// All decisions are exact and each crossing is rounded once, so the fragments meet at common vertices only, or
/// coincide. A fragment is within half a pixel's diagonal of its segment; given vertices do not move. Preconditions:
/// distinct vertices; segments with two different ends. Expected O((n + k) log n) for k crossings, quadratic where
/// boxes of segments overlap massively. Nothing if cancelled.
std::optional<Noding> node_segments(std::vector<GridPoint> vertices, std::span<const GridSegment> segments,
                                    const Context& context);

/// True if the segment from a to b passes the pixel about c: the square of side 1 with its lower and its left side.
bool passes_pixel(GridPoint a, GridPoint b, GridPoint c);

/// The grid point whose pixel holds the crossing of a b and c d. Precondition: they cross inside of both.
GridPoint rounded_crossing(GridPoint a, GridPoint b, GridPoint c, GridPoint d);

}  // namespace krepl::model
