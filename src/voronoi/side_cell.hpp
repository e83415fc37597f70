#pragma once

#include <cmath>

#include "voronoi/envelope.hpp"

namespace krepl::voronoi {

/// Relative distances below this are not told from zero.
template <class Real>
constexpr double narrow = 0x1p-48;
template <>
inline constexpr double narrow<Twofold> = 0x1p-100;
template <>
inline constexpr double narrow<quad> = 0x1p-108;
template <>
inline constexpr double narrow<wide> = 0x1p-300;

/// 1 - n.y of a unit vector, without cancellation.
template <class Real>
Real one_minus_y(Vector<Real> n) {
  return n.y > 0 ? n.x * n.x / (1 + n.y) : 1 - n.y;
}

/// A bisector of a side with another site, in the side's frame (x along, y outwards): the heights y of centres whose
/// distance to the other site is y as well. With a point it is a parabola, with a line a line.
template <class Real>
struct SideCurve {
  Index label = none;
  bool is_line = false;
  Vector<Real> at{};             // the point; of a line: a place (x, height) on the bisector
  Vector<Real> normal{};         // lines: the site's, towards the centres
  Vector<Real> anchor{};         // lines: a point of the site
  Index ends[2] = {none, none};  // lines: the vertices of the site
  Vector<Real> places[2]{};      // lines: where they are
  Real gap = 0;                  // lines: 1 - normal.y
  Real slope = 0;                // lines: of the bisector

  Real height(Real x) const {
    const Real dx = x - at.x;
    return is_line ? at.y + slope * dx : (dx * dx + at.y * at.y) / (2 * at.y);
  }
  /// By how much an error of the place is magnified in the height.
  double steepness(Real x) const { return std::abs(double(is_line ? slope : (x - at.x) / at.y)); }
};

/// Two points: the lower one is nearer between the roots of (q2y - q1y) t^2 + 2 q1y dx t + q1y (q2y (q1y - q2y) -
/// dx^2), whose discriminant is q1y q2y |q1 - q2|^2; t is measured from the lower point.
template <class Real>
Stretches<Real> nearer_point(const SideCurve<Real>& b, const SideCurve<Real>& a) {
  const bool b_low = b.at.y != a.at.y ? b.at.y < a.at.y : b.label < a.label;
  const Vector<Real> p = b_low ? b.at : a.at, q = b_low ? a.at : b.at;
  const Vector<Real> d = q - p;
  const Real root = kernel::square_root(p.y * q.y) * length(d);
  const Real half = p.y * d.x, last = -p.y * (q.y * d.y + d.x * d.x);
  const Real t = half > 0 ? -(half + root) : root - half;
  Real low = d.y > 0 ? t / d.y : (t < 0 ? -infinite<Real>() : infinite<Real>()), high = last / t;
  if (high < low) std::swap(low, high);
  low += p.x, high += p.x;
  return b_low ? Stretches<Real>::between(low, high) : Stretches<Real>::outside(low, high);
}

/// A point at height h over a line is nearer than the line between the roots of t^2 - 2 qy slope t + qy^2 - 2 qy m, t
/// measured from the point and m the bisector's height over it; the discriminant is 2 qy h / (1 - n.y).
template <class Real>
Stretches<Real> nearer_point_than_line(const SideCurve<Real>& point, const SideCurve<Real>& line, bool point_is_new) {
  const Vector<Real> q = point.at;
  const Real h = dot(line.normal, q - line.anchor);
  if (!(h > 0)) return point_is_new ? Stretches<Real>::nowhere() : Stretches<Real>::all();
  const Real root = kernel::square_root(2 * q.y * h / line.gap), half = q.y * line.slope;
  const Real far = half > 0 ? half + root : half - root;
  const Real near = q.y * (q.y - 2 * line.height(q.x)) / far;
  const Real low = std::min(far, near) + q.x, high = std::max(far, near) + q.x;
  return point_is_new ? Stretches<Real>::between(low, high) : Stretches<Real>::outside(low, high);
}

/// The vertex that two sites share, as a pair of indices into SideCurve::ends.
template <class Curve>
bool shared_end(const Curve& a, const Curve& b, int& i, int& k) {
  for (i = 0; i < 2; ++i) {
    for (k = 0; k < 2; ++k) {
      if (a.ends[i] == b.ends[k] && a.ends[i] != none) return true;
    }
  }
  return false;
}

template <class Real>
Stretches<Real> nearer_line(const SideCurve<Real>& b, const SideCurve<Real>& a) {
  const Real turn = b.slope - a.slope;
  int i = 0, k = 0;
  const Vector<Real> u = a.normal + b.normal;
  const bool at_corner = a.at.x == b.at.x && a.at.y == b.at.y;  // of the base: there the bisectors meet
  if (turn != 0 && !at_corner && dot(u, u) > 3.99 && u.y < 1.9 && shared_end(a, b, i, k)) {
    // Their own bisector starts in the shared vertex along the sum of the normals: sharp even where they are nearly
    // parallel.
    const Vector<Real> q = a.places[i];
    const Real x = q.x + u.x * q.y / (dot(u, u) / 2 - u.y);
    return turn > 0 ? Stretches<Real>::between(-infinite<Real>(), x) : Stretches<Real>::between(x, infinite<Real>());
  }
  const Real rise = a.at.y - b.at.y + a.slope * (b.at.x - a.at.x);  // a above b where b's place is
  if (turn == 0) return rise > 0 ? Stretches<Real>::all() : Stretches<Real>::nowhere();
  // From the place on the steeper one, near which they meet.
  const bool a_steeper = kernel::absolute(a.slope) > kernel::absolute(b.slope);
  const Real x = a_steeper ? a.at.x + (a.at.y - b.at.y - b.slope * (a.at.x - b.at.x)) / turn : b.at.x + rise / turn;
  return turn > 0 ? Stretches<Real>::between(-infinite<Real>(), x) : Stretches<Real>::between(x, infinite<Real>());
}

template <class Real>
Stretches<Real> nearer_point_than_horizon(const SideCurve<Real>& point, Real horizon) {
  const Real square = point.at.y * (2 * horizon - point.at.y);
  if (!(square > 0)) return Stretches<Real>::nowhere();
  const Real half = kernel::square_root(square);
  return Stretches<Real>::between(point.at.x - half, point.at.x + half);
}

/// Where curve b is below curve a.
template <class Real>
Stretches<Real> nearer(const SideCurve<Real>& b, const SideCurve<Real>& a) {
  if (a.label == none && !b.is_line) return nearer_point_than_horizon(b, a.at.y);
  if (a.label == b.label) return Stretches<Real>::nowhere();
  if (a.is_line && b.is_line) return nearer_line(b, a);
  if (a.is_line) return nearer_point_than_line(b, a, true);
  if (b.is_line) return nearer_point_than_line(a, b, false);
  return nearer_point(b, a);
}

/// The face of an open segment's side: between the perpendiculars at its ends, below the bisectors with all other
/// sites.
template <class Real>
class SideCell {
 public:
  using Curve = SideCurve<Real>;

  explicit SideCell(const Sites& sites) : sites_(sites) {}
  void start(Index element);
  /// Takes parts of a site (a segment with the vertices it brings along, or an isolated vertex) into account; returns
  /// true if the face changed.
  bool add_site(Index site, SiteParts parts);

  Index element() const { return element_; }
  Real length() const { return length_; }
  /// What counts as near, in a search: the stretch of the piece in work.
  Real size() const { return arcs().back().end - arcs().front().begin; }
  /// The middle of that stretch, in the plane relative to the vertex the side starts from.
  Vector<Real> middle() const { return plane({(arcs().front().begin + arcs().back().end) / 2, Real(0)}); }
  bool is_own(Index site) const { return site == element_ >> 1; }
  const std::vector<typename Envelope<Real, Curve>::Arc>& arcs() const { return envelope_.arcs(); }
  const Envelope<Real, Curve>& envelope() const { return envelope_; }
  Envelope<Real, Curve>& envelope() { return envelope_; }
  /// True if double precision cannot tell on which side of the base a site lies that matters; neighbours might not
  /// notice.
  bool is_uncertain() const { return uncertain_; }
  /// What the border begins (0) or ends (1) with, even if that stretch is too short to be seen.
  Index corner(int end) const { return sites_.corner(element_, end); }
  /// A vertex in the side's frame.
  Vector<Real> locate(Index vertex) const { return rotate(sites_.template difference<Real>(vertex, ends_.from)); }
  Vector<Real> rotate(Vector<Real> v) const { return {dot(v, u_), v.x * u_.y - v.y * u_.x}; }
  /// From the frame to the plane, relative to the vertex the side starts from.
  Vector<Real> plane(Vector<Real> p) const { return {p.x * u_.x + p.y * u_.y, p.x * u_.y - p.y * u_.x}; }
  Instance::Ends ends() const { return ends_; }

 private:
  void insert(const Curve& curve, Real low, Real high) { changed_ = envelope_.insert(curve, low, high) || changed_; }
  /// Centre of the circle that touches the base and, from the normal's side, a line at its end q.
  Vector<Real> touching(Vector<Real> q, Vector<Real> n) const {
    const Real r = q.y / one_minus_y(n);
    return {q.x + r * n.x, r};
  }
  void look_at(Vector<Real> q);
  void add_vertex(Index vertex, Vector<Real> q);
  void add_segment(Index segment, SiteParts parts);
  void add_sides(Index segment, SiteParts parts, Vector<Real> a, Vector<Real> b);
  void add_incident(Curve line, bool at_end, Vector<Real> other, Vector<Real> away, bool reversed);
  void add_line(Curve line, Vector<Real> normal, Vector<Real> anchor, Vector<Real> place, Real low, Real high);

  const Sites& sites_;
  Index element_ = none;
  Instance::Ends ends_{};
  Vector<Real> u_{};
  Real length_ = 0;
  bool changed_ = false, uncertain_ = false;
  Envelope<Real, Curve> envelope_;
};

extern template class SideCell<double>;
extern template class SideCell<Twofold>;
extern template class SideCell<quad>;
extern template class SideCell<wide>;

}  // namespace krepl::voronoi
