#include "terrain/cell_map.hpp"

#include <algorithm>

namespace krepl::terrain {

Index CellMap::add_line(bool vertical, double at, Index start_label, const std::vector<LineCrossing>& crossings) {
  const Index first = Index(crossings_.size());
  lines_.push_back({vertical, at, start_label, first, Index(crossings.size())});
  for (const LineCrossing& c : crossings) crossings_.push_back({c.t, c.after, c.meeting, {}});
  const Index pieces = piece_count();
  for (Index p = Index(region_.size()); p < pieces; ++p) region_.push_back(p);
  return Index(lines_.size() - 1);
}

void CellMap::add_vertex(Point3 at, std::span<const Link> arms) {
  const Index v = Index(vertices_.size());
  vertices_.push_back({at, Index(arms_.size()), Index(arms.size())});
  for (const Link& arm : arms) {
    link(arm.index(), arm.side(), Link::vertex(v));
    arms_.push_back(arm);
  }
}

Index CellMap::region(Index piece) {
  while (region_[piece] != piece) {
    region_[piece] = region_[region_[piece]];
    piece = region_[piece];
  }
  return piece;
}

void CellMap::unite(Index a, Index b) {
  a = region(a);
  b = region(b);
  if (a != b) region_[std::max(a, b)] = std::min(a, b);
}

}  // namespace krepl::terrain
