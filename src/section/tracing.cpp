#include "section/tracing.hpp"

#include <algorithm>

namespace krepl::section {

/// Along its border, with the face on the left, the cut enters a face where that falls and leaves it where it rises.
Index Tracing::face(Index c, bool left_of_edge) const {
  const Crossing& crossing = crossings[c];
  if (crossing.side == (left_of_edge ? Crossing::Side::right : Crossing::Side::left)) return none;
  return parts_.topology().face[2 * crossing.edge + (left_of_edge ? 0 : 1)];
}

bool Tracing::pair(const PlaceOf& place) {
  visits_.clear();
  exit_.assign(crossings.size(), none);
  const auto add = [&](Index f, Index crossing, bool enters) {
    if (f == none || parts_.surface->face_feature(f) == none) return;
    visits_.push_back({f, crossing, enters, {}});
  };
  for (Index c = 0; c < crossings.size(); ++c) {
    add(entered(c), c, true);
    add(left(c), c, false);
  }
  std::stable_sort(visits_.begin(), visits_.end(), [](const Visit& a, const Visit& b) { return a.face < b.face; });
  for (auto first = visits_.begin(); first != visits_.end();) {
    const auto last = std::find_if(first, visits_.end(), [&](const Visit& v) { return v.face != first->face; });
    const Patch patch = parts_.patch(first->face);
    for (auto v = first; v != last; ++v) v->place = place(patch, crossings[v->crossing]);
    std::stable_sort(first, last, [](const Visit& a, const Visit& b) { return a.place < b.place; });
    if (!match(first, last)) return false;
    first = last;
  }
  return true;
}

/// Each exit belongs to the last entrance before it that has none yet, all around: they alternate but for rounding, and
/// where they do not, this still is a pairing without crossings.
bool Tracing::match(std::vector<Visit>::iterator first, std::vector<Visit>::iterator last) {
  std::vector<Index> open;
  std::vector<bool> closed(std::size_t(last - first));
  std::size_t pairs = 0;
  for (int round = 0; round < 2; ++round) {
    for (auto v = first; v != last; ++v) {
      if (v->enters) {
        if (round == 0) open.push_back(v->crossing);
      } else if (!closed[std::size_t(v - first)] && !open.empty()) {
        exit_[open.back()] = v->crossing;
        open.pop_back();
        closed[std::size_t(v - first)] = true;
        ++pairs;
      }
    }
  }
  return 2 * pairs == std::size_t(last - first);
}

bool Tracing::meets(Index f) const {
  const auto at = std::lower_bound(visits_.begin(), visits_.end(), f, [](const Visit& v, Index face) { return v.face < face; });
  return at != visits_.end() && at->face == f;
}

}  // namespace krepl::section
