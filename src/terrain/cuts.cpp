#include <algorithm>

#include "terrain/cells.hpp"

// Where a cell that does not settle is cut in two.
namespace krepl::terrain {
namespace {

constexpr double near_middle = 0.48717, uneven = 0.4641;

}  // namespace

/// Between the corners of patches in the cell, which are vertices mostly, or else near the middle of the longer sides.
/// Exactly in the middle is often a line of symmetry, along which curves run.
template <class Real>
typename Cells<Real>::Cut Cells<Real>::cut(const Cell& cell, std::span<const Index> candidates) {
  const Box& box = cell.box;
  const bool far = envelope_.is_far();
  const Real width = box.high.x - box.low.x, height = box.high.y - box.low.y;
  // Cuts are doubles: between the sides there must be some.
  const Real largest = std::max({absolute(box.low.x), absolute(box.high.x), absolute(box.low.y), absolute(box.high.y)});
  const Real thinnest = std::max(envelope_.smallest_cell() / 64, 0x1p-50 * largest);
  if ((far || is_fine<Real>)&&std::min(width, height) > thinnest) {
    if (candidates.size() > most_settled) walk(cell);  // else its turns are known
    if (const std::optional<Cut> between = cut_between_strips(cell)) return *between;
    if (const std::optional<Cut> beside = far ? cut_beside_wall(box) : std::nullopt) return *beside;
  }
  const Gradient stretch =
      far ? steepness(box) : Gradient{1, 1};  // cells are square on the surface: it is steep near walls
  Cut best{height <= thinnest || (width > thinnest && width * stretch.x >= height * stretch.y), 0};
  best.at = double(best.vertical ? box.low.x + near_middle * width : box.low.y + near_middle * height);
  if (candidates.size() > most_settled || std::min(width, height) <= thinnest) return best;
  if (turns_.size() > 16 || !pair_turns()) star_.clear();
  for (std::vector<double>& t : corner_place_) t.clear();
  for (const Index c : candidates) {
    for (const Point p : envelope_.patches().corners(c)) {
      if (!(p.x > box.low.x && p.x < box.high.x && p.y > box.low.y && p.y < box.high.y)) continue;
      corner_place_[0].push_back(double(p.x));
      corner_place_[1].push_back(double(p.y));
    }
  }
  if (const std::optional<Cut> between = cut_between_vertices(box)) return *between;
  add_likely_vertices(box);
  if (corner_place_[0].size() < 2) return best;
  // The widest gap, but none that makes long thin cells.
  Real widest = std::max(width * stretch.x, height * stretch.y) / 32;
  for (const bool vertical : {true, false}) {
    const Real low = vertical ? box.low.x : box.low.y, high = vertical ? box.high.x : box.high.y;
    const Real scale = vertical ? stretch.x : stretch.y, across = vertical ? height * stretch.y : width * stretch.x;
    std::vector<double>& t = corner_place_[vertical ? 0 : 1];
    std::sort(t.begin(), t.end());
    const auto consider = [&](Real gap, Real at) {
      if (!(gap * scale > widest && 8 * scale * std::min(at - low, high - at) > across)) return;
      widest = gap * scale;
      best = {vertical, double(at)};
    };
    for (std::size_t i = 1; i < t.size(); ++i) consider(t[i] - t[i - 1], t[i - 1] + uneven * (t[i] - t[i - 1]));
  }
  return best;
}

/// How much longer lines in x and y are on the surface than in the plane, in the middle of the box.
template <class Real>
GradientOf<Real> Cells<Real>::steepness(const Box& box) const {
  Gradient most{0, 0};
  const auto consider = [&](Index l) {
    if (l == none) return;
    const Gradient g = envelope_.patches().gradient(l, box.middle());
    if (size(g) > size(most)) most = g;
  };
  for (const Turn& t : turns_) consider(t.after);
  if (turns_.empty()) {
    for (const Index l : seen_) consider(l);
  }
  return {square_root(1 + most.x * most.x), square_root(1 + most.y * most.y)};
}

/// Between curves that lie side by side, along them: R above the extent makes strips much longer than they are wide.
template <class Real>
std::optional<typename Cells<Real>::Cut> Cells<Real>::cut_between_strips(const Cell& cell) {
  Index count[2];  // of crossings on vertical sides and on horizontal ones
  for (int i = 0; i < 2; ++i) {
    const CellSide &s = cell.side[i == 0 ? 1 : 0], &t = cell.side[i == 0 ? 3 : 2];
    count[i] = s.last - s.first + t.last - t.first;
  }
  if (std::max(count[0], count[1]) < std::max(4u, 2 * std::min(count[0], count[1]))) return std::nullopt;
  const bool vertical = count[1] > count[0];
  std::vector<double>& t = corner_place_[0];
  t.clear();
  for (const int i : {vertical ? 0 : 1, vertical ? 2 : 3}) {
    for (Index c = cell.side[i].first; c < cell.side[i].last; ++c) t.push_back(map_.crossings()[c].t);
  }
  std::sort(t.begin(), t.end());
  double at = 0, widest = 0x1p-10 * double(vertical ? 2 * cell.box.half_x() : 2 * cell.box.half_y());
  bool found = false;
  for (std::size_t i = t.size() / 4; i + 1 < t.size() && i <= 3 * t.size() / 4; ++i) {
    if (t[i + 1] - t[i] > widest) widest = t[i + 1] - t[i], at = t[i] + near_middle * widest, found = true;
  }
  return found ? std::optional(Cut{vertical, at}) : std::nullopt;
}

/// Beside a straight wall: the surface is smooth in the height above it, the root of the distance, and cells are square
/// in that.
template <class Real>
std::optional<typename Cells<Real>::Cut> Cells<Real>::cut_beside_wall(const Box& box) const {
  const Real width = box.high.x - box.low.x, height = box.high.y - box.low.y;
  for (const Turn& turn : turns_) {
    const Bound* side = turn.meeting == Meeting::rim ? side_along(turn) : nullptr;
    if (side == nullptr || side->type != BoundType::line) continue;
    if (std::min(absolute(side->nx), absolute(side->ny)) > 0x1p-40) continue;
    const bool upright = absolute(side->nx) > 0.5;
    const Real wall = upright ? turn.at.x : turn.at.y;
    const Real inside = (upright ? side->nx : side->ny) * -side->sign();  // the direction away from the wall
    const Real far = inside > 0 ? (upright ? box.high.x : box.high.y) - wall : wall - (upright ? box.low.x : box.low.y);
    if (!(far > 4 * envelope_.tolerance())) continue;
    const Real up = square_root(2 * envelope_.patches().radius() * far), along = upright ? height : width;
    if (along > up)
      return Cut{!upright, double(upright ? box.low.y + near_middle * height : box.low.x + near_middle * width)};
    return Cut{upright, double(inside > 0 ? wall + far / 4 : wall - far / 4)};
  }
  return std::nullopt;
}

/// Between two vertices in a cell in which four curves or more end, as if these were straight: two neighbouring turns
/// lead to each.
template <class Real>
std::optional<typename Cells<Real>::Cut> Cells<Real>::cut_between_vertices(const Box& box) const {
  constexpr std::size_t most = 8;
  const std::size_t n = star_.size();
  if (n < 4 || n > most) return std::nullopt;
  Gradient across[most];
  for (std::size_t i = 0; i < n; ++i) {
    const Turn& t = star_[i];
    if (t.meeting == Meeting::rim) return std::nullopt;
    across[i] = envelope_.gradient_across(t.before, t.after, t.meeting, t.at);
  }
  const auto next = [&](std::size_t i) { return i + 1 < n ? i + 1 : 0; };
  std::optional<Point> vertex[most];  // where the curves of a turn and the next one meet
  for (std::size_t i = 0; i < n; ++i) {
    const Gradient g = across[i], h = across[next(i)];
    const Point a = star_[i].at, b = star_[next(i)].at;
    const Real det = g.x * h.y - g.y * h.x, at = h.x * (b.x - a.x) + h.y * (b.y - a.y);
    if (det == 0) continue;
    const Point p{a.x - g.y * (at / det), a.y + g.x * (at / det)};
    if (box.contains(p)) vertex[i] = p;
  }
  const auto side = [](Point a, Point b, Point p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); };
  const auto cross = [&](Point a, Point b, Point c, Point d) {
    return (side(a, b, c) > 0) != (side(a, b, d) > 0) && (side(c, d, a) > 0) != (side(c, d, b) > 0);
  };
  const auto arms_cross = [&](std::size_t i, std::size_t j) {
    for (const std::size_t a : {i, next(i)}) {
      for (const std::size_t b : {j, next(j)}) {
        if (cross(star_[a].at, *vertex[i], star_[b].at, *vertex[j])) return true;
      }
    }
    return false;
  };
  Cut best{};
  Real widest = 64 * envelope_.smallest_cell();
  bool found = false;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n && vertex[i]; ++j) {
      if (next(j) == i || !vertex[j]) continue;
      const Point v = *vertex[i], w = *vertex[j];
      const Real dx = absolute(v.x - w.x), dy = absolute(v.y - w.y);
      if (std::max(dx, dy) <= widest || arms_cross(i, j)) continue;
      const bool vertical = dx > dy;
      const Real from = vertical ? v.x : v.y, to = vertical ? w.x : w.y;
      widest = std::max(dx, dy);
      best = {vertical, double(from + uneven * (to - from))};
      found = true;
    }
  }
  return found ? std::optional(best) : std::nullopt;
}

/// Where seams meet the one valley through the cell, as if that were straight.
template <class Real>
void Cells<Real>::add_likely_vertices(const Box& box) {
  const Turn* valley[2] = {nullptr, nullptr};
  int count = 0;
  for (const Turn& t : turns_) {
    if (t.meeting != Meeting::valley) continue;
    if (count == 2) return;
    valley[count++] = &t;
  }
  if (count < 2) return;
  const PatchSet<Real>& patches = envelope_.patches();
  const Point p = valley[0]->at, q = valley[1]->at;
  for (const Turn& t : turns_) {
    const Bound* seam = t.meeting == Meeting::seam ? patches.seam(t.before, t.after) : nullptr;
    if (seam == nullptr) continue;
    const Real a = seam->value(p, patches.square_radius()), b = seam->value(q, patches.square_radius());
    if ((a < 0) == (b < 0)) continue;
    const Point v{p.x + a / (a - b) * (q.x - p.x), p.y + a / (a - b) * (q.y - p.y)};
    if (!(v.x > box.low.x && v.x < box.high.x && v.y > box.low.y && v.y < box.high.y)) continue;
    corner_place_[0].push_back(double(v.x));
    corner_place_[1].push_back(double(v.y));
  }
}

template class Cells<double>;
template class Cells<DoubleDouble>;

}  // namespace krepl::terrain
