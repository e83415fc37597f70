#include <algorithm>

#include "terrain/cells.hpp"

// What touches without crossing: functions of places up to second derivatives, third ones being bounded.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

/// At least the greatest value over the box.
template <class Real>
Real Cells<Real>::Expansion::most(const Box& box) const {
  const Real hx = box.half_x(), hy = box.half_y(), half = norm(hx, hy);
  const Real bend = absolute(curvature.xx) * hx * hx + 2 * absolute(curvature.xy) * hx * hy + absolute(curvature.yy) * hy * hy;
  return value + absolute(gradient.x) * hx + absolute(gradient.y) * hy + bend / 2 + curvature.third * half * half * half / 6;
}

/// Of the heights of a patch's whole plane, cylinder or sphere; with infinite bounds beside a wall.
template <class Real>
typename Cells<Real>::Expansion Cells<Real>::height_expansion(Index patch, const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const Point mid = box.middle();
  return {patches.extended_height(patch, mid), patches.gradient(patch, mid), envelope_.curvature(patch, box)};
}

template <class Real>
typename Cells<Real>::Expansion Cells<Real>::side_expansion(const Bound& side, const Box& box) const {
  const Point mid = box.middle();
  return {side.value(mid, envelope_.patches().square_radius()), envelope_.bound_gradient(side, mid), envelope_.curvature(side, box)};
}

/// Of Envelope::upright_value, half of a^2 + b^2 - R^2 with a the distance from the axis of a cylinder or sphere and b the other
/// patch's height over that: positive where the other one is outside, and smooth beside the wall of the first. Nothing if the
/// other one is steep itself, or not above the axis all over the box.
template <class Real>
std::optional<typename Cells<Real>::Expansion> Cells<Real>::upright_expansion(Index round, Index other, const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const Patch& p = patches[round];
  if (p.kind == FeatureKind::face) return std::nullopt;
  const Point mid = box.middle();
  const Real half = norm(box.half_x(), box.half_y()), q = p.kind == FeatureKind::edge ? p.q : Real(1);
  const auto bend = envelope_.curvature(other, box) * (1 / q);
  if (!is_finite(bend.third)) return std::nullopt;
  const Gradient axis = envelope_.rim_gradient(round), slope = patches.gradient(other, mid);
  const Gradient rise{(slope.x - axis.x) / q, (slope.y - axis.y) / q};
  const Real dx = mid.x - p.at.x, dy = mid.y - p.at.y;
  const Real over = (patches.extended_height(other, mid) - (p.z + axis.x * dx + axis.y * dy)) / q;
  // Over all of the box.
  const Real most_bend = norm(norm(bend.xx, bend.yy), norm(bend.xy, bend.xy)) + bend.third * half;
  const Real most_rise = size(rise) + most_bend * half, most_over = over + most_rise * half;
  if (!(over > most_rise * half)) return std::nullopt;
  // Of half of a^2: all directions for a sphere, across the axis for a cylinder.
  const bool is_ball = p.kind == FeatureKind::vertex;
  const Real aside = p.aside(mid);
  const Gradient out = is_ball ? Gradient{dx, dy} : Gradient{-aside * p.gy, aside * p.gx};
  const Real xx = is_ball ? Real(1) : p.gy * p.gy, xy = is_ball ? Real(0) : -p.gx * p.gy, yy = is_ball ? Real(1) : p.gx * p.gx;
  return Expansion{envelope_.upright_value(round, other, mid),
                   {over * rise.x + out.x, over * rise.y + out.y},
                   {rise.x * rise.x + over * bend.xx + xx, rise.x * rise.y + over * bend.xy + xy,
                    rise.y * rise.y + over * bend.yy + yy, 3 * most_rise * most_bend + most_over * bend.third}};
}

namespace {

/// True if f is below zero wherever g is, but for a strip beside the curve along which g vanishes, not wider than that.
template <class Expansion, class Box, class Real>
bool is_below(const Expansion& f, const Expansion& g, const Box& box, Real width) {
  const Real k = multiple_along(f.gradient, g.gradient);
  return k > 0 && (f - g * k).most(box) <= k * size(g.gradient) * width;
}

}  // namespace

/// True if a cylinder or sphere lies below a label, but `behind`, wherever it is outside of a wall, its side of which is given, but
/// for less than is told apart: both may be tangent to that.
template <class Real>
bool Cells<Real>::is_met_along_wall(Index patch, const Bound& wall, Index behind, const Box& box) const {
  const Expansion g = side_expansion(wall, box) * wall.sign();
  return std::any_of(turns_.begin(), turns_.end(), [&](const Turn& t) {
    if (t.after == none || t.after == behind) return false;
    const std::optional<Expansion> outside = upright_expansion(patch, t.after, box);
    // Twice: lines round what they leave out.
    return outside && is_below(*outside * Real(-1), g, box, 2 * envelope_.tolerance());
  });
}

/// The same of a patch outside of another one beside the wall of that, where both are tangent to the valley there.
template <class Real>
bool Cells<Real>::is_met_beside_wall(Index patch, Index upper, const Box& box) const {
  const std::optional<Expansion> above = upright_expansion(upper, patch, box);
  if (!above) return false;
  const Expansion own = height_expansion(patch, box);
  return std::any_of(turns_.begin(), turns_.end(), [&](const Turn& t) {
    if (t.after == none || t.after == upper) return false;
    const Expansion other = height_expansion(t.after, box);
    return is_finite(other.value) && is_finite(other.curvature.third) &&
           is_below(own - other, *above * Real(-1), box, 2 * envelope_.tolerance());
  });
}

/// True if the functions that vanish along the curves of two turns, of which neither ends in the box, differ but for a factor by
/// something that is zero nowhere: however near to each other the curves are.
template <class Real>
bool Cells<Real>::are_apart_by_expansion(const Turn& s, const Turn& t, const Box& box) const {
  const auto function = [&](const Turn& turn) -> std::optional<Expansion> {
    if (turn.meeting == Meeting::valley) return height_expansion(turn.before, box) - height_expansion(turn.after, box);
    const Bound* side = side_along(turn);
    return side == nullptr ? std::nullopt : std::optional(side_expansion(*side, box));
  };
  const std::optional<Expansion> f = function(s), g = function(t);
  if (!f || !g || !is_finite(f->curvature.third) || !is_finite(g->curvature.third)) return false;
  const Real k = multiple_along(f->gradient, g->gradient);
  if (!is_finite(k) || k == 0) return false;
  const Expansion d = *f - *g * k;
  const Real noise = envelope_.noise() * (1 + size(f->gradient));
  return d.most(box) < -noise || (d * Real(-1)).most(box) < -noise;
}

template class Cells<double>;
template class Cells<DoubleDouble>;

}  // namespace krepl::terrain
