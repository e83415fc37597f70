#include <algorithm>

#include "terrain/box_frame.hpp"
#include "terrain/clip_polygon.hpp"

// Where bodies end in walls, and what that hides.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

/// The one wall at which the patch's body ends within the box, if there is one and nothing else of the body's outline
/// meets the box. Inside of it the body is at least as high as its rim: a ball as its centre, a cigar as its axis
/// beside the place. A bit beyond an edge's ends its line is as good an outline as the circle there.
template <class Real>
std::optional<typename Envelope<Real>::Wall> Envelope<Real>::wall_through(Index i, const BoxFrame& box) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::vertex) return Wall{{f.at, 0, 0, 0, BoundType::disc, true, none, true, BoundSource::rim, none}, 0};
  if (f.kind == FeatureKind::face) return std::nullopt;
  const Real dx = box.mid.x - f.at.x, dy = box.mid.y - f.at.y, along = dx * f.gx + dy * f.gy;
  const Real spread = absolute(f.gx) * box.hx + absolute(f.gy) * box.hy + noise_;
  const Real beyond = std::max({Real(0), spread - along, along + spread - f.length});
  if (beyond * beyond > patches_.radius() * tolerance_ / 4) return std::nullopt;
  const Real aside = dy * f.gx - dx * f.gy;
  const bool left = aside > 0;
  // The wall on the other side.
  if (absolute(f.gx) * box.hy + absolute(f.gy) * box.hx - absolute(aside) >= patches_.radius()) return std::nullopt;
  const Real limit = left ? patches_.radius() : -patches_.radius();
  return Wall{{f.at, -f.gy, f.gx, limit, BoundType::line, left, none, true, BoundSource::rim, none}, absolute(f.m) * beyond};
}

/// True if the patch lies on the inner side of another one's wall within the box, as far as matters.
template <class Real>
bool Envelope<Real>::ends_before(Index i, const Bound& wall, const Box& box) const {
  const Patch& f = patches_[i];
  const Real tolerance = tolerance_ / 4;
  if (wall.type == BoundType::line) {
    for (const Bound& b : patches_.bounds(i)) {  // its own straight side runs along the wall
      if (b.type != BoundType::line) continue;
      const Real s = -b.sign(), w = -wall.sign();
      const Point m = box.middle();
      const Real excess = s * b.value(m, 0) - w * wall.value(m, 0);
      const Real spread = absolute(s * b.nx - w * wall.nx) * box.half_x() + absolute(s * b.ny - w * wall.ny) * box.half_y();
      if (excess + spread <= noise_) return true;
    }
  }
  if (wall.type == BoundType::disc) {
    const auto is_centre = [&](Point p) { return norm(p.x - wall.at.x, p.y - wall.at.y) <= tolerance; };
    if (f.kind != FeatureKind::edge) return f.kind == FeatureKind::vertex && is_centre(f.at);
    // Beyond its end an edge's body is a ball.
    const Real along = f.along(box.middle());
    const Real spread = absolute(f.gx) * box.half_x() + absolute(f.gy) * box.half_y();
    if (along + spread <= 0) return is_centre(f.at);
    return along - spread >= f.length && is_centre(f.end());
  }
  const auto beyond = [&](Point p) {  // of the edge's line, towards the wall
    const Real aside = (p.x - wall.at.x) * wall.nx + (p.y - wall.at.y) * wall.ny;
    return wall.negative ? aside : -aside;
  };
  if (f.kind == FeatureKind::vertex) return beyond(f.at) <= tolerance;
  if (f.kind == FeatureKind::edge) {
    return beyond(f.at) <= tolerance && beyond(f.end()) <= tolerance;
  }
  for (const Point c : patches_.corners(i)) {
    if (beyond(c) > patches_.radius() + tolerance) return false;
  }
  return true;
}

/// How far a place is outside of a wall, beside it; at most a convex function of the place.
template <class Real>
Real Envelope<Real>::outside(const Bound& wall, Point p) const {
  const Real value = wall.sign() * wall.value(p, patches_.square_radius());
  return wall.type == BoundType::disc ? value / (2 * patches_.radius()) : value;
}

/// True if the outlines of two bodies, moved inwards by `inset` in all, leave no gap between them in the box that is
/// wide enough to show.
template <class Real>
bool Envelope<Real>::back_to_back(const Bound& a, const Bound& b, const Box& box, Real inset) const {
  for (const Point p : box.corners()) {
    if (!(outside(a, p) + outside(b, p) + inset <= 2 * tolerance_))
      return false;  // twice: lines round what they leave out
  }
  return true;
}

/// How far inside its wall a body is as high as a plane all over the box, given by its heights at the corners; infinite
/// if that is far.
template <class Real>
Real Envelope<Real>::inset_of(Index body, const Wall& wall, const Box& box, const std::array<Real, 4>& plane) const {
  const std::array<Point, 4> corner = box.corners();
  Real excess = 0;  // of the plane over the rim
  for (int k = 0; k < 4; ++k)
    excess = std::max(excess, plane[k] - (rim_height(body, corner[k]) - wall.lowered + noise_));
  const Patch& f = patches_[body];
  const Real up = excess / (f.kind == FeatureKind::edge ? f.q : Real(1)), square = up * up / patches_.square_radius();
  return square < 0.5 ? patches_.radius() * square / 2 * (1 + square) : Real(std::numeric_limits<double>::infinity());
}

/// True if the rim of a wall is above the lower patch all over the box.
template <class Real>
bool Envelope<Real>::is_above(Index upper, const Wall& wall, Index lower, const BoxFrame& frame) const {
  const Point p = support_point(lower, frame);
  const Gradient g = patches_.gradient(lower, p);
  const std::array<Point, 4> corner = frame.box.corners();
  return std::all_of(corner.begin(), corner.end(), [&](Point q) {
    return patches_.extended_height(lower, p) + g.x * (q.x - p.x) + g.y * (q.y - p.y) <
           rim_height(upper, q) - wall.lowered - noise_;
  });
}

template <class Real>
std::optional<BoundOf<Real>> Envelope<Real>::wall_above(Index upper, Index lower, const Box& box) const {
  const BoxFrame frame(box);
  const std::optional<Wall> wall = wall_through(upper, frame);
  return wall && is_above(upper, *wall, lower, frame) ? std::optional(wall->outline) : std::nullopt;
}

template <class Real>
std::optional<WallBesideOf<Real>> Envelope<Real>::wall_beside(Index upper, Index lower, const Box& box) const {
  const BoxFrame frame(box);
  const std::optional<Wall> wall = wall_through(upper, frame);
  if (!wall) return std::nullopt;
  if (is_above(upper, *wall, lower, frame)) return WallBesideOf<Real>{wall->outline, 0};
  const Real inset = inset_of(upper, *wall, box, support(lower, frame).at_corners(frame));
  return is_finite(inset) ? std::optional(WallBesideOf<Real>{wall->outline, inset}) : std::nullopt;
}

/// True if what shows of a patch beyond the wall of a body that hides the rest is below another body: it lies in a
/// strip along the patch's own wall, above which heights rise like square roots. Or below an edge beside its own.
template <class Real>
bool Envelope<Real>::hidden_beyond(Index i, const Wall& wall, Real inset, std::span<const Index> others,
                                   const BoxFrame& frame) const {
  const Patch& f = patches_[i];
  const std::optional<Wall> own = wall_through(i, frame);
  if (!own) return false;
  const std::array<Point, 4> corner = frame.box.corners();
  Real width = 0;
  for (const Point p : corner) width = std::max(width, outside(wall.outline, p) + inset - outside(own->outline, p));
  if (own->outline.type == BoundType::disc)
    width += 4 * (frame.hx * frame.hx + frame.hy * frame.hy) / (2 * patches_.radius());
  const Real up = square_root(2 * patches_.radius() * width);
  return std::any_of(others.begin(), others.end(), [&](Index other) {
    if (other != i && hidden_beside(i, other, frame, 0, 0, up)) return true;
    return is_fine<Real> && std::all_of(corner.begin(), corner.end(), [&](Point p) {
      const Real strip = f.kind == FeatureKind::edge ? axis_height(i, p) + f.q * up : f.z + up;
      return patches_.body_height(other, p) - noise_ > strip;
    });
  });
}

/// True if the part of a patch's domain within the box lies on the inner side of a wall moved inwards by `inset`, but for less
/// than is told apart. Curved sides of the domain count as straight ones a bit further out, and not at all where the box
/// reaches beyond the sphere that they are on; how far a place is outside is greatest at a corner then.
template <class Real>
bool Envelope<Real>::lies_inside(Index i, const Bound& wall, Real inset, const Box& box) const {
  const std::array<Point, 4> corner = box.corners();
  const Point mid = box.middle();
  std::vector<Point> part(corner.begin(), corner.end());
  for (const Bound& side : patches_.bounds(i)) {
    if (side.type == BoundType::disc || part.empty()) continue;
    const auto is_on_sphere = [&](Point p) {
      const Real dx = p.x - side.at.x, dy = p.y - side.at.y, square = patches_.square_radius();
      return square - (dx * dx + dy * dy) > least_square * square;
    };
    if (side.type == BoundType::cone && side.c != 0 && !std::all_of(corner.begin(), corner.end(), is_on_sphere)) continue;
    const auto value = [&](Point p) { return side.sign() * side.value(p, patches_.square_radius()); };
    const Gradient g = bound_gradient(side, mid);
    const Real middle = value(mid), x = side.sign() * g.x, y = side.sign() * g.y;
    const auto tangent = [&](Point p) { return middle + x * (p.x - mid.x) + y * (p.y - mid.y); };
    Real above = 0;  // the function, by as much as it is concave
    for (const Point p : corner) above = std::max(above, tangent(p) - value(p));
    clip_polygon(part, [&](Point p) { return tangent(p) - above; });
  }
  return std::all_of(part.begin(), part.end(), [&](Point p) { return outside(wall, p) + inset <= tolerance_; });
}

/// True if a patch that the body behind a wall hides, but for `inset`, is beyond that wall beside another edge and not
/// above it by more than the tolerance. On a grid with R a whole number of cells walls run exactly where two edges in one
/// line meet in a valley. Only for walls along an axis.
template <class Real>
bool Envelope<Real>::beside_beyond(Index i, const Bound& wall, Real inset, std::span<const Index> others,
                                   const Box& box) const {
  constexpr double straight = 0x1p-50;
  if (wall.type != BoundType::line || std::min(absolute(wall.nx), absolute(wall.ny)) > straight) return false;
  const bool upright = absolute(wall.nx) > 0.5;
  const Real n = upright ? wall.nx : wall.ny, at = (upright ? wall.at.x : wall.at.y) + wall.c / n;
  Box beyond = box;
  Real &low = upright ? beyond.low.x : beyond.low.y, &high = upright ? beyond.high.x : beyond.high.y;
  if (wall.sign() * n > 0) low = std::max(low, at - inset);
  else high = std::min(high, at + inset);
  if (low >= high) return true;
  const BoxFrame frame(beyond);
  return std::any_of(others.begin(), others.end(), [&](Index other) {
    return other != i && hidden_beside(i, other, frame, 0, tolerance_);
  });
}

template class Envelope<double>;
template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
