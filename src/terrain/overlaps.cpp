#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "terrain/patches.hpp"

// Edges in one line that have a part in common: where triangles cross, or do not meet edge to edge.
namespace krepl::terrain {

/// Of such edges with the same place along their line for both, each continues the other: what the one that counts as seen has at
/// its end is a seam. Found among those whose lines are the same but for rounding: sorted, O(n log n).
template <class Real>
void PatchSet<Real>::find_overlaps() {
  if (window_->vertices().empty()) return;
  const Point3 origin = window_->vertices()[0].at;
  double extent = 0;
  for (const auto& v : window_->vertices()) {
    extent = std::max({extent, std::fabs(v.at.x - origin.x), std::fabs(v.at.y - origin.y), std::fabs(v.at.z - origin.z)});
  }
  struct Piece {
    std::array<std::int64_t, 6> line;  // direction, and the place next to the origin
    double low, high;
    Index edge;
    bool forward;
  };
  std::vector<Piece> pieces;
  for (Index i = 0; i < edges_.size(); ++i) {
    const EdgeFrame& e = edges_[i];
    if (e.patch == none) continue;
    std::array<double, 3> d{double(e.gx / e.q), double(e.gy / e.q), double(e.m / e.q)};
    const Point3 a = window_->vertices()[window_->edges()[i].a].at;
    const std::array<double, 3> at{a.x - origin.x, a.y - origin.y, a.z - origin.z};
    const bool forward = std::fabs(d[0]) > 0.5 * std::fabs(d[1]) ? d[0] > 0 : d[1] > 0;
    if (!forward) d = {-d[0], -d[1], -d[2]};
    const double along = at[0] * d[0] + at[1] * d[1] + at[2] * d[2], length = double(e.length * e.q);
    Piece piece{{}, forward ? along : along - length, forward ? along + length : along, i, forward};
    for (std::size_t k = 0; k < 3; ++k) {
      piece.line[k] = std::llround(d[k] * 0x1p40);
      piece.line[k + 3] = std::llround((at[k] - along * d[k]) / extent * 0x1p40);
    }
    pieces.push_back(piece);
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& p, const Piece& q) {
    return std::tie(p.line, p.low, p.edge) < std::tie(q.line, q.low, q.edge);
  });
  const double least = 0x1p-40 * extent;
  for (auto p = pieces.begin(); p != pieces.end(); ++p) {
    for (auto q = p + 1; q != pieces.end() && q->line == p->line && q->low < p->high - least; ++q) {
      if (!(q->low > p->low + least && q->high > p->high + least)) continue;
      const Index i = edges_[p->edge].patch, j = edges_[q->edge].patch;
      const bool first_shows = precedes(i, j);
      const Index shown = first_shows ? i : j, other = first_shows ? j : i;
      const bool at_end = first_shows == (first_shows ? p : q)->forward;  // the first one's higher end, or the second one's lower
      // Sides are in this order: left and right, start, end.
      Bound side = bounds(shown)[at_end ? 3 : 2];
      side.partner = other;
      overlaps_.push_back({shown, other, side});
      side.negative = !side.negative;
      side.partner = shown;
      overlaps_.push_back({other, shown, side});
      patches_[i].overlaps = patches_[j].overlaps = true;
    }
  }
}

template class PatchSet<double>;
template class PatchSet<DoubleDouble>;

}  // namespace krepl::terrain
