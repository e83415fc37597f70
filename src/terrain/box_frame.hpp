#pragma once

#include "terrain/envelope.hpp"

// Boxes as the tests of what cannot show in them take them, and which side of a bound one lies on.
namespace krepl::terrain {

template <class Real>
struct Envelope<Real>::BoxFrame {
  explicit BoxFrame(const Box& b) : box(b), mid(b.middle()), hx(b.half_x()), hy(b.half_y()) {}
  const Box& box;
  Point mid;
  Real hx, hy;
};

template <class Real>
inline std::array<Real, 4> Envelope<Real>::Plane::at_corners(const BoxFrame& box) const {
  const Real x = gradient.x * box.hx, y = gradient.y * box.hy, h = height;
  return {h - x - y, h + x - y, h + x + y, h - x + y};
}

/// The least value of a bound's function over a box (sign = 1), or the greatest one with its sign changed (sign = -1), a bit
/// less for rounding. `least_up`, `most_up`: of the height over the rim that a cone's value depends on.
template <class Real>
template <int sign>
[[gnu::always_inline]] inline Real Envelope<Real>::extreme(const Bound& b, const BoxFrame& f, Real least_up, Real most_up) const {
  const Real dx = f.mid.x - b.at.x, dy = f.mid.y - b.at.y;
  const Real slack = Precision<Real>::rounding * (absolute(dx) + absolute(dy) + f.hx + f.hy);
  if (b.type == BoundType::line) {
    return sign * (dx * b.nx + dy * b.ny - b.c) - (absolute(b.nx) * f.hx + absolute(b.ny) * f.hy + slack);
  }
  const Real square = patches_.square_radius();
  const Real near_x = std::max(Real(0), absolute(dx) - f.hx), near_y = std::max(Real(0), absolute(dy) - f.hy);
  const Real far_x = absolute(dx) + f.hx, far_y = absolute(dy) + f.hy;
  const Real near = near_x * near_x + near_y * near_y, far = far_x * far_x + far_y * far_y;
  if (b.type == BoundType::disc) return (sign > 0 ? near - square : square - far) - 2 * slack * (far_x + far_y);
  const Real lift = sign * b.c;
  const Real up = std::max(least_up, std::min(most_up, square_root(std::max(Real(0), square - (lift >= 0 ? far : near)))));
  return sign * (dx * b.nx + dy * b.ny) - (absolute(b.nx) * f.hx + absolute(b.ny) * f.hy + slack) + lift * up;
}

/// True if the patch's side of the bound is all of the box.
template <class Real>
inline bool Envelope<Real>::is_within(const Bound& b, const BoxFrame& f, Real least_up, Real most_up) const {
  return b.negative ? extreme<-1>(b, f, least_up, most_up) > 0 : extreme<1>(b, f, least_up, most_up) >= 0;
}

}  // namespace krepl::terrain
