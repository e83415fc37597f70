#include <algorithm>

#include "terrain/box_frame.hpp"

// Cylinders whose axes cross.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

namespace {

template <class Vector>
Vector turned(const Vector& v) {
  return {-v.x, -v.y, -v.z};
}

}  // namespace

/// At least the greatest distance by which a place of an edge's patch over the box lies within the half-space, times its normal's
/// length.
template <class Real>
Real Envelope<Real>::most_beyond(Index edge, const HalfSpace& part, const BoxFrame& frame) const {
  const std::array<Point, 4> corner = frame.box.corners();
  std::array<Real, 4> bound;
  if (part.normal.z > 0) {
    bound = support(edge, frame).at_corners(frame);
  } else {  // a patch is at least linear between the corners, or else, beside a wall, as high as its axis
    for (int i = 0; i < 4; ++i) bound[i] = patches_.extended_height(edge, corner[i]);
    if (!std::all_of(bound.begin(), bound.end(), [](Real h) { return h > below_everything; })) {
      for (int i = 0; i < 4; ++i) bound[i] = axis_height(edge, corner[i]);
    }
  }
  Real most = -endless;
  for (int i = 0; i < 4; ++i) {
    most = std::max(most, part.normal.x * (corner[i].x - part.at.x) + part.normal.y * (corner[i].y - part.at.y) + part.normal.z * (bound[i] - part.z));
  }
  return most;
}

/// As below, for two edges out of one vertex, with unit directions d and e away from there: a ball touches the first one where
/// x e >= 0, at the distance R from its axis, and is outside of the second one's cylinder or ball if x d <= x e. Nothing if the
/// edges have no vertex in common, or the second one may end in the box elsewhere.
template <class Real>
std::optional<typename Envelope<Real>::HalfSpace> Envelope<Real>::outside_at_vertex(Index first, Index second, const BoxFrame& frame) const {
  const Patch &f = patches_[first], &g = patches_[second];
  for (const bool f_end : {false, true}) {
    for (const bool g_end : {false, true}) {
      const Point at = f_end ? f.end() : f.at, other = g_end ? g.end() : g.at;
      const Real z = f_end ? f.end_z() : f.z, other_z = g_end ? g.end_z() : g.z;
      if (std::max({absolute(at.x - other.x), absolute(at.y - other.y), absolute(z - other_z)}) > noise_) continue;
      const Vector e = f_end ? turned(direction(first)) : direction(first), d = g_end ? turned(direction(second)) : direction(second);
      if (!(most_beyond(first, {at, z, d}, frame) <= g.length * g.q)) return std::nullopt;
      return HalfSpace{at, z, {e.x - d.x, e.y - d.y, e.z - d.z}};
    }
  }
  return std::nullopt;
}

/// Half-spaces, none to two, in each of which lies all that is outside of the second edge's cylinder of what a ball over the box
/// touches with the first edge. Two cylinders whose axes cross meet in two planes through the crossing: at x from there, with
/// unit directions d and e of the axes, the squares of the distances from these differ by (x (d + e)) (x (d - e)), and the sign
/// of one factor tells that of the other.
template <class Real>
std::size_t Envelope<Real>::outside_of_crossing(Index first, Index second, const BoxFrame& frame, HalfSpace out[2]) const {
  const Patch &f = patches_[first], &g = patches_[second];
  if (first == second || f.kind != FeatureKind::edge || g.kind != FeatureKind::edge) return 0;
  if (const std::optional<HalfSpace> part = outside_at_vertex(first, second, frame)) {
    out[0] = *part;
    return 1;
  }
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
  std::size_t count = 0;
  const Vector d = direction(first), e = direction(second);
  const auto combine = [&](int s) { return Vector{d.x + s * e.x, d.y + s * e.y, d.z + s * e.z}; };
  const Real least = least_factor * patches_.radius();
  for (const int sign : {1, -1}) {
    const Vector factor = combine(sign), normal = combine(-sign);
    if (most_beyond(first, {at, z, turned(factor)}, frame) < -least) out[count++] = {at, z, normal};
    if (most_beyond(first, {at, z, factor}, frame) < -least) out[count++] = {at, z, turned(normal)};
  }
  return count;
}

template class Envelope<double>;
template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
