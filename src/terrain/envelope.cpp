#include "terrain/envelope.hpp"

#include <algorithm>

namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

template <class Real>
Envelope<Real>::Envelope(PatchSet<Real>& patches, double scale, SurfaceCounters& counters,
                         Envelope<DoubleDouble>* finer)
    : patches_(patches),
      tolerance_(Precision<Real>::tolerance * scale),
      smallest_cell_(Precision<Real>::smallest_cell * scale),
      fine_cell_((patches.radius() >= scale ? 0x1p-28 : 0x1p-20) * scale),
      smallest_stretch_(Precision<Real>::smallest_stretch * scale),
      noise_(Precision<Real>::noise * scale),
      rim_width_(2 * Precision<double>::tolerance * scale),
      least_up_(square_root(2 * patches.radius() * Precision<DoubleDouble>::tolerance * scale)),
      thickness_(0x1p-34 * scale),
      far_(patches.radius() >= scale),
      counters_(counters),
      finer_(finer) {}

template <class Real>
Envelope<DoubleDouble>* Envelope<Real>::finer(std::span<const Index> candidates, bool cells) const {
  if (finer_ == nullptr) return nullptr;
  if (cells)
    finer_->patches_.load_with_corners(candidates);
  else
    finer_->patches_.load(candidates);
  return finer_;
}

template <class Real>
Index Envelope<Real>::winner(Point p, std::span<const Index> candidates, bool finely) const {
  Index best = none;
  Real highest = below_everything, second = below_everything;
  counters_.height_evaluations += candidates.size();
  for (const Index c : candidates) {
    if (!patches_.contains(c, p)) continue;
    const Real h = patches_.extended_height(c, p);
    if (best == none || h > highest) {
      second = highest;
      highest = h;
      best = c;
    } else {
      second = std::max(second, h);
    }
  }
  if (best == none || second == below_everything) return best;
  // What rounding alone tells apart counts as equal: of coplanar triangles one over the other, both would show here and
  // there.
  const Real lowest = highest - 4 * noise_ * (1 + size(patches_.gradient(best, p)));
  if (second < lowest) return best;
  thread_local std::vector<Index> equal;
  equal.clear();
  for (const Index c : candidates) {
    if (patches_.contains(c, p) && patches_.extended_height(c, p) >= lowest) equal.push_back(c);
  }
  if (finely) return finer(equal)->winner({p.x, p.y}, equal);
  return *std::min_element(equal.begin(), equal.end(), [&](Index c, Index d) { return patches_.precedes(c, d); });
}

template <class Real>
Real Envelope<Real>::clamped_height(Index i, Point p) const {
  const Real h = patches_.extended_height(i, p);
  return h > below_everything ? h : rim_height(i, p);
}

template <class Real>
GradientOf<Real> Envelope<Real>::rim_gradient(Index i) const {
  const Patch& f = patches_[i];
  return f.kind == FeatureKind::edge ? Gradient{f.m * f.gx, f.m * f.gy} : Gradient{0, 0};
}

template <class Real>
Real Envelope<Real>::axis_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  return f.z + f.m * f.along(p);
}

template <class Real>
Real Envelope<Real>::rim_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::face)
    return patches_.extended_height(i, p);  // nearly vertical, the cylinder beside it too thin to show
  if (f.kind == FeatureKind::vertex) return f.z;
  return f.z + f.m * std::clamp(f.along(p), Real(0), f.length);
}

template <class Real>
Real Envelope<Real>::wall_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  if (f.kind != FeatureKind::edge) return rim_height(i, p);
  const Real along = f.along(p);
  if (along >= 0 && along <= f.length) return rim_height(i, p);
  const BoundSource source = along < 0 ? BoundSource::start : BoundSource::end;
  const auto bounds = patches_.bounds(i);
  const auto end = std::find_if(bounds.begin(), bounds.end(), [&](const Bound& b) { return b.source == source; });
  const bool is_round =
      end != bounds.end() && end->partner != none && patches_[end->partner].kind == FeatureKind::vertex;
  return is_round ? rim_height(i, p) : axis_height(i, p);
}

template <class Real>
const BoundOf<Real>* Envelope<Real>::rim_at(Index i, Point p) const {
  for (const Bound& b : patches_.bounds(i)) {
    if (!b.rim) continue;
    const Real value = absolute(b.value(p, patches_.square_radius()));
    if (value <= rim_width_ * (b.type == BoundType::disc ? 2 * patches_.radius() : 1)) return &b;
  }
  return nullptr;
}

template <class Real>
Real Envelope<Real>::border_height(Index i, Point p) const {
  return rim_at(i, p) != nullptr ? rim_height(i, p) : clamped_height(i, p);
}

template <class Real>
std::optional<Real> Envelope<Real>::straight_seam_height(Index a, Index b, Point p) const {
  if (a == none || b == none) return std::nullopt;
  if (patches_[a].kind != FeatureKind::edge) std::swap(a, b);
  const Patch &e = patches_[a], &f = patches_[b];
  if (e.kind != FeatureKind::edge || f.kind != FeatureKind::face) return std::nullopt;
  if (patches_.seam(a, b) == nullptr) return std::nullopt;
  return axis_height(a, p) + e.q * e.q * patches_.radius() * f.flat;
}

/// Gradient of a function that vanishes along the curve between two labels.
template <class Real>
GradientOf<Real> Envelope<Real>::gradient_across(Index a, Index b, Meeting how, Point p) const {
  if (how == Meeting::seam) {
    if (const Bound* side = patches_.seam(a, b)) return bound_gradient(*side, p);
  }
  if (how == Meeting::valley) {
    const Gradient g = patches_.gradient(a, p), h = patches_.gradient(b, p);
    return {g.x - h.x, g.y - h.y};
  }
  for (const Index l : {a, b}) {
    if (l == none) continue;
    if (const Bound* rim = rim_at(l, p)) return bound_gradient(*rim, p);
  }
  return {0, 0};
}

/// True if a place lies outside a wall of the patch: there may be a gap too narrow for lines to show between two walls.
template <class Real>
bool Envelope<Real>::is_beyond_wall(Index patch, Point p) const {
  const std::span<const Bound> sides = patches_.bounds(patch);
  return std::any_of(sides.begin(), sides.end(),
                     [&](const Bound& b) { return b.rim && b.sign() * b.value(p, patches_.square_radius()) > 0; });
}

/// Of two patches of which one ends in a wall at a place, or both in walls on one side (`of_a` and `of_b`, or null), the one
/// further in: true if the other patch is at least as high there, so that the two have met before. Nothing where walls stand
/// back to back.
template <class Real>
std::optional<bool> Envelope<Real>::meet_before_wall(Index a, const Bound* of_a, Index b, const Bound* of_b,
                                                     Point p) const {
  const Real square = patches_.square_radius();
  if (of_a != nullptr && of_b != nullptr) {
    const Gradient g = bound_gradient(*of_a, p), h = bound_gradient(*of_b, p);
    if (of_a->sign() * of_b->sign() * (g.x * h.x + g.y * h.y) <= 0) return std::nullopt;
  }
  for (const auto& [inner, wall, outer] : {std::tuple{a, of_a, b}, std::tuple{b, of_b, a}}) {
    if (wall == nullptr) continue;
    const Gradient g = bound_gradient(*wall, p);
    const Real step = wall->value(p, square) / (g.x * g.x + g.y * g.y);
    const Point foot{p.x - step * g.x, p.y - step * g.y};
    if (is_beyond_wall(outer, foot)) continue;
    const Gradient h = patches_.gradient(outer, foot);
    const Real over = clamped_height(outer, foot) - rim_height(inner, foot);
    // By no more than the inner one rises so near its wall: where walls cross, the outer one may be far above.
    const Patch& f = patches_[inner];
    const Real most = f.kind == FeatureKind::face ? Real(endless) : (f.kind == FeatureKind::edge ? f.q : Real(1)) * square_root(4 * patches_.radius() * rim_width_);
    return over >= -noise_ * (1 + norm(h.x, h.y)) && over <= most;
  }
  return std::nullopt;
}

template <class Real>
Meeting Envelope<Real>::meeting(Index a, Index b, Point p) const {
  if (a == none || b == none) return Meeting::rim;
  if (patches_.seam(a, b) != nullptr) return Meeting::seam;
  const Bound *of_a = rim_at(a, p), *of_b = rim_at(b, p);
  const bool a_ends = of_a != nullptr, b_ends = of_b != nullptr;
  const Real difference = border_height(a, p) - border_height(b, p);
  if (!a_ends && !b_ends) {
    // Heights that differ by more than they can beside a wall: a patch too thin to show lies between one of the two and
    // its wall.
    const Gradient g = patches_.gradient(a, p), h = patches_.gradient(b, p);
    const Real slack = 0x1p-14 * patches_.radius() + 64 * tolerance_ * norm(g.x - h.x, g.y - h.y);
    return absolute(difference) <= slack ? Meeting::valley : Meeting::rim;
  }
  if (is_fine<Real>) {
    if (const std::optional<bool> met = meet_before_wall(a, of_a, b, of_b, p)) return *met ? Meeting::valley : Meeting::rim;
  }
  // Just before its end a patch falls steeply: where the other one is higher than its rim, it has met that one before.
  if (a_ends != b_ends && (a_ends ? difference < 0 : difference > 0))
    return is_beyond_wall(a_ends ? b : a, p) ? Meeting::rim : Meeting::valley;
  const Gradient g = a_ends ? rim_gradient(a) : patches_.gradient(a, p),
                 h = b_ends ? rim_gradient(b) : patches_.gradient(b, p);
  return absolute(difference) <= 64 * tolerance_ * (1 + norm(g.x - h.x, g.y - h.y)) ? Meeting::valley : Meeting::rim;
}

template <class Real>
Index Envelope<Real>::upper_at_wall(Index a, Index b, Point p) const {
  const Real rise = border_height(b, p) - border_height(a, p);
  const bool a_ends = rim_at(a, p) != nullptr, b_ends = rim_at(b, p) != nullptr;
  const bool b_is_upper = a_ends != b_ends && absolute(rise) <= thickness_ ? b_ends : rise > 0;
  return b_is_upper ? b : a;
}

template <class Real>
GradientRangeOf<Real> Envelope<Real>::sphere_gradient(Point at, const Box& box, Real factor) const {
  const Range dx{box.low.x - at.x, box.high.x - at.x}, dy{box.low.y - at.y, box.high.y - at.y};
  const Real near_x = dx.low > 0    ? dx.low
                      : dx.high < 0 ? -dx.high
                                    : 0,
             far_x = std::max(absolute(dx.low), absolute(dx.high));
  const Real near_y = dy.low > 0    ? dy.low
                      : dy.high < 0 ? -dy.high
                                    : 0,
             far_y = std::max(absolute(dy.low), absolute(dy.high));
  const Real square = patches_.square_radius(), least = least_square * square;
  const Real most = square - (near_x * near_x + near_y * near_y), fewest = square - (far_x * far_x + far_y * far_y);
  const Range inverse{1 / square_root(std::max(least, most)), 1 / square_root(std::max(least, fewest))};
  const Range f{-factor, -factor};
  return {dx * inverse * f, dy * inverse * f};
}

/// Of the coordinate across an edge, left of its axis.
template <class Real>
RangeOf<Real> Envelope<Real>::aside_range(Index i, const Box& box, Where where) const {
  const Patch& f = patches_[i];
  const Point mid = box.middle();
  const Real aside = f.aside(mid);
  const Real spread = absolute(f.gx) * box.half_y() + absolute(f.gy) * box.half_x();
  Range r{aside - spread, aside + spread};
  if (where == Where::in_domain) {
    const std::span<const Bound> sides = patches_.bounds(i).first(2);  // the straight ones
    const Real low = std::min(sides[0].c, sides[1].c) - tolerance_,
               high = std::max(sides[0].c, sides[1].c) + tolerance_;
    r = {std::clamp(r.low, low, high), std::clamp(r.high, low, high)};
  }
  return r;
}

template <class Real>
RangeOf<Real> Envelope<Real>::slope_across(Index i, const Box& box, Where where) const {
  const Real square = patches_.square_radius(), least = least_square * square;
  const auto across = [&](Real beta) {
    return -patches_[i].q * beta / square_root(std::max(least, square - beta * beta));
  };
  const Range aside = aside_range(i, box, where);
  return {across(aside.high), across(aside.low)};
}

template <class Real>
GradientRangeOf<Real> Envelope<Real>::gradient_range(Index i, const Box& box, Where where) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::face) return {{f.gx, f.gx}, {f.gy, f.gy}};
  if (f.kind == FeatureKind::vertex) {
    const Box part = where == Where::in_domain ? box.intersection(patches_.box(i)) : box;
    return sphere_gradient(f.at, part.is_empty() ? box : part, 1);
  }
  const Range a = slope_across(i, box, where);
  const Range along{f.m * f.gx, f.m * f.gx}, along_y{f.m * f.gy, f.m * f.gy};
  return {along + a * Range{-f.gy, -f.gy}, along_y + a * Range{f.gx, f.gx}};
}

template <class Real>
RangeOf<Real> Envelope<Real>::derivative_range(Index i, const Box& box, Gradient d, Where where) const {
  const Patch& f = patches_[i];
  if (f.kind != FeatureKind::edge) {
    const GradientRange g = gradient_range(i, box, where);
    return g.x * Range{d.x, d.x} + g.y * Range{d.y, d.y};
  }
  const Real along = f.m * (f.gx * d.x + f.gy * d.y), aslant = d.y * f.gx - d.x * f.gy;
  return slope_across(i, box, where) * Range{aslant, aslant} + Range{along, along};
}

/// Of u = sqrt(R^2 - x^2 - y^2), at most the distance `far` from its middle. Along a line at distance d from there it is
/// sqrt(s^2 - t^2) with s^2 = R^2 - d^2, and has the third derivative -3 t s^2 / u^5.
template <class Real>
typename Envelope<Real>::Curvature Envelope<Real>::round_curvature(Real x, Real y, Real far) const {
  const Real square = patches_.square_radius(), up = square - x * x - y * y, least = square - far * far;
  if (!(up > 0 && least > 0)) return {0, 0, 0, endless};
  const Real cube = up * square_root(up);
  return {-(square - y * y) / cube, -x * y / cube, -(square - x * x) / cube, 3 * far * square / (least * least * square_root(least))};
}

template <class Real>
typename Envelope<Real>::Curvature Envelope<Real>::curvature(Index i, const Box& box) const {
  const Patch& f = patches_[i];
  const Point mid = box.middle();
  if (f.kind == FeatureKind::face) return {0, 0, 0, 0};
  if (f.kind == FeatureKind::vertex) {
    const Real x = mid.x - f.at.x, y = mid.y - f.at.y;
    return round_curvature(x, y, norm(absolute(x) + box.half_x(), absolute(y) + box.half_y()));
  }
  const Real aside = f.aside(mid), spread = absolute(f.gx) * box.half_y() + absolute(f.gy) * box.half_x();
  const Curvature across = round_curvature(0, aside, absolute(aside) + spread) * f.q;
  return {across.yy * (f.gy * f.gy), across.yy * (-f.gx * f.gy), across.yy * (f.gx * f.gx), across.third};
}

template <class Real>
typename Envelope<Real>::Curvature Envelope<Real>::curvature(const Bound& b, const Box& box) const {
  if (b.type == BoundType::line) return {0, 0, 0, 0};
  if (b.type == BoundType::disc) return {2, 0, 2, 0};
  const Point mid = box.middle();
  const Real x = mid.x - b.at.x, y = mid.y - b.at.y;
  return round_curvature(x, y, norm(absolute(x) + box.half_x(), absolute(y) + box.half_y())) * b.c;
}

template <class Real>
RangeOf<Real> Envelope<Real>::upright_derivative_range(Index i, Index other, const Box& box, Gradient d) const {
  const Patch& f = patches_[i];
  const Point mid = box.middle();
  const Gradient axis = rim_gradient(i);
  const Real q = f.kind == FeatureKind::edge ? f.q : Real(1), dx = mid.x - f.at.x, dy = mid.y - f.at.y;
  const GradientRange g = gradient_range(other, box);
  const auto largest = [](Range r) { return std::max(absolute(r.low), absolute(r.high)); };
  const Real spread =
      largest(g.x - Range{axis.x, axis.x}) * box.half_x() + largest(g.y - Range{axis.y, axis.y}) * box.half_y();
  const Real level = clamped_height(other, mid) - (f.z + axis.x * dx + axis.y * dy);
  const Real rise = axis.x * d.x + axis.y * d.y;
  const Range inverse{1 / q, 1 / q}, over = Range{level - spread, level + spread} * inverse;
  const Range slope = (derivative_range(other, box, d) - Range{rise, rise}) * inverse;
  if (f.kind != FeatureKind::edge) {
    const Real along = dx * d.x + dy * d.y, reach = absolute(d.x) * box.half_x() + absolute(d.y) * box.half_y();
    return Range{along - reach, along + reach} + over * slope;
  }
  const Real aside = dy * f.gx - dx * f.gy, reach = absolute(f.gx) * box.half_y() + absolute(f.gy) * box.half_x();
  const Real across = d.y * f.gx - d.x * f.gy;
  return Range{aside - reach, aside + reach} * Range{across, across} + over * slope;
}

template <class Real>
RangeOf<Real> Envelope<Real>::upright_derivative_range(const Bound& b, const Box& box, Gradient d) const {
  const Point mid = box.middle();
  const Real dx = mid.x - b.at.x, dy = mid.y - b.at.y, along = dx * d.x + dy * d.y, over = dx * b.nx + dy * b.ny;
  const Real reach = absolute(d.x) * box.half_x() + absolute(d.y) * box.half_y();
  const Real spread = absolute(b.nx) * box.half_x() + absolute(b.ny) * box.half_y();
  const Real slope = (b.nx * d.x + b.ny * d.y) / (b.c * b.c);
  return Range{along - reach, along + reach} + Range{over - spread, over + spread} * Range{slope, slope};
}

template <class Real>
Real Envelope<Real>::upright_value(Index i, Index other, Point p) const {
  const Patch& f = patches_[i];
  const Gradient axis = rim_gradient(i);
  const Real q = f.kind == FeatureKind::edge ? f.q : Real(1), dx = p.x - f.at.x, dy = p.y - f.at.y;
  const Real over = (clamped_height(other, p) - (f.z + axis.x * dx + axis.y * dy)) / q;
  const Real aside = dy * f.gx - dx * f.gy;
  const Real square = f.kind == FeatureKind::edge ? aside * aside : dx * dx + dy * dy;
  return (square + over * over - patches_.square_radius()) / 2;
}

template <class Real>
Real Envelope<Real>::upright_value(const Bound& b, Point p) const {
  const Real dx = p.x - b.at.x, dy = p.y - b.at.y, over = (dx * b.nx + dy * b.ny) / b.c;
  return (dx * dx + dy * dy + over * over - patches_.square_radius()) / 2;
}

template <class Real>
GradientOf<Real> Envelope<Real>::bound_gradient(const Bound& b, Point p) const {
  const Real dx = p.x - b.at.x, dy = p.y - b.at.y;
  if (b.type == BoundType::line) return {b.nx, b.ny};
  if (b.type == BoundType::disc) return {2 * dx, 2 * dy};
  const Real square = patches_.square_radius();
  const Real up = square_root(std::max(least_square * square, square - (dx * dx + dy * dy)));
  return {b.nx - b.c * dx / up, b.ny - b.c * dy / up};
}

template <class Real>
GradientRangeOf<Real> Envelope<Real>::bound_gradient_range(const Bound& b, const Box& box) const {
  if (b.type == BoundType::line) return {{b.nx, b.nx}, {b.ny, b.ny}};
  if (b.type == BoundType::disc) {
    return {{2 * (box.low.x - b.at.x), 2 * (box.high.x - b.at.x)},
            {2 * (box.low.y - b.at.y), 2 * (box.high.y - b.at.y)}};
  }
  const GradientRange s = sphere_gradient(b.at, box, b.c);
  return {s.x + Range{b.nx, b.nx}, s.y + Range{b.ny, b.ny}};
}

template class Envelope<double>;
template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
