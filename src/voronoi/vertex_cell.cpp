#include "voronoi/vertex_cell.hpp"

namespace krepl::voronoi {
namespace {

template <class Real>
Vector<Real> unit(Vector<Real> v) {
  const Real l = length(v);
  return {v.x / l, v.y / l};
}

/// Sectors below this are not told from nothing.
template <class Real>
constexpr double thin = 0x1p-40;
template <>
constexpr double thin<Twofold> = 0;
template <>
constexpr double thin<quad> = 0;
template <>
constexpr double thin<wide> = 0;

/// The vertex's bisector with a point q, mirrored: a centre in direction u sees q in the direction that u's mirror
/// image is.
template <class Real>
Vector<Real> mirrored(Vector<Real> n, Vector<Real> q) {
  const Real f = 2 * dot(n, q) / dot(q, q);
  return {n.x - f * q.x, n.y - f * q.y};
}

/// The chart's parameter of a direction u within 90 degrees of q; beyond the chart, the end that q lies nearer to.
template <class Real>
Real chart_parameter(Vector<Real> u, Vector<Real> q) {
  if (u.x > 0) return u.y / u.x;
  return q.y >= 0 ? infinite<Real>() : -infinite<Real>();
}

}  // namespace

template <class Real>
void VertexCell<Real>::add_chart(Vector<Real> middle, Vector<Real> low, Vector<Real> high) {
  Chart& c = chart_[charts_++];
  c.middle = middle;
  const Vector<Real> l = c.rotate(low), h = c.rotate(high);
  c.low = l.y / l.x, c.high = h.y / h.x;
  Curve horizon;
  horizon.c = 1 / Real(sites_.horizon());
  c.envelope.start(c.low, c.high, horizon);
}

template <class Real>
bool VertexCell<Real>::start(Index vertex) {
  vertex_ = vertex;
  sector_ = sites_.instance().sector(vertex);
  charts_ = 0;
  uncertain_ = false;
  beside_[0] = beside_[1] = none;
  if (is_isolated()) {
    const Real h = kernel::square_root(Real(0.5));
    const Vector<Real> corner[5] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    const Vector<Real> middle[4] = {{h, h}, {-h, h}, {-h, -h}, {h, -h}};
    for (int i = 0; i < 4; ++i) add_chart(middle[i], corner[i], corner[i + 1]);
    return true;
  }
  const auto before = sites_.instance().ends(sector_.before), after = sites_.instance().ends(sector_.after);
  beside_[0] = before.from, beside_[1] = after.to;
  const Vector<Real> low = sites_.normal<Real>(sector_.before), high = sites_.normal<Real>(sector_.after);
  const Real cosine = dot(low, high);
  const Vector<Real> sum = low + high;
  if (cosine > 0) {
    add_chart(unit(sum), low, high);
  } else {
    // A sector of nearly 180 degrees opens where its first side is heading.
    const Vector<Real> split = cosine > -0.9 ? unit(sum) : Vector<Real>{-low.y, low.x};
    add_chart(unit(low + split), low, split);
    add_chart(unit(split + high), split, high);
  }
  for (int i = 0; i < charts_; ++i) {
    if (!(chart_[i].high - chart_[i].low > thin<Real>)) return false;
  }
  return true;
}

template <class Real>
bool VertexCell<Real>::add_site(Index site, SiteParts parts) {
  changed_ = false;
  const auto s = sites_.instance().site(site);
  const Vector<Real> a = locate(s.a), b = locate(s.b);
  if (s.a != vertex_ && s.b != vertex_) {
    if (s.a == s.b) {
      add_vertex(s.a, a);
      return changed_;
    }
    if (parts & both_sides) add_line(site, a, b);
  }
  if ((parts & start_vertex) && s.a != vertex_ && sites_.owner(s.a) == site) add_vertex(s.a, a);
  if ((parts & end_vertex) && s.b != vertex_ && sites_.owner(s.b) == site) add_vertex(s.b, b);
  return changed_;
}

/// Of the bisector, only the part where the other vertex sees the centre within its own sector.
template <class Real>
void VertexCell<Real>::add_vertex(Index vertex, Vector<Real> q) {
  if (vertex == beside_[0] || vertex == beside_[1]) return;  // at a right angle to the sector's side: behind it
  const auto sector = sites_.instance().sector(vertex);
  if (sector.before == none) return;
  const bool whole = !sites_.is_side(sector.before);
  Vector<Real> first{}, last{};
  if (!whole) {
    first = sites_.normal<Real>(sector.after), last = sites_.normal<Real>(sector.before);
    if (dot(first, q) > 0 && dot(last, q) > 0) return;  // it faces away
  }
  for (int i = 0; i < charts_; ++i) {
    Chart& chart = chart_[i];
    Curve curve;
    curve.label = sites_.instance().circle(vertex);
    curve.at = chart.rotate(q);
    const Real f = 2 / dot(curve.at, curve.at);
    curve.w = f * curve.at;
    Real low = -infinite<Real>(), high = infinite<Real>();
    if (!whole && !(dot(first, q) > 0)) low = chart_parameter(chart.rotate(mirrored(first, q)), curve.at);
    if (!whole && !(dot(last, q) > 0)) high = chart_parameter(chart.rotate(mirrored(last, q)), curve.at);
    changed_ = chart.envelope.insert(curve, low, high) || changed_;
  }
}

template <class Real>
void VertexCell<Real>::add_line(Index segment, Vector<Real> a, Vector<Real> b) {
  const Vector<Real> d = sites_.direction<Real>(segment);
  const Vector<Real> right{d.y, -d.x};
  const Real to_a = dot(right, a), to_b = dot(right, b);
  const bool a_nearer = dot(a, a) < dot(b, b);
  const Real signed_distance = a_nearer ? to_a : to_b;
  const Real nearest = std::min(dot(a, a), dot(b, b)), error = narrow<Real> * (length(a) + length(b));
  if (kernel::absolute(signed_distance) <= error) {
    const bool beside = dot(a, d) <= 0 && dot(b, d) >= 0;
    if (beside || nearest <= 2 * error * Real(sites_.horizon())) uncertain_ = true;
    if (signed_distance == 0) return;
  }
  const bool on_right = signed_distance < 0;
  const Vector<Real> n = on_right ? right : Vector<Real>{-right.x, -right.y};
  // Seen from the vertex, the side's start is counter-clockwise of its end.
  const Vector<Real> first = mirrored(n, on_right ? b : a), last = mirrored(n, on_right ? a : b);
  for (int i = 0; i < charts_; ++i) {
    Chart& chart = chart_[i];
    Curve curve;
    curve.label = 2 * segment + (on_right ? 0u : 1u);
    curve.is_line = true;
    curve.at = chart.rotate(a_nearer ? a : b);
    curve.normal = chart.rotate(n);
    curve.distance = kernel::absolute(signed_distance);
    curve.ends[0] = sites_.instance().site(segment).a, curve.ends[1] = sites_.instance().site(segment).b;
    curve.places[0] = chart.rotate(a), curve.places[1] = chart.rotate(b);
    curve.c = 1 / curve.distance;
    curve.w = (-curve.c) * curve.normal;
    const auto range = chart_stretches(chart.rotate(first), chart.rotate(last));
    for (int k = 0; k < range.count; ++k) {
      changed_ = chart.envelope.insert(curve, range.stretch[k].low, range.stretch[k].high) || changed_;
    }
  }
}

template class VertexCell<double>;
template class VertexCell<Twofold>;
template class VertexCell<quad>;
template class VertexCell<wide>;

}  // namespace krepl::voronoi
