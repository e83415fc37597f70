#include <algorithm>

#include "terrain/cells.hpp"

// Where three or more patches meet: Newton's method on two of the functions that vanish along the curves out of the
// vertex.
namespace krepl::terrain {

/// The side of a domain that a seam or rim runs along; at a rim that at which the upper patch ends.
template <class Real>
const BoundOf<Real>* Cells<Real>::side_along(const Turn& t) const {
  const PatchSet<Real>& patches = envelope_.patches();
  if (t.meeting == Meeting::seam) return patches.seam(t.before, t.after);
  // Beside a seam only where what it leads to is too thin to show.
  const Real far = 4 * envelope_.tolerance();
  const Bound* nearest = nullptr;
  Real least = 1e300;
  for (const Index l : {t.before, t.after}) {
    if (!is_wall_of(t, l)) continue;
    for (const Bound& b : patches.bounds(l)) {
      const Gradient g = envelope_.bound_gradient(b, t.at);
      const Real distance = absolute(b.value(t.at, patches.square_radius())) / size(g) + (b.partner != none ? far : 0);
      if (distance < least) least = distance, nearest = &b;
    }
  }
  return nearest;
}

/// The side of a face that passes through a place.
template <class Real>
const BoundOf<Real>* Cells<Real>::nearest_side(Index face, Point p) const {
  const std::span<const Bound> sides = envelope_.patches().bounds(face);
  const auto distance = [&](const Bound& b) { return absolute(b.value(p, envelope_.patches().square_radius())); };
  return &*std::min_element(sides.begin(), sides.end(),
                            [&](const Bound& a, const Bound& b) { return distance(a) < distance(b); });
}

template <class Real>
bool Cells<Real>::has_corner(Index patch, Point p) const {
  if (patch == none) return false;
  for (const Point c : envelope_.patches().corners(patch)) {
    if (absolute(c.x - p.x) <= envelope_.tolerance() && absolute(c.y - p.y) <= envelope_.tolerance()) return true;
  }
  return false;
}

/// True if two patches have a corner at p at the same height, as far as heights near the rim tell, which fall like
/// square roots.
template <class Real>
bool Cells<Real>::share_corner(Index a, Index b, Point p) const {
  if (a == none || b == none || !has_corner(a, p) || !has_corner(b, p)) return false;
  return absolute(envelope_.border_height(a, p) - envelope_.border_height(b, p)) <= 0x1p22 * envelope_.tolerance();
}

/// True if every patch among the labels has p in its domain, or on its border as far as numbers tell.
template <class Real>
bool Cells<Real>::all_reach(Point p) const {
  return std::all_of(turns_.begin(), turns_.end(),
                     [&](const Turn& t) { return t.after == none || reaches(t.after, p); });
}

template <class Real>
bool Cells<Real>::reaches(Index patch, Point p) const {
  return has_corner(patch, p) || is_within(patch, p, 4 * envelope_.tolerance());
}

/// True if p is beyond no side of the patch by more than that: less than nothing is well inside.
template <class Real>
bool Cells<Real>::is_within(Index patch, Point p, Real beyond) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const std::span<const Bound> sides = patches.bounds(patch);
  return std::none_of(sides.begin(), sides.end(), [&](const Bound& b) {
    return b.sign() * b.value(p, patches.square_radius()) > beyond * (1 + size(envelope_.bound_gradient(b, p)));
  });
}

/// True if the patch reaches p, and no patch among the labels is higher there.
template <class Real>
bool Cells<Real>::shows_at(Index patch, Point p) const {
  if (patch == none || !reaches(patch, p)) return false;
  const PatchSet<Real>& patches = envelope_.patches();
  const Real h = envelope_.border_height(patch, p);
  for (const Turn& t : turns_) {
    if (t.after == none || t.after == patch || !patches.contains(t.after, p)) continue;
    const Gradient g = patches.gradient(patch, p), k = patches.gradient(t.after, p);
    const Real slack = 4 * envelope_.tolerance() * (1 + norm(g.x - k.x, g.y - k.y));
    if (envelope_.border_height(t.after, p) > h + slack) return false;
  }
  return true;
}

/// True if one of the patches around the cell hides the patches that have a corner at p.
template <class Real>
bool Cells<Real>::is_covered(Point p) const {
  return std::none_of(turns_.begin(), turns_.end(), [&](const Turn& t) {
    return t.meeting == Meeting::rim || (has_corner(t.after, p) && shows_at(t.after, p));
  });
}

/// The one corner in the box of a patch two of whose sides are among the turns, or that two patches among the labels
/// have, or the place where two balls touch.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::common_corner(const Box& box) const {
  std::optional<Point> found;
  const auto consider_place = [&](Point c) {  // false: there are two
    if (!box.contains(c)) return true;
    if (found && norm(found->x - c.x, found->y - c.y) > envelope_.tolerance()) return false;
    if (!found) found = c;
    return true;
  };
  const auto consider = [&](Index patch, auto&& wanted) {
    const std::span<const Point> corners = envelope_.patches().corners(patch);
    return std::all_of(corners.begin(), corners.end(),
                       [&](Point c) { return !box.contains(c) || !wanted(c) || consider_place(c); });
  };
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      Index patch = none;
      if (sides_of_one_patch(turns_[i], turns_[j], box, patch) && !consider(patch, [](Point) { return true; }))
        return std::nullopt;
      const Index a = turns_[i].after, b = turns_[j].after;
      if (a == none || b == none || a == b) continue;
      if (!consider(a, [&](Point c) { return share_corner(a, b, c); })) return std::nullopt;
      const std::optional<Point> touch = touch_of_balls(a, b);
      if (touch && !consider_place(*touch)) return std::nullopt;
    }
  }
  return found;
}

/// Where a ball's wall in the box touches an edge's straight one, or runs below or above it where that ends: the vertex lies in
/// the edge's vertical plane, or at twice the radius from it.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::touch_of_walls(const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const Real radius = patches.radius(), rounding = 0x1p-50 * radius;
  for (const Turn& t : turns_) {
    if (t.meeting != Meeting::rim) continue;
    const Patch& ball = patches[sides_of_wall(t).first];
    if (ball.kind != Terrain::FeatureKind::vertex) continue;
    for (const Turn& other : turns_) {
      if (other.after == none || patches[other.after].kind != Terrain::FeatureKind::edge) continue;
      const Patch& edge = patches[other.after];
      const Real aside = edge.aside(ball.at);
      const auto side = [&](Real s) { return Point{ball.at.x - s * edge.gy, ball.at.y + s * edge.gx}; };
      if (absolute(absolute(aside) - 2 * radius) <= rounding) {
        const Point p = side(aside > 0 ? -radius : radius);
        if (box.contains(p)) return p;
      }
      if (absolute(aside) > rounding) continue;
      for (const Real s : {radius, -radius}) {
        if (box.contains(side(s))) return side(s);
      }
    }
  }
  return std::nullopt;
}

/// True if a patch that meets the corner rises above a straight seam there which shows farther on: the valley beside it
/// crosses the seam once more then. Above the seam the other patch's height is concave, so that it does so at its foot
/// or not at all.
template <class Real>
bool Cells<Real>::hides_foot_of_seam(Point corner) const {
  const PatchSet<Real>& patches = envelope_.patches();
  for (const Turn& seam : turns_) {
    if (seam.meeting != Meeting::seam) continue;
    const Real dx = seam.at.x - corner.x, dy = seam.at.y - corner.y;
    for (const Turn& valley : turns_) {
      if (valley.meeting != Meeting::valley) continue;
      const auto is_of_seam = [&](Index l) { return l == seam.before || l == seam.after; };
      if (is_of_seam(valley.before) == is_of_seam(valley.after)) continue;
      const Index low = is_of_seam(valley.before) ? valley.before : valley.after;
      const Index high = low == valley.before ? valley.after : valley.before;
      const Gradient g = patches.gradient(high, corner), k = patches.gradient(low, corner);
      if (!((g.x - k.x) * dx + (g.y - k.y) * dy > 4 * envelope_.noise())) continue;
      for (Real part = 0.5; part > 0x1p-30; part *= 0.5) {
        const Point p{corner.x + part * dx, corner.y + part * dy};
        if (patches.contains(high, p) &&
            envelope_.clamped_height(high, p) - envelope_.clamped_height(low, p) > 4 * envelope_.noise())
          return true;
      }
    }
  }
  return false;
}

/// True if p lies inside of one patch that is higher than another one of the labels, or than nothing where that is a label: then
/// the other one ends before it gets there, which no turn tells.
template <class Real>
bool Cells<Real>::hides_label(Point p) const {
  const PatchSet<Real>& patches = envelope_.patches();
  for (const Turn& t : turns_) {
    if (t.after == none || !is_within(t.after, p, -4 * envelope_.tolerance())) continue;
    const Real height = patches.extended_height(t.after, p);
    const Gradient g = patches.gradient(t.after, p);
    for (const Turn& other : turns_) {
      if (other.after == none) return true;
      const Gradient h = patches.gradient(other.after, p);
      const Real slack = 64 * envelope_.tolerance() * (1 + norm(g.x - h.x, g.y - h.y));
      if (envelope_.border_height(other.after, p) < height - slack) return true;
    }
  }
  return false;
}

/// Where the patches around the cell meet in one vertex.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::star_point(const Box& box) const {
  const std::optional<Point> p = common_point(box);
  return p && hides_label(*p) ? std::nullopt : p;
}

/// Vanishes along the curve that the condition is of.
template <class Real>
Real Cells<Real>::value(const Condition& c, Point p) const {
  if (c.bound != nullptr) return c.bound->value(p, envelope_.patches().square_radius());
  return envelope_.clamped_height(c.a, p) -
         (c.at_rim ? envelope_.rim_height(c.b, p) : envelope_.clamped_height(c.b, p));
}

template <class Real>
GradientOf<Real> Cells<Real>::gradient(const Condition& c, Point p) const {
  if (c.bound != nullptr) return envelope_.bound_gradient(*c.bound, p);
  const PatchSet<Real>& patches = envelope_.patches();
  const Gradient g = patches.gradient(c.a, p), h = c.at_rim ? envelope_.rim_gradient(c.b) : patches.gradient(c.b, p);
  return {g.x - h.x, g.y - h.y};
}

template <class Real>
GradientRangeOf<Real> Cells<Real>::gradient_range(const Condition& c, const Box& box) const {
  if (c.bound != nullptr) return envelope_.bound_gradient_range(*c.bound, box);
  const Gradient wall = c.at_rim ? envelope_.rim_gradient(c.b) : Gradient{0, 0};
  constexpr auto where = Envelope<Real>::Where::in_domain;
  const GradientRange a = envelope_.gradient_range(c.a, box, where);
  const GradientRange b =
      c.at_rim ? GradientRange{{wall.x, wall.x}, {wall.y, wall.y}} : envelope_.gradient_range(c.b, box, where);
  return {a.x - b.x, a.y - b.y};
}

/// The two conditions whose curves cross at the largest angle; sides of domains before heights.
template <class Real>
std::pair<std::size_t, std::size_t> Cells<Real>::crossing_most(std::span<const Condition> conditions, Point p) const {
  std::pair<std::size_t, std::size_t> found{0, 1};
  Real best = -1;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const Gradient g = gradient(conditions[i], p);
    for (std::size_t j = i + 1; j < conditions.size(); ++j) {
      const Gradient h = gradient(conditions[j], p);
      const Real sizes = size(g) * size(h);
      Real sine = sizes > 0 ? absolute(g.x * h.y - g.y * h.x) / sizes : 0;
      const int sides = (conditions[i].bound != nullptr) + (conditions[j].bound != nullptr);
      if (sine > 1e-6) sine += sides;
      if (sine > best) best = sine, found = {i, j};
    }
  }
  return found;
}

/// True if three conditions, of which `first` and `second` cross most, hold at one place of the box at most: two sides of
/// domains are enough for that, for heights the map must be one to one.
template <class Real>
bool Cells<Real>::is_met_once(std::span<const Condition> conditions, std::size_t first, std::size_t second,
                              const Box& box) const {
  const Condition &c = conditions[first], &d = conditions[second];
  if (c.bound != nullptr && d.bound != nullptr) return true;
  const PatchSet<Real>& patches = envelope_.patches();
  const Point middle = box.middle();
  const auto is_straight = [&](const Condition& k) {
    if (k.bound != nullptr) return k.bound->type == BoundType::line;
    using Kind = Terrain::FeatureKind;
    return !k.at_rim && patches[k.a].kind == Kind::face && patches[k.b].kind == Kind::face;
  };
  // Along a straight curve, which meets another one once if that one's function rises or falls all along.
  const auto is_crossed_once = [&](const Condition& straight, const Condition& k) {
    const Gradient g = gradient(straight, middle), along{-g.y, g.x};
    if (k.bound != nullptr || k.at_rim) {
      const GradientRange r = gradient_range(k, box);
      return (r.x * Range{along.x, along.x} + r.y * Range{along.y, along.y}).excludes_zero();
    }
    return slope_of_difference(k.a, k.b, box, along).excludes_zero();
  };
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Condition &e = conditions[i], &f = conditions[j];
      if (is_straight(e) && is_crossed_once(e, f)) return true;
      if (is_straight(f) && is_crossed_once(f, e)) return true;
    }
  }
  return cross_once(c, d, box);
}

/// True if two conditions hold at one place of the box at most, because their gradients are nowhere in one line.
template <class Real>
bool Cells<Real>::cross_once(const Condition& c, const Condition& d, const Box& box) const {
  const GradientRange a = gradient_range(c, box), b = gradient_range(d, box);
  return (a.x * b.y - a.y * b.x).excludes_zero();
}

template <class Real>
std::optional<PointOf<Real>> Cells<Real>::common_point(const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const Real square = patches.square_radius(), radius = patches.radius();
  std::array<Condition, 16> condition{};
  const std::size_t n = turns_.size();
  if (n > condition.size()) return std::nullopt;

  for (std::size_t i = 0; i < n; ++i) {
    const Turn& t = turns_[i];
    condition[i] = {nullptr, t.before, t.after, false};
    if (t.meeting != Meeting::valley && (condition[i].bound = side_along(t)) == nullptr) return std::nullopt;
    if (const Index first = first_in_plane(t, box); first != none) condition[i].bound = nearest_side(first, t.at);
  }
  const std::array<Condition, 16> anywhere = condition;
  // Near the end of a patch its height falls like a square root; the height of the wall itself is smooth.
  for (std::size_t i = 0; i < n; ++i) {
    if (condition[i].bound != nullptr) continue;
    for (const Turn& t : turns_) {
      if (t.meeting != Meeting::rim) continue;
      for (const Index l : {condition[i].a, condition[i].b}) {
        if (!is_wall_of(t, l)) continue;
        condition[i] = {nullptr, condition[i].a == l ? condition[i].b : condition[i].a, l, true};
      }
    }
  }

  // By how much heights may differ at a place that is on their curve as far as lengths in the plane are told apart.
  const Real most = 2 * square_root(2 * radius * envelope_.tolerance());  // beside a wall, a bit inside of it
  const auto height_slack = [&](Gradient g) {
    return std::min(most, envelope_.tolerance() * size(g)) + envelope_.noise();
  };

  if (const std::optional<Point> end = end_of_thin_bend(box)) return end;
  if (n == 3) {
    const std::optional<Point> level = level_of_walls(box.middle());
    if (level && box.contains(*level)) return level;
  }
  // A corner that two labels share, or two sides of one, is known beforehand; near the rim the curves there are
  // tangent.
  const auto passes = [&](std::size_t k, Point corner) {
    const Condition& c = condition[k];
    if (c.bound != nullptr && c.bound->type != BoundType::cone) {
      const Real scale = c.bound->type == BoundType::disc ? 2 * radius : 1;
      return absolute(c.bound->value(corner, square)) <= 4 * envelope_.tolerance() * scale;
    }
    if (share_corner(turns_[k].before, turns_[k].after, corner)) return true;
    return absolute(value(c, corner)) <= 4 * height_slack(gradient(c, corner));
  };
  const auto has_walls = [&](Point p) {
    return std::any_of(turns_.begin(), turns_.end(), [&](const Turn& t) {
      return t.after != none && t.meeting != Meeting::rim && envelope_.rim_at(t.after, p) != nullptr;
    });
  };
  std::optional<Point> corner = common_corner(box);
  if (corner && n == 3 && is_covered(*corner)) corner.reset();
  if (!corner) {
    corner = touch_of_walls(box);
    for (std::size_t k = 0; corner && k < n; ++k) {
      if (!passes(k, *corner)) corner.reset();
    }
  }
  if (corner) {
    if (!all_reach(*corner)) return std::nullopt;
    for (std::size_t k = 0; k < n; ++k) {
      if (!passes(k, *corner)) return std::nullopt;
    }
    if (hides_foot_of_seam(*corner)) return std::nullopt;
    // Patches that end in walls at one place can meet once more nearby, and so can three of four.
    if (n == 3 && !has_walls(*corner)) return corner;
  }

  // The place near `start` where two of the conditions hold.
  const Real tolerance = envelope_.tolerance(), reach = 4 * box.larger_side();
  const Point middle = box.middle();
  const auto solve = [&](const Condition& c, const Condition& d, Point start) -> std::optional<Point> {
    Point p = start;
    bool converged = false;
    for (int i = 0; i < 30 && !converged; ++i) {
      const Real f = value(c, p), e = value(d, p);
      const Gradient g = gradient(c, p), h = gradient(d, p);
      const Real det = g.x * h.y - g.y * h.x;
      if (det == 0 || !is_finite(det)) return std::nullopt;
      const Real dx = -(f * h.y - e * g.y) / det, dy = -(e * g.x - f * h.x) / det;
      p = {p.x + dx, p.y + dy};
      if (!(absolute(p.x - middle.x) <= reach && absolute(p.y - middle.y) <= reach)) return std::nullopt;
      converged = absolute(dx) + absolute(dy) <= 0.25 * tolerance;
    }
    return converged && box.contains(p) ? std::optional(p) : std::nullopt;
  };
  // Two curves in a row that bound one patch, and meet elsewhere in the box: where they are tangent at the vertex not so near
  // to it that they are not told apart.
  const auto meet_elsewhere = [&](Point vertex) {
    const bool walls = has_walls(vertex);
    const Real near = touch_of_balls_beside(vertex) ? reach_of_touch() : 16 * tolerance;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      if (cross_once(anywhere[i], anywhere[j], box)) continue;
      const Gradient g = gradient(anywhere[i], vertex), h = gradient(anywhere[j], vertex);
      const Real least = walls ? 0 : 1;  // two patches may be tangent there themselves
      const bool tangent = absolute(g.x * h.y - g.y * h.x) <= 0x1p-10 * std::max(least, size(g)) * std::max(least, size(h));
      const Real apart = tangent ? std::max(near, reach_of_touch()) : near;
      for (const Point start : {middle, turns_[i].at, turns_[j].at}) {
        const std::optional<Point> p = solve(anywhere[i], anywhere[j], start);
        if (!p || norm(p->x - vertex.x, p->y - vertex.y) <= apart) continue;
        if (shows_at(turns_[i].before, *p) && shows_at(turns_[i].after, *p) && shows_at(turns_[j].after, *p)) return true;
      }
    }
    return false;
  };
  if (corner) return meet_elsewhere(*corner) ? std::nullopt : corner;
  const auto [first, second] = crossing_most({condition.data(), n}, middle);
  const Condition &c = condition[first], &d = condition[second];
  const std::optional<Point> p = solve(c, d, middle);
  if (!p && is_fine<Real>) return end_of_thin_strip();
  if (!p || !all_reach(*p)) return std::nullopt;
  for (const Turn& t : turns_) {  // walls that are none here
    if (t.meeting != Meeting::rim || t.before == none || t.after == none) continue;
    const auto [upper, lower] = sides_of_wall(t);
    const Real slack = 4 * tolerance * (1 + size(patches.gradient(lower, *p)));
    if (envelope_.rim_at(lower, *p) == nullptr &&
        envelope_.border_height(lower, *p) > envelope_.rim_height(upper, *p) + slack)
      return std::nullopt;
  }
  for (const Condition& k : std::span(condition.data(), n)) {
    Real slack = tolerance;
    if (k.bound != nullptr && k.bound->type == BoundType::disc) slack = 2 * radius * tolerance;
    if (k.bound != nullptr && k.bound->type == BoundType::cone) slack += absolute(k.bound->c) * tolerance;
    if (k.bound == nullptr) slack = height_slack(gradient(k, *p));
    if (!(absolute(value(k, *p)) <= slack)) return std::nullopt;
  }
  const bool once = n > 3 ? !meet_elsewhere(*p) : is_met_once({condition.data(), n}, first, second, box);
  return once ? p : std::nullopt;
}

template class Cells<double>;
template class Cells<DoubleDouble>;

}  // namespace krepl::terrain
