#include "mill/pass_limits.hpp"

#include <algorithm>
#include <cmath>

#include "mill/steepness.hpp"

namespace krepl::mill {
namespace {

/// The parts of a range where the surface is not steep, or not farther than the overlap from there.
std::vector<PassRange> shallow_parts(const PassRange& range, Steepness& steepness, const Line& line, double step,
                                     const PassLimits& limits) {
  const auto every = std::max<std::int64_t>(1, std::int64_t(limits.overlap / 4 / step));
  const auto overlap = std::max(2 * every, std::int64_t(std::ceil(limits.overlap / step)));
  // Across as well: the pass next to the last one on shallow ground is needed as the end of that one is.
  const auto is_shallow = [&](Point p) {
    for (const double aside : {0.0, -0.5, 0.5, -1.0, 1.0}) {
      const double off = aside * limits.overlap;
      if (steepness.at({p.x - off * line.direction.y, p.y + off * line.direction.x}) < limits.shallow) return true;
    }
    return false;
  };
  std::vector<PassRange> parts;
  for (std::int64_t i = range.first;; i = std::min(i + every, range.last)) {
    if (is_shallow(line.at(double(i) * step))) {
      const PassRange part{std::max(range.first, i - overlap), std::min(range.last, i + overlap)};
      if (!parts.empty() && part.first <= parts.back().last)
        parts.back().last = part.last;
      else
        parts.push_back(part);
    }
    if (i == range.last) break;
  }
  return parts;
}

}  // namespace

std::vector<PassRange> limit_pass(const LiftedCutter& cutter, const PassLayout& layout, const PassLayout::Pass& pass,
                                  const PassLimits& limits) {
  const Line line = layout.line(pass);
  std::vector<PassRange> within;
  if (limits.boundary.is_everywhere()) {
    within.push_back({pass.first, pass.last});
  } else {
    for (const Interval& i :
         limits.boundary.inside(line, double(pass.first) * layout.step, double(pass.last) * layout.step))
      within.push_back({std::int64_t(std::ceil(i.low / layout.step)), std::int64_t(std::floor(i.high / layout.step))});
  }
  std::vector<PassRange> ranges;
  Steepness steepness(cutter.drop);
  for (const PassRange& w : within) {
    if (w.first >= w.last) continue;
    if (limits.shallow <= 0) {
      ranges.push_back(w);
      continue;
    }
    for (const PassRange& r : shallow_parts(w, steepness, line, layout.step, limits))
      if (r.first < r.last) ranges.push_back(r);
  }
  return ranges;
}

}  // namespace krepl::mill
