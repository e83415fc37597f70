#pragma once

#include <cstdint>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"

namespace krepl {

/// A parallel curve, or a connected part of one: segments and circular arcs, each starting where the one before ends.
/// All its points are at the given distance from the line or polygon that it belongs to, and none is nearer to it.
struct OffsetCurve {
  struct Piece {
    bool arc;
    bool clockwise;  ///< arcs only: the sense from start to end about center
    Point start, end;
    Point center;  ///< arcs only
  };
  std::vector<Piece> pieces;
  bool closed;  ///< ends where it starts
  double length;
  std::int64_t feature;  ///< of the line or polygon, as the Network has it
  std::uint32_t part;    ///< of the line, or of the polygon's first ring
};

/// The parallel curves of each line and each polygon of a network, at a signed distance in the unit of the coordinates.
///
/// Lines: to their left where `distance` > 0, to their right where it is < 0; the curve runs with the line. Convex
/// corners are rounded by true arcs, what would come nearer to any place of the same line is cut away (so a curve may
/// fall apart, or vanish), there are no caps. Where a line is run through both ways, both of its sides are left and
/// right. Each line is taken by itself, whatever crosses it.
///
/// Polygons (rings of one feature, even-odd): outwards where `distance` > 0, inwards where it is < 0. All curves are
/// closed and run with the grown or shrunken polygon on their left. Inward ones split and vanish where the polygon is
/// too narrow.
///
/// Points have none. In the order of the input; curves of one line in the order of its zone's boundary. Accuracy and
/// cost are those of compute_zone at |distance|, line by line. Errors: distance zero or not finite; what compute_zone
/// reports, with the feature.
Result<std::vector<OffsetCurve>> offset_curves(const Network& network, double distance, const Context& context = {});

}  // namespace krepl
