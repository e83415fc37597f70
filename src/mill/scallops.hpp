#pragma once

#include <cstdint>
#include <vector>

#include "mill/drive_curve.hpp"
#include "mill/pass_layout.hpp"

namespace krepl::mill {

struct ScallopOptions {
  double radius = 0;  ///< of the cutter
  double height = 0;  ///< greatest height of what may be left
  double every = 0;   ///< distance of the cross-sections that are looked at
  int levels = 4;     ///< how often a gap between passes may be halved
};

/// Passes between two neighbouring ones, each over a part of their length, in their order across.
struct ExtraPasses {
  std::vector<PassLayout::Pass> passes;
  std::size_t sections = 0;   ///< cross-sections looked at
  std::size_t remaining = 0;  ///< of them, where more is left than wanted, since gaps are not halved any more
};

/// Finds where two neighbouring passes leave more than wanted between them, and puts passes there.
///
/// In a cross-section the cutter's surface between the passes is known as a polyline. With the ball's centre at a place
/// c of it, the ball touches the part at c - R n. A ball at the place a of a pass covers the normal through this point
/// down to a height of R + d.n - sqrt(R^2 - (d - (d.n) n)^2) with d = a - c, which for d.n = 0 is the ridge between two
/// balls on a plane: slope across the passes makes d longer, hollows make d.n positive.
ExtraPasses find_extra_passes(DriveCurve& curve, const PassLayout& layout, const PassLayout::Pass& a,
                              const PassLayout::Pass& b, const ScallopOptions& options);

}  // namespace krepl::mill
