#include <algorithm>

#include "terrain/box_frame.hpp"
#include "terrain/clip_polygon.hpp"

// Features that hide others by the way the two lie to each other: side by side, above one another.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

template <class Real>
bool Envelope<Real>::are_coplanar(Index a, Index b, const Box& box) const {
  const Patch &f = patches_[a], &g = patches_[b];
  if (f.kind != FeatureKind::face || g.kind != FeatureKind::face) return false;
  const Point mid = box.middle();
  const Real dx = absolute(f.gx - g.gx), dy = absolute(f.gy - g.gy);
  const Real apart = absolute(patches_.extended_height(a, mid) - patches_.extended_height(b, mid));
  return apart + dx * box.half_x() + dy * box.half_y() <= noise_;
}

/// True if a face or edge that may be equally high as another one counts as seen then, and reaches into the box by more than is
/// told apart.
template <class Real>
bool Envelope<Real>::shows_first(Index i, Index other, const BoxFrame& box) const {
  const bool are_faces = patches_[i].kind == FeatureKind::face && patches_[other].kind == FeatureKind::face;
  const bool overlap = patches_[i].overlaps && patches_[other].overlaps && patches_.seam(i, other) != nullptr;
  if (!(are_faces || overlap) || !patches_.precedes(i, other)) return false;
  const std::span<const Bound> sides = patches_.bounds(i);
  return std::all_of(sides.begin(), sides.end(), [&](const Bound& b) {
    return (b.negative ? extreme<1>(b, box) : extreme<-1>(b, box)) < -tolerance_;
  });
}

/// Two edges that run beside or above each other, as seen from above. With u(b) = sqrt(R^2 - b^2) for the distance b
/// from one axis and b + e from the other, and s between b / u(b) at the two, their heights differ by
///   level + (q_k - q_c) u(b) + q_c e s,
/// where level and e are linear in the place. `least_up`, `most_up`: of u; what shows nearer to the wall does not matter,
/// nor what is farther from it. `allowed`: by how much the lower one may be higher.
template <class Real>
bool Envelope<Real>::hidden_beside(Index lower, Index upper, const BoxFrame& frame, Real least_up, Real allowed,
                                   Real most_up) const {
  const Patch &c = patches_[lower], &k = patches_[upper];
  if (c.kind != FeatureKind::edge || k.kind != FeatureKind::edge) return false;
  if (absolute(c.gx * k.gy - c.gy * k.gx) > 0x1p-8) return false;
  const Real turn = c.gx * k.gx + c.gy * k.gy > 0 ? 1 : -1;
  const Real farthest = 0x1p-4 * patches_.radius();
  if (absolute(turn * c.aside(frame.mid) - k.aside(frame.mid)) > farthest) return false;
  const std::array<Point, 4> corner = frame.box.corners();
  Real apart[4], widest = 0;
  for (int i = 0; i < 4; ++i) {
    apart[i] = turn * c.aside(corner[i]) - k.aside(corner[i]);
    widest = std::max(widest, absolute(apart[i]));
  }
  if (widest > farthest) return false;
  const Real beta = k.aside(frame.mid), square = patches_.square_radius();
  const Real spread = absolute(k.gx) * frame.hy + absolute(k.gy) * frame.hx;
  const Real near = std::max(Real(0), absolute(beta) - spread), far = absolute(beta) + spread;
  Real up[2] = {square_root(std::max(Real(0), square - far * far)),
                square_root(std::max(Real(0), square - near * near))};
  // Where the lower one is nearer to its wall all over the box, it falls the faster the nearer: the least slope is enough.
  const bool inwards = std::all_of(apart, apart + 4, [&](Real e) { return beta > 0 ? e >= 0 : e <= 0; });
  Real slope[2] = {0, 0}, slack = 0;  // slack: by how much u may differ between the two
  // However little the lower one's wall is beyond the upper one's, what is beyond may be tall.
  if (!is_fine<Real> && !inwards && widest > noise_ && widest <= tolerance_ / 4 && far + widest >= patches_.radius())
    return false;
  if (widest > tolerance_ / 4) {
    const Real low = beta - spread - widest, high = beta + spread + widest;
    if (std::max(-low, high) < patches_.radius()) {
      slope[0] = low / square_root(square - low * low);
      slope[1] = high / square_root(square - high * high);
      slack = widest * std::max(absolute(slope[0]), absolute(slope[1]));
    } else if (!inwards || absolute(beta) <= spread) {
      return false;
    } else {
      slope[0] = slope[1] = (beta > 0 ? near : -near) / square_root(square - near * near);
      slack = square_root(2 * patches_.radius() * widest);
    }
  }
  // A ball touches the lower edge between its ends: that tells how high it can be above the axis there.
  Real lowest = least_up, first = 0, last = 0;
  const Real lean = c.m * c.flat;
  if (c.m != 0) {
    const Real a[4] = {c.along(corner[0]), c.along(corner[1]), c.along(corner[2]), c.along(corner[3])};
    first = std::min({a[0], a[1], a[2], a[3]}), last = std::max({a[0], a[1], a[2], a[3]});
    lowest = std::max(lowest, (c.m > 0 ? -last : first - c.length) / absolute(lean) - slack);
    for (Real& u : up) u = std::min(u, (c.m > 0 ? c.length - first : last) / absolute(lean) + slack);
  }
  for (Real& u : up) u = std::max(std::min(u, most_up), lowest);
  for (const Bound& b : patches_.bounds(upper)) {
    if (b.type != BoundType::cone) continue;
    // The same of the sphere about that end, which is lower than the cylinder.
    Range along{endless, -endless};
    for (const Point p : corner) {
      const Real t = (p.x - b.at.x) * k.gx + (p.y - b.at.y) * k.gy;
      along = {std::min(along.low, t), std::max(along.high, t)};
    }
    const Real farthest_along = std::max(-along.low, along.high), nearest_along = std::max({Real(0), along.low, -along.high});
    const auto on_sphere = [](Real u, Real t) { return square_root(std::max(Real(0), u * u - t * t)); };
    if (!is_within(b, frame, std::max(least_up, on_sphere(up[0], farthest_along)), on_sphere(up[1], nearest_along))) return false;
  }
  const auto is_enough = [&](Real over) {
    return over > noise_ || (allowed > 0 && over >= -allowed) || (over >= -noise_ && patches_.precedes(upper, lower));
  };
  const Real rise = k.q - c.q;
  Real level[4];
  for (int i = 0; i < 4; ++i) level[i] = axis_height(upper, corner[i]) - axis_height(lower, corner[i]);
  const auto is_hidden_at = [&](int i) {
    return std::all_of(slope, slope + 2, [&](Real s) {
      return std::all_of(up, up + 2, [&](Real u) { return is_enough(level[i] + rise * u + c.q * apart[i] * s); });
    });
  };
  if (is_hidden_at(0) && is_hidden_at(1) && is_hidden_at(2) && is_hidden_at(3)) return true;
  if (c.m == 0) return false;
  // Near a wall both grow with the distance from a vertex: what is touched tells how they do so together.
  struct Place {
    Real along, up;
  };
  std::vector<Place> part{{first, up[0]}, {last, up[0]}, {last, up[1]}, {first, up[1]}};
  const Real growth = k.m * (k.gx * c.gx + k.gy * c.gy) - c.m, beyond = absolute(lean) * slack;
  Real level_off = endless, aside_off = endless;  // least of the level but for that growth, and of the last term
  for (int i = 0; i < 4; ++i) {
    level_off = std::min(level_off, level[i] - growth * c.along(corner[i]));
    for (const Real s : slope) aside_off = std::min(aside_off, c.q * apart[i] * s);
  }
  for (const Real sign : {Real(1), Real(-1)}) {
    clip_polygon(part, [&](const Place& p) {
      const Real touched = p.along + lean * p.up;
      return (sign > 0 ? touched - c.length : -touched) - beyond;
    });
  }
  return std::all_of(part.begin(), part.end(), [&](const Place& p) {
    return is_enough(level_off + growth * p.along + rise * p.up + aside_off);
  });
}

/// True if no point of the lower patch lies above the upper one's plane, however tangent to it: with N the plane's normal and
/// the ball's centre at a + R n, n a unit normal of an edge along d, N.a + R N.n is at most N.a + R sqrt(1 - (N.d)^2).
template <class Real>
bool Envelope<Real>::hidden_below_face(Index lower, Index upper, const BoxFrame& frame) const {
  const Patch &c = patches_[lower], &k = patches_[upper];
  if (k.kind != FeatureKind::face || c.kind == FeatureKind::face) return false;
  Real most = 1;  // of N.n
  if (c.kind == FeatureKind::edge) {
    const Real x = k.gy * c.m + c.gy, y = c.gx + k.gx * c.m, z = k.gy * c.gx - k.gx * c.gy;  // N x d
    most = square_root(x * x + y * y + z * z) * (k.flat * c.flat);
  }
  const Real reach = most * patches_.radius() * k.q, slack = noise_ * k.q;
  const auto above = [&](Point p, Real z) {
    return z + reach - (k.z + k.gx * (p.x - k.at.x) + k.gy * (p.y - k.at.y)) > slack;
  };
  if (above(c.at, c.z)) return false;
  if (c.kind == FeatureKind::edge && above(c.end(), c.end_z())) return false;
  return domain_covers(upper, frame);
}

/// True if the lower patch's feature lies in the upper one's or straight below it, and is no part of its border: then so does
/// all that a ball touches with it.
template <class Real>
bool Envelope<Real>::lies_in(Index lower, Index upper) const {
  const Patch &c = patches_[lower], &k = patches_[upper];
  if (c.kind == FeatureKind::face || c.kind > k.kind || k.kind == FeatureKind::vertex) return false;
  const Real tolerance = tolerance_ / 4;
  const Point a = c.at, b = c.end();
  const Real top_a = c.z, top_b = c.end_z();
  if (k.kind == FeatureKind::edge) {
    const auto holds = [&](Point p, Real z) {
      const Real t = k.along(p);
      return absolute(k.aside(p)) <= tolerance && t >= -tolerance &&
             t <= k.length + tolerance && z <= k.z + k.m * t + noise_;
    };
    if (c.kind == FeatureKind::vertex) return holds(a, top_a) && k.along(a) > tolerance_ && k.along(a) < k.length - tolerance_;
    return c.length < k.length - tolerance_ && holds(a, top_a) && holds(b, top_b);
  }
  // A face's patch is the face itself, moved by R along its normal.
  const Real rise = patches_.radius() * k.flat;
  const auto holds = [&](Point p, Real z, Real margin) {
    if (z > k.z - rise + k.gx * (p.x - k.at.x - k.gx * rise) + k.gy * (p.y - k.at.y - k.gy * rise) + noise_ * k.q) return false;
    for (const Bound& side : patches_.bounds(upper)) {
      if (side.sign() * side.value({p.x - k.gx * rise, p.y - k.gy * rise}, 0) > -margin) return false;
    }
    return true;
  };
  if (c.kind == FeatureKind::vertex) return holds(a, top_a, tolerance_);
  const Point middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
  return holds(middle, (top_a + top_b) / 2, tolerance_) && holds(a, top_a, -tolerance) && holds(b, top_b, -tolerance);
}

template <class Real>
bool Envelope<Real>::is_image(Index image, Index original, const Bound& plane, const Box& box) const {
  const Patch &c = patches_[image], &k = patches_[original];
  if (plane.type != BoundType::line || k.kind == FeatureKind::face || c.kind > k.kind) return false;
  const Real tolerance = tolerance_ / 4;
  // True if q is the image of a place of the original on the negative side.
  const auto has_original = [&](const Vector& q) {
    const Real value = plane.value({q.x, q.y}, 0), twice = 2 * value, z = q.z;
    const Point p{q.x - twice * plane.nx, q.y - twice * plane.ny};
    if (plane.sign() * value < -tolerance) return false;
    if (k.kind == FeatureKind::vertex) return norm(p.x - k.at.x, p.y - k.at.y) <= tolerance && absolute(k.z - z) <= noise_;
    const Real along = k.along(p);
    return absolute(k.aside(p)) <= tolerance && along >= -tolerance && along <= k.length + tolerance &&
           absolute(axis_height(original, p) - z) <= noise_ * k.q;
  };
  Vector place[2];
  const std::size_t count = contacts(image, box, place);
  return std::all_of(place, place + count, has_original);
}

/// True if one of the upper features hides the patch by the way the two lie to each other.
template <class Real>
bool Envelope<Real>::hidden_by_feature(Index lower, std::span<const Index> uppers, const BoxFrame& frame) const {
  for (const Index k : uppers) {
    if (hidden_beside(lower, k, frame) || hidden_below_face(lower, k, frame)) return true;
    if (!patches_.are_of_graph() && lies_in(lower, k)) return true;
    if (is_fine<Real> && hidden_by_axis(lower, k, frame.box)) return true;
  }
  return false;
}

template class Envelope<double>;
template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
