#pragma once

#include <utility>
#include <vector>

namespace krepl::terrain {

/// What is left of a convex polygon where a linear function of its two coordinates is not above zero. Place: two coordinates.
template <class Place, class Function>
void clip_polygon(std::vector<Place>& polygon, const Function& function) {
  if (polygon.empty()) return;
  std::vector<Place> left;
  Place from = polygon.back();
  auto before = function(from);
  for (const Place& to : polygon) {
    const auto here = function(to);
    if ((before > 0) != (here > 0)) {
      const auto share = before / (before - here);
      const auto& [x0, y0] = from;
      const auto& [x1, y1] = to;
      left.push_back({x0 + share * (x1 - x0), y0 + share * (y1 - y0)});
    }
    if (!(here > 0)) left.push_back(to);
    from = to, before = here;
  }
  polygon = std::move(left);
}

}  // namespace krepl::terrain
