#include <algorithm>

#include "terrain/envelope.hpp"

// Where R is above the extent: patches and curves in terms of the normals that a ball touches them with. What the ball touches
// is small beside R then, so that conditions are all but linear in the normal, however large or close to a wall the box is.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

/// Places of the terrain that a ball may touch whose middle lies over the box: ends of the part of an edge, corners of a face.
template <class Real>
std::size_t Envelope<Real>::contacts(Index i, const Box& box, Vector* out) const {
  const Patch& f = patches_[i];
  const Real radius = patches_.radius();
  if (f.kind == FeatureKind::vertex) {
    out[0] = {f.at.x, f.at.y, f.z};
    return 1;
  }
  if (f.kind == FeatureKind::face) {
    const Real rise = radius * f.flat;
    const std::span<const Point> corner = patches_.corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = {corner[k].x + rise * f.gx, corner[k].y + rise * f.gy, patches_.extended_height(i, corner[k]) - rise};
    }
    return 3;
  }
  const Point mid = box.middle();
  const Real hx = box.half_x(), hy = box.half_y(), dx = mid.x - f.at.x, dy = mid.y - f.at.y;
  const Real along = dx * f.gx + dy * f.gy, aside = absolute(dy * f.gx - dx * f.gy);
  const Real along_spread = absolute(f.gx) * hx + absolute(f.gy) * hy + noise_;
  const Real aside_spread = absolute(f.gy) * hx + absolute(f.gx) * hy;
  const auto up = [&](Real b) { return square_root(std::max(Real(0), patches_.square_radius() - b * b)); };
  const Real low_up = up(aside + aside_spread), high_up = up(std::max(Real(0), aside - aside_spread)), shift = f.m * f.flat;
  const Real low = std::clamp(along - along_spread + shift * (shift > 0 ? low_up : high_up), Real(0), f.length);
  const Real high = std::clamp(along + along_spread + shift * (shift > 0 ? high_up : low_up), Real(0), f.length);
  out[0] = {f.at.x + low * f.gx, f.at.y + low * f.gy, f.z + low * f.m};
  out[1] = {f.at.x + high * f.gx, f.at.y + high * f.gy, f.z + high * f.m};
  return 2;
}

/// Vectors of length R whose convex hull holds all those from the terrain to the middle of a ball over the box that touches the
/// patch's feature.
template <class Real>
std::size_t Envelope<Real>::normals(Index i, const Box& box, Vector* out) const {
  const Patch& f = patches_[i];
  const Real radius = patches_.radius(), square = patches_.square_radius();
  const auto up = [&](Real d) { return square_root(std::max(Real(0), square - d)); };
  if (f.kind == FeatureKind::face) {
    out[0] = {-f.gx * radius * f.flat, -f.gy * radius * f.flat, radius * f.flat};
    return 1;
  }
  const Point mid = box.middle();
  const Real hx = box.half_x(), hy = box.half_y(), dx = mid.x - f.at.x, dy = mid.y - f.at.y;
  if (f.kind == FeatureKind::edge) {
    const Real aside = dy * f.gx - dx * f.gy, spread = absolute(f.gy) * hx + absolute(f.gx) * hy;
    const Real b[2] = {std::max(aside - spread, -radius), std::min(aside + spread, radius)};
    const Real w[2] = {up(b[0] * b[0]), up(b[1] * b[1])};
    const Real top = b[0] <= 0 && b[1] >= 0 ? radius : std::max(w[0], w[1]);
    std::size_t n = 0;
    for (int k = 0; k < 2; ++k) {
      for (const Real v : {w[k], top}) {
        const Real back = v * f.m * f.flat;
        out[n++] = {-b[k] * f.gy - back * f.gx, b[k] * f.gx - back * f.gy, v * f.flat};
      }
    }
    return n;
  }
  const Real near_x = std::max(Real(0), absolute(dx) - hx), near_y = std::max(Real(0), absolute(dy) - hy);
  const Real top = up(near_x * near_x + near_y * near_y), middle = up(dx * dx + dy * dy);
  // The height is concave over the disc only: where the box reaches beyond it, all that is known is that it is not negative.
  const Real far_x = absolute(dx) + hx, far_y = absolute(dy) + hy;
  const bool beyond = far_x * far_x + far_y * far_y >= square;
  std::size_t n = 0;
  for (const Real sx : {-1.0, 1.0}) {
    for (const Real sy : {-1.0, 1.0}) {
      const Real x = dx + sx * hx, y = dy + sy * hy, w = beyond ? 0 : up(x * x + y * y);
      // Where the sphere is not steep its tangent plane is lower than its highest point.
      const Real above = middle > 0.9 * top ? middle - (dx * sx * hx + dy * sy * hy) / middle : top;
      out[n++] = {x, y, w};
      out[n++] = {x, y, above};
    }
  }
  return n;
}

/// True if all that a ball over the box touches with the patch's feature lies in balls about places of the labels' features, so
/// that the patch is not seen. With the place a touched, n from there to the middle of the ball and another place k,
///   n . (k - a) - |k - a|^2 / 2
/// is positive where a + n lies within the ball about k. It is linear in n and concave in a, whatever the size of the box: so
/// are weighted means for two places k.
template <class Real>
bool Envelope<Real>::hidden_by_balls(Index i, std::span<const Index> labels, const Box& box) const {
  const Box part = box.intersection(patches_.box(i));
  if (part.is_empty()) return true;
  Vector place[3], normal[8], other[8];
  const std::size_t places = contacts(i, part, place), normals_count = normals(i, part, normal);
  std::size_t others = 0;
  for (const Index l : labels) {
    if (l == i || others + 3 > 8) continue;
    others += contacts(l, part, other + others);
  }
  constexpr std::size_t most = 16;
  Real depth[8][most];
  const std::size_t nodes = places * normals_count;
  const Real least = noise_ * patches_.radius();
  for (std::size_t k = 0; k < others; ++k) {
    Real lowest = std::numeric_limits<double>::infinity();
    std::size_t node = 0;
    for (std::size_t a = 0; a < places; ++a) {
      const Real x = other[k].x - place[a].x, y = other[k].y - place[a].y, z = other[k].z - place[a].z;
      const Real half = (x * x + y * y + z * z) / 2 + least;
      for (std::size_t n = 0; n < normals_count; ++n) {
        const Real d = normal[n].x * x + normal[n].y * y + normal[n].z * z - half;
        depth[k][node++] = d;
        lowest = std::min(lowest, d);
      }
    }
    if (lowest > 0) return true;
  }
  for (std::size_t k = 0; k < others; ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      Real low = 0, high = 1;  // weights of k that are enough
      for (std::size_t node = 0; node < nodes && low < high; ++node) {
        const Real a = depth[k][node], b = depth[l][node];
        if (a > b) low = std::max(low, -b / (a - b));
        else if (a < b) high = std::min(high, -b / (a - b));
        else if (a <= 0) high = -1;
      }
      if (low < high) return true;
    }
  }
  return false;
}

/// True if all balls over the box that touch the lower patch's feature, an edge or a vertex, cut into the upper one's edge: two
/// edges that leave a vertex in nearly one direction, or lie in nearly one line. With the place a touched, n from there to the
/// middle of the ball, and v from the upper edge's line to a, the shortest way, the ball cuts that line by
///   (n . d)^2 - 2 v . n - |v|^2,
/// linear in n and concave in a but for the square, which is left out.
template <class Real>
bool Envelope<Real>::hidden_by_axis(Index lower, Index upper, const Box& box) const {
  const Patch &c = patches_[lower], &k = patches_[upper];
  if (c.kind == FeatureKind::face || k.kind != FeatureKind::edge) return false;
  if (c.kind == FeatureKind::edge && absolute(c.gx * k.gy - c.gy * k.gx) > 0x1p-8) return false;
  const Box part = box.intersection(patches_.box(lower));
  if (part.is_empty()) return true;
  Vector place[3], normal[8];
  const std::size_t places = contacts(lower, part, place), nodes = normals(lower, part, normal);
  const Vector d = direction(upper);
  const auto dot = [](const Vector& v, const Vector& w) { return v.x * w.x + v.y * w.y + v.z * w.z; };
  const Real length = k.length * k.q, slack = noise_ * patches_.radius();
  bool cuts = false;
  for (std::size_t i = 0; i < places; ++i) {
    const Vector from{place[i].x - k.at.x, place[i].y - k.at.y, place[i].z - k.z};
    const Real along = dot(from, d);
    const Vector v{from.x - along * d.x, from.y - along * d.y, from.z - along * d.z};
    Real least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < nodes; ++j) {
      const Real foot = along + dot(normal[j], d);
      if (foot < -noise_ || foot > length + noise_) return false;
      least = std::min(least, -2 * dot(v, normal[j]) - dot(v, v));
    }
    if (least < -slack) return false;
    cuts = cuts || least > slack;
  }
  return cuts;
}

/// The function that vanishes along the curve between two patches, or along the rim of the first one if there is no other, at
/// the places that a ball may touch with the first one: multilinear in normal and place but for `slack` that may come on top.
/// False if it has no such form.
template <class Real>
bool Envelope<Real>::curve_function(Index own, Index other, std::span<const Vector> places, std::span<const Vector> normals,
                              Real* value, Real& slack) const {
  const Patch& f = patches_[own];
  const auto for_all = [&](auto&& function) {
    std::size_t i = 0;
    for (const Vector& a : places) {
      for (const Vector& n : normals) value[i++] = function(a, n);
    }
    return true;
  };
  slack = 0;
  if (other == none) return for_all([](const Vector&, const Vector& n) { return n.z; });
  if (const Bound* seam = patches_.seam(own, other)) {
    if (f.kind == FeatureKind::vertex) {
      return for_all([&](const Vector&, const Vector& n) { return seam->nx * n.x + seam->ny * n.y + seam->c * n.z; });
    }
    if (seam->type == BoundType::line) {
      return for_all([&](const Vector&, const Vector& n) { return seam->nx * n.x + seam->ny * n.y - seam->c; });
    }
    return for_all([&](const Vector& a, const Vector&) { return (a.x - seam->at.x) * f.gx + (a.y - seam->at.y) * f.gy; });
  }
  const Patch& g = patches_[other];
  if (g.kind == FeatureKind::face) {
    return for_all([&](const Vector& a, const Vector& n) {
      return a.z + n.z - (g.z + g.gx * (a.x + n.x - g.at.x) + g.gy * (a.y + n.y - g.at.y));
    });
  }
  Real square = 0;  // of half the stretch of places
  if (places.size() == 2) {
    const Real x = places[1].x - places[0].x, y = places[1].y - places[0].y, z = places[1].z - places[0].z;
    square = (x * x + y * y + z * z) / 4;
  }
  const bool is_edge = g.kind == FeatureKind::edge;
  const Vector axis = is_edge ? direction(other) : Vector{0, 0, 0};
  Real along = 0;
  for (const Vector& n : normals) along = std::max(along, absolute(n.x * axis.x + n.y * axis.y + n.z * axis.z));
  slack = (square + along * along) / 2;
  return for_all([&](const Vector& a, const Vector& n) {
    Vector d{a.x - g.at.x, a.y - g.at.y, a.z - g.z};  // from the other one's ball or axis
    const Real t = d.x * axis.x + d.y * axis.y + d.z * axis.z;
    d = {d.x - t * axis.x, d.y - t * axis.y, d.z - t * axis.z};
    return -(n.x * d.x + n.y * d.y + n.z * d.z) - (d.x * d.x + d.y * d.y + d.z * d.z) / 2;
  });
}

/// True if the curves between a patch and two others certainly do not meet in the box: there is a linear combination of the
/// functions that vanish along them which is zero nowhere.
template <class Real>
bool Envelope<Real>::stay_apart(Index patch, Index first, Index second, const Box& box) const {
  if (patches_[patch].kind == FeatureKind::face) return false;
  Vector place[3], normal[8];
  const std::span<const Vector> places(place, contacts(patch, box, place)), directions(normal, normals(patch, box, normal));
  const std::size_t nodes = places.size() * directions.size();
  Real x[8], y[8], more_x = 0, more_y = 0;
  if (!curve_function(patch, first, places, directions, x, more_x)) return false;
  if (!curve_function(patch, second, places, directions, y, more_y)) return false;
  std::array<Point, 32> point;
  std::size_t count = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    for (const Real dx : {Real(0), more_x}) {
      for (const Real dy : {Real(0), more_y}) {
        if ((dx == 0 || more_x > 0) && (dy == 0 || more_y > 0)) point[count++] = {x[i] + dx, y[i] + dy};
      }
    }
  }
  // All points in an open half-plane: one of them is the first in the sense of rotation.
  for (std::size_t i = 0; i < count; ++i) {
    const Point p = point[i];
    const bool is_first = std::all_of(point.begin(), point.begin() + std::ptrdiff_t(count), [&](Point q) {
      const Real cross = p.x * q.y - p.y * q.x;
      return cross > 0 || (cross == 0 && p.x * q.x + p.y * q.y > 0);
    });
    if (is_first) return true;
  }
  return false;
}

template class Envelope<double>;
template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
