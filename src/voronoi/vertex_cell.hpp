#pragma once

#include <array>
#include <cmath>

#include "voronoi/side_cell.hpp"

namespace krepl::voronoi {

/// A bisector of a vertex with another site, seen from the vertex in direction u: 1/r = c + w.u, with c = 0, w = 2
/// q/|q|^2 for a point q and c = 1/d, w = m/d for a line at distance d in direction m (a parabola with its focus in the
/// vertex). Coordinates are those of a chart: u = (1, t) / sqrt(1 + t^2).
template <class Real>
struct VertexCurve {
  Index label = none;
  bool is_line = false;
  Vector<Real> w{};
  Vector<Real> at{};      // the point; of a line: a point of it
  Vector<Real> normal{};  // lines: towards the vertex
  Real c = 0, distance = 0;
  Index ends[2] = {none, none};  // lines: the vertices of the site
  Vector<Real> places[2]{};      // lines: where they are

  /// Distance of the bisector from the vertex in the chart's direction t.
  Real height(Real t) const {
    const Real stretch = kernel::square_root(1 + t * t), nearness = c * stretch + w.x + w.y * t;
    return nearness > 0 ? stretch / nearness : infinite<Real>();
  }
};

/// The directions of the chart counter-clockwise from u to v. Directions beyond the chart are off both its ends.
template <class Real>
Stretches<Real> chart_stretches(Vector<Real> u, Vector<Real> v) {
  if (u.x > 0 && v.x > 0) {
    const Real low = u.y / u.x, high = v.y / v.x;
    return low <= high ? Stretches<Real>::between(low, high) : Stretches<Real>::outside(high, low);
  }
  if (u.x > 0) return Stretches<Real>::between(u.y / u.x, infinite<Real>());
  if (v.x > 0) return Stretches<Real>::between(-infinite<Real>(), v.y / v.x);
  // Both behind: the turn from u to v passes through the chart iff it is by more than 180 degrees.
  const Real turn = cross(u, v);
  const bool all = turn < 0 || (turn == 0 && u.y < v.y);
  return all ? Stretches<Real>::all() : Stretches<Real>::nowhere();
}

/// b is nearer where a0 + d.u > 0: around the direction d, between the two roots.
template <class Real>
Stretches<Real> nearer_around(Real a0, Vector<Real> d, Real square) {
  if (!(square > 0)) return a0 > 0 ? Stretches<Real>::all() : Stretches<Real>::nowhere();
  const Real s = kernel::square_root(square);
  // |d|^2 u = -a0 d -+ s perp(d); the length does not matter.
  return chart_stretches<Real>({-a0 * d.x + s * d.y, -a0 * d.y - s * d.x}, {-a0 * d.x - s * d.y, -a0 * d.y + s * d.x});
}

/// Two lines that share a vertex q: their own bisector starts there along u, the sum of their normals, and meets that
/// with the face's vertex in q + t u, a root of k e t^2 + 2 q.u t + |q|^2 with k = |u|^2 / 2, e = |difference of the
/// normals|^2 / 2. Sharp even where the lines are nearly parallel.
template <class Real>
Stretches<Real> nearer_of_incident(const VertexCurve<Real>& b, const VertexCurve<Real>& a, Vector<Real> q,
                                   Vector<Real> d) {
  const Vector<Real> u = a.normal + b.normal, turn = a.normal - b.normal;
  const Real ke = dot(u, u) * dot(turn, turn) / 4, half = -dot(q, u), square = half * half - ke * dot(q, q);
  if (!(square > 0)) return b.c > a.c ? Stretches<Real>::all() : Stretches<Real>::nowhere();
  const Real root = half > 0 ? half + kernel::square_root(square) : half - kernel::square_root(square);
  const Vector<Real> near = q + (dot(q, q) / root) * u, far = ke * q + root * u;  // the length does not matter
  return cross(near, d) > 0 ? chart_stretches(near, far) : chart_stretches(far, near);
}

/// Where curve b is nearer to the vertex than curve a.
template <class Real>
Stretches<Real> nearer(const VertexCurve<Real>& b, const VertexCurve<Real>& a) {
  if (a.label == b.label) return Stretches<Real>::nowhere();
  const Vector<Real> d = b.w - a.w;
  if (a.label == none)
    return nearer_around<Real>(b.c - a.c, d, b.is_line ? a.c * (2 * b.c - a.c) : dot(d, d) - a.c * a.c);
  if (a.is_line && b.is_line) {
    int i = 0, k = 0;
    if (dot(a.normal, b.normal) > 0 && shared_end(a, b, i, k)) return nearer_of_incident(b, a, a.places[i], d);
    const Vector<Real> turn = a.normal - b.normal;
    return nearer_around<Real>(b.c - a.c, d, dot(turn, turn) / (a.distance * b.distance));
  }
  if (!a.is_line && !b.is_line) return nearer_around<Real>(0, d, dot(d, d));
  const VertexCurve<Real>&point = a.is_line ? b : a, &line = a.is_line ? a : b;
  const Real h = dot(line.normal, point.at - line.at);  // of the point over the line
  return nearer_around<Real>(b.c - a.c, d, 4 * h / (line.distance * dot(point.at, point.at)));
}

/// The face of a vertex: the sector its segments leave open, or the whole plane around an isolated vertex, below the
/// bisectors with all other sites. The sector is looked at in up to four charts of about 90 degrees.
template <class Real>
class VertexCell {
 public:
  using Curve = VertexCurve<Real>;
  struct Chart {
    Vector<Real> middle;  // its x axis in the plane
    Real low, high;       // of t
    Envelope<Real, Curve> envelope;

    Vector<Real> rotate(Vector<Real> v) const { return {dot(v, middle), cross(middle, v)}; }
    /// Unit vector of direction t, in the plane.
    Vector<Real> direction(Real t) const {
      const Real s = kernel::square_root(1 + t * t);
      return {(middle.x - t * middle.y) / s, (middle.y + t * middle.x) / s};
    }
  };

  explicit VertexCell(const Sites& sites) : sites_(sites) {}
  /// Precondition: the vertex has a face. Returns false if the sector is too thin for Real.
  bool start(Index vertex);
  /// Returns true if the face changed.
  bool add_site(Index site, SiteParts parts);

  Index vertex() const { return vertex_; }
  /// True if double precision cannot tell on which side of a segment that matters the vertex lies; neighbours might not
  /// notice.
  bool is_uncertain() const { return uncertain_; }
  /// What counts as near, in a search: the length of a segment beside the vertex.
  Real size() const { return beside_[0] == none ? Real(0) : length(locate(beside_[0])); }
  /// Where a search begins, relative to the vertex.
  Vector<Real> middle() const { return {Real(0), Real(0)}; }
  bool is_isolated() const { return !sites_.is_side(sector_.before); }
  Instance::Sector sector() const { return sector_; }
  int chart_count() const { return charts_; }
  const Chart& chart(int i) const { return chart_[i]; }
  bool is_own(Index site) const {
    const auto s = sites_.instance().site(site);
    return s.a == vertex_ || s.b == vertex_;
  }
  Vector<Real> locate(Index vertex) const { return sites_.template difference<Real>(vertex, vertex_); }

 private:
  void add_chart(Vector<Real> middle, Vector<Real> low, Vector<Real> high);
  void add_vertex(Index vertex, Vector<Real> q);
  void add_line(Index segment, Vector<Real> a, Vector<Real> b);

  const Sites& sites_;
  Index vertex_ = none;
  Instance::Sector sector_{};
  Index beside_[2] = {none, none};  // the other ends of the segments that bound the sector
  bool changed_ = false, uncertain_ = false;
  int charts_ = 0;
  std::array<Chart, 4> chart_;
};

extern template class VertexCell<double>;
extern template class VertexCell<Twofold>;
extern template class VertexCell<quad>;
extern template class VertexCell<wide>;

}  // namespace krepl::voronoi
