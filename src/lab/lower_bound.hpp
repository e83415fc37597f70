#pragma once

#include <cstddef>

#include "lab/construction.hpp"

namespace krepl::lab {

/// The lower bound of section 4.3: `grooves` parallel grooves and `needles` needles, of which every pair has vertices
/// of its own on d(T (+) B).
///
/// The grooves run along x, close together, so that the ball rests on their ridges: the boundary over them is strips of
/// cylinders, a valley between any two. The needles stand in a row, 1.75 R apart, in a trough in the middle, and rise
/// 0.4 R above the ridges: over each the boundary is a sphere, up to 0.8 R from it, which cuts through all of the
/// strips. Each valley, that over the trough included, ends at the sphere from both sides, so the pairs alone give 2
/// needles (grooves + 1) vertices. Walls at the ends hide the ends of the ridges, of which there are grooves + 2.
///
/// One connected polyhedral terrain over a rectangle. R = 1. Preconditions: grooves even and 2 or more, needles 1 or
/// more. It has 6 needles + 8 grooves + 26 triangles.
Construction lower_bound(std::size_t grooves, std::size_t needles);

/// Vertices of its boundary, by the argument above: 2 (grooves + 1) (needles + 1) + 40. The valleys end at the walls
/// too, and 40 is what the outer border and the walls have.
std::size_t lower_bound_vertices(std::size_t grooves, std::size_t needles);

/// The same with islands in place of a connected terrain, one triangle each: `blades` long flat ones for ridges,
/// `needles` standing ones. Their projections are disjoint, so it is a terrain whose domain has many parts. It has the
/// most vertices for its triangles that we know: the pairs alone give 2 needles (blades - 1).
/// Preconditions: blades even and 2 or more, needles 1 or more.
Construction lower_bound_islands(std::size_t blades, std::size_t needles);

}  // namespace krepl::lab
