#pragma once

#include <optional>
#include <string>

#include "support/small_terrain.hpp"

namespace krepl::test {

/// How much is looked at.
struct SurfaceEffort {
  int points = 5;       ///< along each edge
  int lines = 5;        ///< across the whole surface, each with a label and a height between every two curves
  unsigned seed = 1;    ///< of the lines' places
  double seconds = 10;  ///< of processor time that computing may take
};

/// Computes the surface of a small case and says what is wrong with it, by brute force:
///  - it is computed at all, within a time and a number of edges that a few triangles justify, and validate() and so Euler's
///    formula hold;
///  - along each edge and at its ends the ball touches both features (at a seam at one place, at a rim with its equator)
///    and cuts into nothing;
///  - edges end in their vertices;
///  - across each of some lines, curves come in an order that fits their faces, and between them the face's feature is the
///    highest.
/// Nothing if it is right.
std::optional<std::string> fault_in(const SmallTerrain& c, const SurfaceEffort& effort = {});

/// The same for a surface that is there.
std::optional<std::string> fault_in(const Surface& surface, const SmallTerrain& c, const SurfaceEffort& effort = {});

/// The smallest case found, by leaving out and lowering, that still is wrong; the case itself if it is only late.
SmallTerrain minimised(SmallTerrain c, const SurfaceEffort& effort = {});

/// The surface on one thread, cancelled after some seconds of processor time.
Result<Surface> surface_within(const SmallTerrain& c, double seconds);

/// What is wrong with the incremental engine's surface of the case, by brute force, or how it differs from the other
/// engine's (surface_comparison.hpp), which is sound.
std::optional<std::string> fault_between_engines(const Surface& surface, const SmallTerrain& c);

}  // namespace krepl::test
