#include "mill/part_domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl::mill {

/// The plan of the sum is the triangle's plan (+) disk: the line runs in and out over the disk about a corner or the
/// strip beside an edge.
Interval domain_of(const drop::Part& part, double radius, const Line& line) {
  const double reach = radius * radius;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Interval all{infinity, -infinity};
  const auto add = [&](double low, double high) {
    if (low > high) return;
    all.low = std::min(all.low, low), all.high = std::max(all.high, high);
  };
  double along[3], aside[3];
  for (unsigned i = 0; i < 3; ++i) {
    const double x = part.corner[i].x - line.origin.x, y = part.corner[i].y - line.origin.y;
    along[i] = x * line.direction.x + y * line.direction.y;
    aside[i] = y * line.direction.x - x * line.direction.y;
    const double under = reach - aside[i] * aside[i];
    if (under < 0) continue;
    const double half = std::sqrt(under);
    add(along[i] - half, along[i] + half);
  }
  for (unsigned i = 0; i < 3; ++i) {
    const unsigned j = i == 2 ? 0 : i + 1;
    // In coordinates along and across the line: places (t, 0) with a foot on the edge, within R of it.
    const double u = along[j] - along[i], v = aside[j] - aside[i], squared = u * u + v * v;
    if (squared == 0) continue;
    const double length = std::sqrt(squared);
    // foot * length = ((t - along) u - aside v) in [0, squared]; distance = |(t - along) v + aside u| / length <= R.
    double low = -infinity, high = infinity;
    const auto clip = [&](double factor, double least, double most) {  // least <= (t - along) factor <= most
      if (factor == 0) {
        if (least > 0 || most < 0) low = infinity;
        return;
      }
      const double p = along[i] + least / factor, q = along[i] + most / factor;
      low = std::max(low, std::min(p, q)), high = std::min(high, std::max(p, q));
    };
    clip(u, aside[i] * v, aside[i] * v + squared);
    clip(v, -radius * length - aside[i] * u, radius * length - aside[i] * u);
    add(low, high);
  }
  return all;
}

}  // namespace krepl::mill
