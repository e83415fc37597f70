#include <algorithm>

#include "terrain/cells.hpp"

// Where vertices lie that are known without following curves that are tangent, and how high each vertex is.
namespace krepl::terrain {

/// The corner at which a patch's sides end that bound it at two turns in a row, if it lies close to p. Where the two
/// are tangent, the patch is too thin to show for a stretch beyond its corner. The same if the patch's own wall runs in
/// the foot of a higher one that passes the corner, too, or if a side of it comes out from under a higher wall there.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::corner_beside(Point p) const {
  const PatchSet<Real>& patches = envelope_.patches();
  std::optional<Point> nearest;
  Real steepest = 1;
  for (const Turn& t : turns_) {
    if (t.after != none && patches[t.after].kind != Terrain::FeatureKind::face)
      steepest = std::max(steepest, patches[t.after].q);
  }
  // Sides that part like circles with slopes between them are so close together for that long; a face's are straight.
  const Real beside_wall = 4 * steepest * square_root(patches.radius() * envelope_.rim_width());
  Real least = std::max(0x1p-12 * patches.radius(), beside_wall);
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    const Turn &from = turns_[i], &to = turns_[(i + 1) % turns_.size()];
    const Index patch = from.after;
    if (patch == none || from.before == to.after) continue;
    const auto is_at_foot = [&](const Turn& t) { return t.meeting == Meeting::rim && !is_wall_of(t, patch); };
    const auto is_valley = [&](const Turn& t) { return t.meeting == Meeting::valley; };
    // A valley may run beside the patch's wall from the corner on.
    const auto own_side = [&](const Turn& t) {
      return is_at_foot(t) || is_valley(t) ? envelope_.rim_at(patch, t.at) : side_along(t);
    };
    const Bound *a = own_side(from), *b = own_side(to);
    // A side that comes out from under a higher wall.
    const bool out_of_foot = is_at_foot(from) != is_at_foot(to);
    if (out_of_foot && (a == nullptr || b == nullptr)) a = b = is_at_foot(from) ? b : a;
    if (a == nullptr || b == nullptr || (a == b && !out_of_foot)) continue;
    for (const Point c : patches.corners(patch)) {
      const Real apart = norm(c.x - p.x, c.y - p.y);
      const auto ends = [&](const Bound& side) {
        const Gradient g = envelope_.bound_gradient(side, c);
        return absolute(side.value(c, patches.square_radius())) <= 4 * envelope_.tolerance() * (1 + norm(g.x, g.y));
      };
      const auto passes = [&](const Turn& t) {
        if (is_valley(t)) {
          const Index other = t.before == patch ? t.after : t.before;
          const Real off = envelope_.clamped_height(other, c) - envelope_.rim_height(patch, c);
          return apart < beside_wall && absolute(off) <= 4 * envelope_.tolerance() * (1 + size(patches.gradient(other, c)));
        }
        if (!is_at_foot(t)) return true;
        const Bound* wall = side_along(t);
        return wall != nullptr && ends(*wall);
      };
      if (apart < least && ends(*a) && ends(*b) && passes(from) && passes(to)) least = apart, nearest = c;
    }
  }
  return nearest;
}

/// Where two edges' walls along one straight line are equally high. Nothing where they are so all along.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::level_along(const Bound& wall, Index first, Index second, Point near) const {
  const Gradient g = envelope_.bound_gradient(wall, near), r = envelope_.rim_gradient(first),
                 s = envelope_.rim_gradient(second);
  const Real size_of_g = size(g), off = wall.value(near, envelope_.patches().square_radius()) / size_of_g;
  const Gradient across{g.x / size_of_g, g.y / size_of_g}, along{-across.y, across.x};
  const Point foot{near.x - off * across.x, near.y - off * across.y};
  const Real rise = (r.x - s.x) * along.x + (r.y - s.y) * along.y;
  if (absolute(rise) < 0x1p-16) return std::nullopt;
  const Real step = (envelope_.axis_height(first, foot) - envelope_.axis_height(second, foot)) / rise;
  return Point{foot.x - step * along.x, foot.y - step * along.y};
}

/// Where two edges' walls stand back to back along a line in the box, and take turns in being the higher one.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::change_of_upper_wall(const Turn& s, const Turn& t, const Box& box) const {
  if (s.meeting != Meeting::rim || s.before == none || s.after == none) return std::nullopt;
  const auto [upper, lower] = sides_of_wall(s);
  const PatchSet<Real>& patches = envelope_.patches();
  if (sides_of_wall(t).first != lower || patches[upper].kind != Terrain::FeatureKind::edge ||
      patches[lower].kind != Terrain::FeatureKind::edge)
    return std::nullopt;
  for (const Index l : {upper, lower}) {
    for (const Point p : {s.at, t.at}) {
      const Bound* wall = envelope_.rim_at(l, p);
      if (wall == nullptr || wall->type != BoundType::line) return std::nullopt;
    }
  }
  const std::optional<Point> p = level_along(*envelope_.rim_at(upper, s.at), upper, lower, s.at);
  return p && box.contains(*p) ? p : std::nullopt;
}

/// Where two walls in one line that meet in a valley are equally high, if that is close to p: the valley is tangent to
/// them.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::level_of_walls(Point p) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const Real least = 0x1p-12 * patches.radius();
  const auto wall_of = [&](Index label) -> const Bound* {
    for (const Turn& t : turns_) {
      if (is_wall_of(t, label)) return side_along(t);
    }
    return nullptr;
  };
  for (const Turn& t : turns_) {
    if (t.meeting != Meeting::valley) continue;
    if (patches[t.before].kind != Terrain::FeatureKind::edge || patches[t.after].kind != Terrain::FeatureKind::edge)
      continue;
    const Bound *a = wall_of(t.before), *b = wall_of(t.after);
    if (a == nullptr || b == nullptr || a->type != BoundType::line || b->type != BoundType::line) continue;
    const std::optional<Point> q = level_along(*a, t.before, t.after, p);
    if (!q || norm(q->x - p.x, q->y - p.y) >= least) continue;
    const Real apart = b->value(*q, patches.square_radius()) / size(envelope_.bound_gradient(*b, *q));
    if (absolute(apart) <= 4 * envelope_.tolerance()) return q;
  }
  return std::nullopt;
}

/// Where two balls about vertices of one height touch.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::touch_of_balls(Index a, Index b) const {
  if (a == none || b == none || a == b) return std::nullopt;
  const PatchSet<Real>& patches = envelope_.patches();
  const Patch &f = patches[a], &g = patches[b];
  if (f.kind != Terrain::FeatureKind::vertex || g.kind != Terrain::FeatureKind::vertex) return std::nullopt;
  const Real rounding = 0x1p-50 * patches.radius();
  const Real apart = norm(g.at.x - f.at.x, g.at.y - f.at.y) - 2 * patches.radius();
  if (absolute(f.z - g.z) > rounding || absolute(apart) > rounding) return std::nullopt;
  return Point{(f.at.x + g.at.x) / 2, (f.at.y + g.at.y) / 2};
}

/// So far from there what runs between the two may be too thin to show: it is as wide as the square of that.
template <class Real>
Real Cells<Real>::reach_of_touch() const {
  return 4 * square_root(envelope_.patches().radius() * envelope_.rim_width());
}

template <class Real>
std::optional<PointOf<Real>> Cells<Real>::touch_of_balls_beside(Point p) const {
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::optional<Point> touch = touch_of_balls(turns_[i].after, turns_[j].after);
      if (touch && norm(touch->x - p.x, touch->y - p.y) < reach_of_touch()) return touch;
    }
  }
  return std::nullopt;
}

/// The place close to p that is known without following curves that are tangent, or p.
template <class Real>
PointOf<Real> Cells<Real>::known_beside(Point p) const {
  if (const std::optional<Point> corner = corner_beside(p)) return *corner;
  if (const std::optional<Point> touch = touch_of_balls_beside(p)) return *touch;
  return level_of_walls(p).value_or(p);
}

/// Height of a label at a place around which are all turns. Near the rim heights fall like square roots; the rim's own height is as
/// near to the surface.
template <class Real>
Real Cells<Real>::label_height(Index label, Point at) const {
  const bool ends = std::any_of(turns_.begin(), turns_.end(), [&](const Turn& wall) { return is_wall_of(wall, label); });
  return ends ? envelope_.wall_height(label, at) : envelope_.border_height(label, at);
}

/// Height of such a place: of the highest label there.
template <class Real>
Real Cells<Real>::vertex_height(Point at) const {
  constexpr double least_steep = 64;
  Real z = below_everything;
  bool is_steep = false;
  for (const Turn& t : turns_) {
    if (t.after == none) continue;
    z = std::max(z, label_height(t.after, at));
    const Patch& p = envelope_.patches()[t.after];
    is_steep = is_steep || (p.kind == Terrain::FeatureKind::face && p.q > least_steep);
  }
  return is_steep ? height_beside_steep_face(at) : z;
}

/// The same where heights of faces hang on the last digits of the place: what is equally high but for that, and less steep, is known
/// better.
template <class Real>
Real Cells<Real>::height_beside_steep_face(Point at) const {
  const PatchSet<Real>& patches = envelope_.patches();
  const Real noise = 0x1p-10 * envelope_.thickness();  // 2^-44 S: of doubles, as what is written is rounded to these
  const auto rounding = [&](Real slope) { return std::min(noise * (1 + slope), Real(0x1p-20) * patches.radius()); };
  struct Reading {
    Real z, slope;
  };
  const auto reading = [&](std::size_t i) {
    const Index label = turns_[i].after;
    Real z = label_height(label, at), slope = size(patches.gradient(label, at));
    // Along a straight seam the line is as high as the patches on both sides.
    for (const Turn& t : {turns_[i], turns_[(i + 1) % turns_.size()]}) {
      const std::optional<Real> on_seam = envelope_.straight_seam_height(t.before, t.after, at);
      if (on_seam && absolute(*on_seam - z) <= rounding(slope)) z = *on_seam, slope = 0;
    }
    return Reading{z, patches[label].kind == Terrain::FeatureKind::face ? slope : Real(0)};
  };
  std::vector<Reading> readings;
  Reading highest{below_everything, 0};
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    if (turns_[i].after == none) continue;
    readings.push_back(reading(i));
    if (readings.back().z > highest.z) highest = readings.back();
  }
  Reading best = highest;
  for (const Reading& r : readings) {
    if (r.slope < best.slope && highest.z - r.z <= rounding(highest.slope)) best = r;
  }
  return best.z;
}

template <class Real>
void Cells<Real>::add_vertex(Point at) {
  arms_.clear();
  for (const Turn& t : turns_) arms_.push_back(Link::crossing(t.crossing, t.side));
  map_.add_vertex({double(at.x), double(at.y), double(vertex_height(at))}, arms_);
}

template class Cells<double>;
template class Cells<DoubleDouble>;

}  // namespace krepl::terrain
