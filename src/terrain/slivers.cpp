#include <algorithm>

#include "terrain/cells.hpp"

// What shows nowhere around a cell, and what it can be inside: nothing, or less than matters.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

/// True if every candidate that may show in the cell by more than matters is among the labels around it. Those that are
/// found to be hidden are none any more.
template <class Real>
bool Cells<Real>::shows_all(const Cell& cell, std::span<Index> candidates) {
  seen_.clear();
  if (turns_.empty() && cell.side[0].label != none) seen_.push_back(cell.side[0].label);
  for (const Turn& t : turns_) {
    if (t.after != none && !is_seen(t.after)) seen_.push_back(t.after);
  }
  std::optional<bool> prisms;
  for (Index& c : candidates) {
    if (is_seen(c)) continue;
    if (is_hidden(c, cell.box)) {
      c = none;
      continue;
    }
    if (cell.box.larger_side() > envelope_.patches().radius() / 128) return false;
    if (is_thin(c, none, none, cell.box, envelope_.tolerance()) || is_tangent_sliver(c, cell.box) ||
        envelope_.hidden_within_tolerance(c, seen_, cell.box) || is_hidden_beside_wall(c, cell.box))
      continue;
    if (!prisms) prisms = all_are_prisms(candidates, cell.box);
    if (!*prisms) return false;
  }
  return true;
}

/// True if a patch that shows nowhere around the cell stays below the patches that do.
template <class Real>
bool Cells<Real>::is_hidden(Index patch, const Box& box) const {
  // Four or more labels, each seen once, hardly ever meet in one vertex: the cell is going to be cut anyway.
  if (seen_.size() == turns_.size() ? seen_.size() > 3 : turns_.size() > 6) return false;
  return envelope_.stays_hidden(patch, box, std::span(seen_).first(std::min<std::size_t>(seen_.size(), 4)), 5);
}

template <class Real>
bool Cells<Real>::is_seen(Index label) const {
  return std::find(seen_.begin(), seen_.end(), label) != seen_.end();
}

/// True if a cylinder's or sphere's patch is nowhere in the box wider than that between two of its sides; a sphere's
/// between the seams to a and b, unless these are none. With `crossed` the sides lie the other way round, and nowhere
/// farther apart than that.
///
/// Both sides' functions are negative inside, so where their sum is above -t, so is each; their gradients across are at
/// least 1, and near the rim at least the slope of their root.
template <class Real>
bool Cells<Real>::is_thin(Index patch, Index a, Index b, const Box& box, Real width, bool crossed) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const std::span<const Bound> bounds = patches.bounds(patch);
  if (patches[patch].kind == FeatureKind::edge) return bounds[0].c - bounds[1].c <= width;  // its two straight sides
  if (patches[patch].kind != FeatureKind::vertex) return false;
  const Point at = patches[patch].at, mid = box.middle();
  const Real aside = norm(std::max(Real(0), absolute(mid.x - at.x) - box.half_x()),
                          std::max(Real(0), absolute(mid.y - at.y) - box.half_y()));
  const Real up = square_root(std::max(Real(0), patches.square_radius() - aside * aside));
  const Real steepness = up > 0 ? aside / up : 0;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Bound &f = bounds[i], &g = bounds[j];
      if (f.type != BoundType::cone || g.type != BoundType::cone) continue;
      if (a != none && !(f.partner == a && g.partner == b) && !(f.partner == b && g.partner == a)) continue;
      const Real s = f.sign(), t = g.sign();
      Bound sum = f;
      sum.nx = s * f.nx + t * g.nx;
      sum.ny = s * f.ny + t * g.ny;
      sum.c = s * f.c + t * g.c;
      const Real least = std::min(absolute(f.c), absolute(g.c)), slope = least * steepness - 1;
      const Range depth = envelope_.bound_range(sum, box);
      const Real deepest = crossed ? -depth.high : depth.low;
      if (deepest >= -width * std::clamp<Real>(slope, 1, 64)) return true;
      // Steeper still, what is thin in the plane has to be so on the surface, too: their functions are c times as
      // steep.
      if (slope > 64 && deepest >= -width * slope && deepest >= -envelope_.thickness() * least) return true;
    }
  }
  return false;
}

/// True if two edges are so nearly in one line that the sphere between them is nowhere in the box wider than the
/// tolerance, or, where it is elsewhere, that their own ends overlap by no more.
template <class Real>
bool Cells<Real>::is_thin_bend(Index a, Index b, const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  if (a == none || b == none || patches[a].kind != FeatureKind::edge || patches[b].kind != FeatureKind::edge)
    return false;
  for (const Bound& side : patches.bounds(a)) {
    if (side.partner == none || patches[side.partner].kind != FeatureKind::vertex) continue;
    if (patches.seam(side.partner, b) == nullptr) continue;
    return is_thin(side.partner, a, b, box, envelope_.tolerance(), !envelope_.domain_meets(side.partner, box));
  }
  return false;
}

/// Where a sphere's patch between two edges in nearly one line gets too thin to show: anywhere along it.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::end_of_thin_bend(const Box& box) const {
  if (turns_.size() != 3) return std::nullopt;
  const PatchSet<Real>& patches = envelope_.patches();
  for (std::size_t i = 0; i < 3; ++i) {
    const Turn &from = turns_[i], &to = turns_[(i + 1) % 3], &beyond = turns_[(i + 2) % 3];
    if (from.meeting != Meeting::seam || to.meeting != Meeting::seam || from.after == none) continue;
    if (!is_thin(from.after, from.before, to.after, box, 4 * envelope_.tolerance())) continue;
    const Bound* seam = patches.seam(from.before, from.after);
    Point p{(from.at.x + beyond.at.x) / 2, (from.at.y + beyond.at.y) / 2};
    for (int k = 0; k < 8; ++k) {
      const Gradient g = envelope_.bound_gradient(*seam, p);
      const Real step = seam->value(p, patches.square_radius()) / (g.x * g.x + g.y * g.y);
      p = {p.x - step * g.x, p.y - step * g.y};
    }
    if (box.contains(p)) return p;
  }
  return std::nullopt;
}

/// Where a patch between two others gets too thin to show, and the two go on side by side: where it comes into the
/// cell, if it is hardly wider there than what is left out (the far turn tells that it is left out).
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::end_of_thin_strip() const {
  if (turns_.size() != 3) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    const Turn &from = turns_[i], &to = turns_[(i + 1) % 3], &beyond = turns_[(i + 2) % 3];
    const Gradient g = envelope_.gradient_across(from.before, from.after, from.meeting, from.at);
    const Real dx = to.at.x - from.at.x, dy = to.at.y - from.at.y, apart = norm(dx, dy),
               tolerance = envelope_.tolerance();
    const Real across = absolute(g.x * dx + g.y * dy) / size(g);
    const Real narrow = (from.after == none ? 16 : 4) * tolerance;  // four times what lines leave out, about
    if (!(across <= narrow && apart <= 64 * tolerance)) continue;
    // What is steep is thicker on the surface than it is wide in the plane.
    if (from.after != none &&
        !(across * size(envelope_.patches().gradient(from.after, from.at)) <= 4 * envelope_.thickness()))
      continue;
    if (!(2 * apart <= norm(beyond.at.x - from.at.x, beyond.at.y - from.at.y))) continue;
    const Point p{(from.at.x + to.at.x) / 2, (from.at.y + to.at.y) / 2};
    constexpr double inwards = 0x1p-10;  // so that the vertex lies in the cell
    return Point{p.x + inwards * (beyond.at.x - p.x), p.y + inwards * (beyond.at.y - p.y)};
  }
  return std::nullopt;
}

/// True if all candidates are the same along one direction all over the box: what shows in it anywhere shows at its
/// sides.
template <class Real>
bool Cells<Real>::all_are_prisms(std::span<const Index> candidates, const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const auto edge = std::find_if(candidates.begin(), candidates.end(),
                                 [&](Index c) { return c != none && patches[c].kind == FeatureKind::edge; });
  if (edge == candidates.end()) return false;
  const Patch& axis = patches[*edge];
  const Real size = box.larger_side(), slack = envelope_.tolerance() / 16;
  for (const Index c : candidates) {
    if (c == none) continue;
    const Patch& f = patches[c];
    if (f.kind == FeatureKind::vertex) return false;
    Real rise = f.gx * axis.gx + f.gy * axis.gy;
    if (f.kind == FeatureKind::edge) {
      if (absolute(f.gx * axis.gy - f.gy * axis.gx) * size > slack) return false;
      rise *= f.m;
    }
    if (!(absolute(rise - axis.m) * size <= slack)) return false;
    for (const Bound& b : patches.bounds(c)) {
      if (b.type == BoundType::line && absolute(b.nx * axis.gx + b.ny * axis.gy) * size <= slack) continue;
      if (!envelope_.covers(b, box)) return false;
    }
  }
  return true;
}

/// True if a patch that shows nowhere around the cell can show inside it only within the tolerance of one of its sides:
/// where a valley is tangent to a seam, or a wall to another one; or within the tolerance of a wall above it, where a
/// valley is tangent to its foot.
///
/// With g < 0 on the patch's side, and f < 0 where it is hidden: if f - k g <= k t s all over the box, then f <= 0
/// wherever g <= -t s, and the distance from there to the side is t if g changes by at least s across it: 1 for the
/// sides of a patch (for a disc about 2 R), and more beside a wall.
template <class Real>
bool Cells<Real>::is_tangent_sliver(Index patch, const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const Point mid = box.middle();
  struct Function {
    Real value;
    Gradient gradient;
    GradientRange range;
  };
  const auto side = [&](const Bound& b) {
    const Real sign = b.sign();
    const Gradient g = envelope_.bound_gradient(b, mid);
    const GradientRange r = envelope_.bound_gradient_range(b, box);
    const Range factor{sign, sign};
    return Function{
        sign * b.value(mid, patches.square_radius()), {sign * g.x, sign * g.y}, {r.x * factor, r.y * factor}};
  };
  const auto hidden_by = [&](Index other) {
    if (const std::optional<Bound> wall = envelope_.wall_above(other, patch, box)) return side(*wall);
    const Gradient c = patches.gradient(patch, mid), o = patches.gradient(other, mid);
    const GradientRange cs = envelope_.gradient_range(patch, box), os = envelope_.gradient_range(other, box);
    return Function{patches.extended_height(patch, mid) - patches.extended_height(other, mid),
                    {c.x - o.x, c.y - o.y},
                    {cs.x - os.x, cs.y - os.y}};
  };
  const auto curvature_of_side = [&](const Bound& b) { return envelope_.curvature(b, box) * b.sign(); };
  const auto curvature_of_hidden = [&](Index other) {
    if (const std::optional<Bound> wall = envelope_.wall_above(other, patch, box)) return curvature_of_side(*wall);
    return envelope_.curvature(patch, box) + envelope_.curvature(other, box) * Real(-1);
  };
  const auto least = [](Range r) { return r.low > 0 ? r.low : r.high < 0 ? -r.high : Real(0); };
  const auto largest = [](Range r) { return std::max(absolute(r.low), absolute(r.high)); };
  // True if some label other than `beside` hides the patch wherever g is below -across times the tolerance.
  const auto hides_beyond = [&](const Bound& b, const Function& g, Real across, Index beside) {
    across = std::max(across, norm(least(g.range.x), least(g.range.y)));
    for (const Turn& t : turns_) {
      if (t.after == none || t.after == beside) continue;
      const Function f = hidden_by(t.after);
      const Real k = multiple_along(f.gradient, g.gradient);
      if (!(k > 0) || !is_finite(f.value)) continue;  // the middle may be beyond a wall
      const Range factor{k, k};
      const GradientRange d{f.range.x - g.range.x * factor, f.range.y - g.range.y * factor};
      const Real middle = f.value - k * g.value, most = 2 * k * across * envelope_.tolerance();
      if (middle + largest(d.x) * box.half_x() + largest(d.y) * box.half_y() <= most) return true;
      if (!(middle < most)) continue;
      // Where the two are tangent in a higher order gradients tell less than what is beyond them.
      const Expansion hidden{f.value, f.gradient, curvature_of_hidden(t.after)}, beyond{g.value, g.gradient, curvature_of_side(b)};
      if ((hidden - beyond * k).most(box) <= most) return true;
    }
    return false;
  };
  for (const Bound& b : patches.bounds(patch)) {
    if (b.partner == none ? !b.rim : !is_seen(b.partner)) continue;
    if (hides_beyond(b, side(b), b.type == BoundType::disc ? 0 : 1, b.partner)) return true;
  }
  // At the foot of another one's wall, or beside it where that one rises above the patch only further inside.
  for (const Turn& t : turns_) {
    if (t.after == none) continue;
    const std::optional<WallBesideOf<Real>> wall = envelope_.wall_beside(t.after, patch, box);
    if (!wall || wall->inset > (t.meeting == Meeting::rim ? Real(0) : box.larger_side())) continue;
    Bound outside = wall->outline;
    outside.negative = !outside.negative;
    if (wall->inset == 0 && std::any_of(turns_.begin(), turns_.end(), [&](const Turn& other) {
          return other.after != none && other.after != t.after && envelope_.is_image(patch, other.after, outside, box);
        }))
      return true;
    if (wall->inset == 0 ? is_met_along_wall(patch, outside, t.after, box) : is_met_beside_wall(patch, t.after, box)) return true;
    const bool round = outside.type == BoundType::disc;
    Function g = side(outside);
    g.value = g.value - wall->inset * (round ? 2 * patches.radius() : Real(1));
    if (hides_beyond(outside, g, round ? 0 : 1, t.after)) return true;
  }
  return false;
}

/// True if a nearly vertical patch that shows nowhere around the cell rises above a label by less than matters, or not
/// at all, on its side of the seam to another: where a valley runs close beside the seam along a wall. As above, with
/// functions that are smooth there.
template <class Real>
bool Cells<Real>::is_hidden_beside_wall(Index patch, const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const Patch& p = patches[patch];
  const Point mid = box.middle();
  if (!is_upright(patch, mid)) return false;
  const Gradient axis = envelope_.rim_gradient(patch);
  const Real axis_height = p.z + axis.x * (mid.x - p.at.x) + axis.y * (mid.y - p.at.y);
  const auto largest = [](Range r) { return std::max(absolute(r.low), absolute(r.high)); };
  const auto spread = [&](const GradientRange& g) { return largest(g.x) * box.half_x() + largest(g.y) * box.half_y(); };
  const auto middle = [](Range r) { return (r.low + r.high) / 2; };
  const auto ranges = [](auto&& derivative) { return GradientRange{derivative({1, 0}), derivative({0, 1})}; };
  for (const Bound& b : patches.bounds(patch)) {
    if (b.type != BoundType::cone || b.partner == none || !is_seen(b.partner)) continue;
    // The plane of the circle has to be above the centre all over the box.
    const Range plane{-b.nx / b.c, -b.nx / b.c}, plane_y{-b.ny / b.c, -b.ny / b.c};
    const Real above = plane.low * (mid.x - b.at.x) + plane_y.low * (mid.y - b.at.y);
    if (!(above > spread({plane, plane_y}))) continue;
    const Real sign = (b.c > 0) == b.negative ? -1 : 1;  // negative on the patch's side
    const Real g = sign * envelope_.upright_value(b, mid);
    const GradientRange dg = ranges([&](Gradient d) { return envelope_.upright_derivative_range(b, box, d); });
    const Gradient slope{sign * middle(dg.x), sign * middle(dg.y)};
    for (const Turn& t : turns_) {
      if (t.after == none || t.after == b.partner) continue;
      const GradientRange rise = envelope_.gradient_range(t.after, box);
      const Real over = envelope_.clamped_height(t.after, mid) - axis_height -
                        spread({rise.x - Range{axis.x, axis.x}, rise.y - Range{axis.y, axis.y}});
      if (!(over > 0)) continue;
      const Real f = -envelope_.upright_value(patch, t.after, mid);
      const GradientRange df =
          ranges([&](Gradient d) { return envelope_.upright_derivative_range(patch, t.after, box, d); });
      const Real k = -(middle(df.x) * slope.x + middle(df.y) * slope.y) / (slope.x * slope.x + slope.y * slope.y);
      if (!(k > 0)) continue;
      const Range factor{sign * k, sign * k};
      const Real most = f - k * g + spread({df.x + dg.x * factor, df.y + dg.y * factor});
      const Real square = p.kind == FeatureKind::edge ? p.q * p.q : Real(1);
      if (most <= over / square * envelope_.thickness()) return true;
      // However tall, no line tells what is narrower than the last digit of a place.
      if (is_fine<Real> && most <= k * size(slope) * envelope_.tolerance() / 2) return true;
    }
  }
  return false;
}

template class Cells<double>;
template class Cells<DoubleDouble>;

}  // namespace krepl::terrain
