#include <algorithm>

#include "terrain/box_frame.hpp"

// Cylinders whose axes cross.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

/// Half-spaces, none to two, in each of which lies all that is outside of the second edge's cylinder of what a ball over the box
/// touches with the first edge. Two cylinders whose axes cross meet in two planes through the crossing: at x from there, with
/// unit directions d and e of the axes, the squares of the distances from these differ by (x (d + e)) (x (d - e)), and the sign
/// of one factor tells that of the other.
template <class Real>
std::size_t Envelope<Real>::outside_of_crossing(Index first, Index second, const BoxFrame& frame, HalfSpace out[2]) const {
  const Patch &f = patches_[first], &g = patches_[second];
  if (first == second || f.kind != FeatureKind::edge || g.kind != FeatureKind::edge) return 0;
  constexpr double least_angle = 0x1p-20;
  constexpr double least_factor = is_fine<Real> ? 0x1p-30 : 0x1p-8;  // axes that miss each other by noise move a plane by as much more
  const Real sine = f.gx * g.gy - f.gy * g.gx, turn = f.gx * g.gx + f.gy * g.gy;
  Real along;  // from the first one's first vertex
  if (absolute(sine) > least_angle) {
    along = ((g.at.x - f.at.x) * g.gy - (g.at.y - f.at.y) * g.gx) / sine;
  } else {  // above each other
    const Real growth = turn * g.m - f.m;
    if (std::max(absolute(f.aside(g.at)), absolute(f.aside(g.end()))) > noise_ || !(absolute(growth) > least_angle)) return 0;
    along = (f.z - axis_height(second, f.at)) / growth;
  }
  const Point at{f.at.x + along * f.gx, f.at.y + along * f.gy};
  const Real z = axis_height(first, at);
  if (!(absolute(z - axis_height(second, at)) <= noise_)) return 0;
  for (const Bound& b : patches_.bounds(second)) {  // beyond its ends there is no cylinder
    if ((b.source == BoundSource::start || b.source == BoundSource::end) && !is_within(b, frame)) return 0;
  }
  const std::array<Point, 4> corner = frame.box.corners();
  // Heights are at least linear between the corners, or else, beside a wall, those of the axis.
  std::array<Real, 4> lowest;
  for (int i = 0; i < 4; ++i) lowest[i] = patches_.extended_height(first, corner[i]);
  if (!std::all_of(lowest.begin(), lowest.end(), [](Real h) { return h > below_everything; })) {
    for (int i = 0; i < 4; ++i) lowest[i] = axis_height(first, corner[i]);
  }
  const std::array<Real, 4> highest = support(first, frame).at_corners(frame);
  std::size_t count = 0;
  for (const int sign : {1, -1}) {
    const auto combine = [&](int s) {
      return Vector{f.flat * f.gx + s * (g.flat * g.gx), f.flat * f.gy + s * (g.flat * g.gy), f.flat * f.m + s * (g.flat * g.m)};
    };
    const Vector factor = combine(sign), normal = combine(-sign);
    Range value{endless, -endless};
    for (int i = 0; i < 4; ++i) {
      const Real level = factor.x * (corner[i].x - at.x) + factor.y * (corner[i].y - at.y);
      for (const Real height : {lowest[i], highest[i]}) {
        value.low = std::min(value.low, level + factor.z * (height - z));
        value.high = std::max(value.high, level + factor.z * (height - z));
      }
    }
    const Real least = least_factor * patches_.radius();
    if (value.low > least) out[count++] = {at, z, normal};
    if (value.high < -least) out[count++] = {at, z, {-normal.x, -normal.y, -normal.z}};
  }
  return count;
}

template class Envelope<double>;
template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
