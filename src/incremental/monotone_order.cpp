#include "incremental/monotone_order.hpp"

#include <algorithm>

namespace krepl::incremental {

namespace {

/// Where the line at x meets the triangle.
std::pair<Real, Real> section(const TrianglePart& t, Real x) {
  Real low = std::numeric_limits<Real>::infinity(), high = -low;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector a = t.corner[k], b = t.corner[(k + 1) % 3];
    if (std::fmin(a.x, b.x) > x || std::fmax(a.x, b.x) < x) continue;
    if (a.x == b.x) {
      low = std::min({low, a.y, b.y}), high = std::max({high, a.y, b.y});
      continue;
    }
    const Real y = a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y);
    low = std::min(low, y), high = std::max(high, y);
  }
  return {low, high};
}

/// -1 if s is straight below t in the plane somewhere, 1 if above, 0 if neither.
int compare(const TrianglePart& s, const TrianglePart& t) {
  const Real low = std::max(s.box.low_x, t.box.low_x), high = std::min(s.box.high_x, t.box.high_x);
  if (!(low < high)) return 0;
  const auto [s_low, s_high] = section(s, (low + high) / 2);
  const auto [t_low, t_high] = section(t, (low + high) / 2);
  const Real slack = 1e-15L * (std::fabs(s_low) + std::fabs(s_high) + std::fabs(t_low) + std::fabs(t_high));
  if (s_high <= t_low + slack) return -1;
  return t_high <= s_low + slack ? 1 : 0;
}

}  // namespace

std::vector<Index> monotone_order(const Parts& parts) {
  const auto& triangles = parts.triangles();
  const auto count = Index(triangles.size());
  std::vector<std::vector<Index>> after(count);
  std::vector<Index> waiting(count, 0);
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < i; ++j) {
      const int order = compare(triangles[i], triangles[j]);
      if (order == 0) continue;
      const Index first = order < 0 ? i : j, second = order < 0 ? j : i;
      after[first].push_back(second);
      ++waiting[second];
    }
  }
  const auto middle = [&](Index t) {
    return triangles[t].corner[0].y + triangles[t].corner[1].y + triangles[t].corner[2].y;
  };
  std::vector<Index> order;
  std::vector<bool> done(count, false);
  while (order.size() < count) {
    Index best = none;
    for (Index t = 0; t < count; ++t) {
      if (done[t]) continue;
      const auto key = [&](Index i) { return std::pair<bool, Real>(waiting[i] > 0, middle(i)); };
      if (best == none || key(t) < key(best)) best = t;
    }
    done[best] = true;
    order.push_back(best);
    for (const Index t : after[best]) --waiting[t];
  }
  return order;
}

}  // namespace krepl::incremental
