#pragma once

#include "krepl/section.hpp"

namespace krepl::section {

/// Signed area of a ring in the plane, positive if it runs counter-clockwise.
double ring_area(std::span<const CutPiece> ring);

/// Says of each ring whether it is a hole, and which one is directly around it.
void nest(Contour& contour);

}  // namespace krepl::section
