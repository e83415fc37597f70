#include "section/tracing.hpp"

#include <algorithm>
#include <numbers>

namespace krepl::section {

namespace {

constexpr double turn = 2 * std::numbers::pi;

}  // namespace

/// Along its border, with the face on the left, the cut enters a face where that falls and leaves it where it rises.
Index Tracing::face(Index c, bool left_of_edge) const {
  const Crossing& crossing = crossings[c];
  if (crossing.side == (left_of_edge ? Crossing::Side::right : Crossing::Side::left)) return none;
  return parts_.topology().face[2 * crossing.edge + (left_of_edge ? 0 : 1)];
}

bool Tracing::pair(const PlaceOf& place, const HoldsAt& holds) {
  visits_.clear();
  exit_.assign(crossings.size(), none);
  sweep_.assign(crossings.size(), 0);
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
    if (!match({first, last}, patch, holds)) return false;
    first = last;
  }
  return true;
}

bool Tracing::match(Visits visits, const Patch& patch, const HoldsAt& holds) {
  if (holds && patch.is_sphere()) {
    // Begin in the widest gap, where rounding does not matter.
    double widest = visits.front().place.along + turn - visits.back().place.along;
    std::size_t begin = 0;
    for (std::size_t i = 1; i < visits.size(); ++i) {
      const double gap = visits[i].place.along - visits[i - 1].place.along;
      if (gap > widest) widest = gap, begin = i;
    }
    bool is_clear = true;
    for (std::size_t i = 0; i < visits.size(); ++i) {
      const Visit &a = visits[i], &b = visits[(i + 1) % visits.size()];
      is_clear &= a.enters != b.enters && (i + 1 == visits.size() || b.place.along - a.place.along > 0x1p-30);
    }
    if (is_clear) return match_run(visits, !visits.front().enters);
    int votes = 0;  // one place may lie on the border of the face, where that touches the circle
    for (const double part : {0.31, 0.52, 0.73})
      votes += holds(visits.front().face, patch, visits[begin].place.along - part * widest) ? 1 : -1;
    const bool inside = votes > 0;
    for (std::size_t i = 0; i < begin; ++i) visits[i].place.along += turn;
    std::rotate(visits.begin(), visits.begin() + std::ptrdiff_t(begin), visits.end());
    return match_run(visits, inside);
  }
  const auto second = std::find_if(visits.begin(), visits.end(),
                                   [&](const Visit& v) { return v.place.run > visits.front().place.run; });
  const Visits run(visits.begin(), second), rest(second, visits.end());
  const auto entries = std::count_if(run.begin(), run.end(), [](const Visit& v) { return v.enters; });
  // Only rounding puts one end on the other side of a cylinder's top.
  if (2 * std::size_t(entries) != run.size()) return match_run(visits, false);
  return match_run(run, false) && (rest.empty() || match_run(rest, false));
}

/// Entrances and exits alternate. Where rounding has them in another order, as at vertices on the level, the next one
/// of the kind that is due goes first.
bool Tracing::match_run(Visits run, bool starts_inside) {
  bool inside = starts_inside;
  for (std::size_t i = 0; i < run.size(); ++i, inside = !inside) {
    const auto due =
        std::find_if(run.begin() + std::ptrdiff_t(i), run.end(), [&](const Visit& v) { return v.enters != inside; });
    if (due == run.end()) return false;
    std::rotate(run.begin() + std::ptrdiff_t(i), due, due + 1);
  }
  if (inside != starts_inside) return false;
  for (std::size_t i = starts_inside ? 1 : 0; i < run.size(); i += 2) {
    const Visit &entry = run[i], &exit = run[(i + 1) % run.size()];
    exit_[entry.crossing] = exit.crossing;
    sweep_[entry.crossing] = exit.place.along - entry.place.along + (i + 1 == run.size() ? turn : 0);
  }
  return true;
}

bool Tracing::meets(Index f) const {
  const auto at =
      std::lower_bound(visits_.begin(), visits_.end(), f, [](const Visit& v, Index face) { return v.face < face; });
  return at != visits_.end() && at->face == f;
}

}  // namespace krepl::section
