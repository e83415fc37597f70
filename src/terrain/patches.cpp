#include "terrain/patches.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "kernel/orientation.hpp"

namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

namespace {

/// Angles below this, in radians, count as flat or straight: what is left out is 2^-36 R wide.
constexpr double flat_angle = 0x1p-36;

template <class Real>
struct Vector3 {
  Real x, y, z;
  Vector3 operator-() const { return {-x, -y, -z}; }
  friend Vector3 operator+(Vector3 v, Vector3 w) { return {v.x + w.x, v.y + w.y, v.z + w.z}; }
  friend Vector3 operator-(Vector3 v, Vector3 w) { return {v.x - w.x, v.y - w.y, v.z - w.z}; }
};
template <class Real>
Vector3<Real> vector(Point3 p) {
  return {p.x, p.y, p.z};
}
template <class Real>
Real dot(Vector3<Real> v, Vector3<Real> w) {
  return v.x * w.x + v.y * w.y + v.z * w.z;
}
template <class Real>
Vector3<Real> cross(Vector3<Real> v, Vector3<Real> w) {
  return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
}
template <class Real>
Real length(Vector3<Real> v) {
  return square_root(dot(v, v));
}

template <class Real>
struct Rectangle {
  BoxOf<Real> box{{1e300, 1e300}, {-1e300, -1e300}};
  void add(PointOf<Real> p, Real margin) {
    box.low = {std::min(box.low.x, p.x - margin), std::min(box.low.y, p.y - margin)};
    box.high = {std::max(box.high.x, p.x + margin), std::max(box.high.y, p.y + margin)};
  }
};

/// Direction of an edge out of one of its ends: unit, in space.
template <class Real, class EdgeFrame>
Vector3<Real> outward(const EdgeFrame& e, bool at_a) {
  const Vector3<Real> d{e.gx / e.q, e.gy / e.q, e.m / e.q};
  return at_a ? d : -d;
}

template <class Real>
PointOf<Real> place_of(Point3 p) {
  return {p.x, p.y};
}

/// Triangles whose height is less than this part of a side: rounding makes much of their normals, which are computed
/// with twice the digits. What bounds their patches from different sides would not fit together else.
constexpr double thin = 0x1p-10;

/// Where a place lies as seen along the edge from a to b: to the left, and up.
std::pair<double, double> across_in_full(Point3 a, Point3 b, Point3 place) {
  using Real = DoubleDouble;
  const Vector3<Real> d = vector<Real>(b) - vector<Real>(a), w = vector<Real>(place) - vector<Real>(a);
  const Real flat = norm(d.x, d.y), gx = d.x / flat, gy = d.y / flat, m = d.z / flat;
  return {double(w.y * gx - w.x * gy), double((w.z - m * (w.x * gx + w.y * gy)) / square_root(1 + m * m))};
}

/// The unit normal of a triangle.
template <class Real>
Vector3<Real> normal_of(Point3 a, Point3 b, Point3 c) {
  const Vector3<Real> u = vector<Real>(b) - vector<Real>(a), v = vector<Real>(c) - vector<Real>(a), n = cross(u, v);
  const Real size = length(n);
  if constexpr (!is_fine<Real>) {
    if (size < thin * (length(u) * length(v))) {
      const Vector3<DoubleDouble> full = normal_of<DoubleDouble>(a, b, c);
      return {double(full.x), double(full.y), double(full.z)};
    }
  }
  return {n.x / size, n.y / size, n.z / size};
}

}  // namespace

/// The normals that a ball touching a vertex from above can have: a convex polygon on the upper unit hemisphere, the
/// part where u . d <= 0 for the directions d of all edges. Its sides belong to convex edges or to the horizon.
template <class Real>
class PatchSet<Real>::NormalPolygon {
 public:
  using Vector = Vector3<Real>;

  void clear() {
    direction_.clear();
    side_.clear();
    corner_.clear();
  }
  void add_edge(Vector direction, bool convex) {
    direction_.push_back(direction);
    if (convex) side_.push_back(direction);
  }
  /// Finds the corners.
  void close() {
    side_.push_back({0, 0, -1});
    for (std::size_t i = 0; i < side_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Vector u = cross(side_[i], side_[j]);
        const Real l = length(u);
        if (!(l > 0)) continue;
        // Of two sides that are nearly parallel the corner is known the less.
        const Real slack = Precision<Real>::corner + Precision<Real>::rounding / l;
        const Vector unit{u.x / l, u.y / l, u.z / l};
        add_corner(unit, slack);
        add_corner(-unit, slack);
      }
    }
  }
  /// False if it has no inside wider than flat_angle.
  bool has_inside() const {
    if (corner_.size() < 2) return false;
    Vector middle{0, 0, 0};
    for (const Vector c : corner_) middle = middle + c;
    if (is_inside(middle)) return true;
    // Two opposite corners: between the two sides that meet in both.
    for (std::size_t i = 0; i < side_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (is_inside(-(side_[i] + side_[j]))) return true;
      }
    }
    return false;
  }
  std::span<const Vector> corners() const { return corner_; }

 private:
  void add_corner(Vector u, Real slack) {
    if (u.z < -slack) return;
    for (const Vector d : direction_) {
      if (dot(u, d) > slack) return;
    }
    // Edges in one plane all give the same.
    for (const Vector c : corner_) {
      if (dot(u - c, u - c) <= slack * slack) return;
    }
    corner_.push_back(u);
  }
  bool is_inside(Vector u) const {
    const Real least = flat_angle * length(u);
    if (!(u.z > least)) return false;
    for (const Vector d : direction_) {
      if (!(dot(u, d) < -least)) return false;
    }
    return true;
  }

  std::vector<Vector> direction_, side_, corner_;
};

template <class Real>
void PatchSet<Real>::build(const TerrainWindow& window, double radius) {
  window_ = &window;
  radius_ = radius;
  square_radius_ = radius_ * radius_;
  patches_.clear();
  boxes_.clear();
  bounds_.clear();
  corners_.clear();
  overlaps_.clear();
  edges_.assign(window.edges().size(), {});
  face_patch_.assign(window.faces().size(), none);
  for (Index e = 0; e < edges_.size(); ++e) {
    place(e);
    if (window.edges()[e].core) examine(e);
  }
  // Numbers first, since neighbours name each other: faces, edges, vertices.
  Index number = 0;
  for (Index f = 0; f < face_patch_.size(); ++f) {
    if (window.faces()[f].core && !window.faces()[f].vertical) face_patch_[f] = number++;
  }
  for (EdgeFrame& e : edges_) {
    if (e.shape == EdgeShape::convex) e.patch = number++;
  }
  patches_.reserve(number + window.vertices().size() / 2);
  bounds_.reserve(4 * patches_.capacity());
  patches_.resize(number);
  boxes_.resize(number);
  for (Index v = 0; v < window.vertices().size(); ++v) {
    if (window.vertices()[v].core) add_vertex(v);
  }
  for (Index f = 0; f < face_patch_.size(); ++f) {
    if (face_patch_[f] != none) add_face(f);
  }
  for (Index e = 0; e < edges_.size(); ++e) {
    if (edges_[e].patch != none) add_edge(e);
  }
  for (Patch& p : patches_) {
    const std::span<const Bound> sides{bounds_.data() + p.first_bound, p.bound_count};
    p.has_rim = std::any_of(sides.begin(), sides.end(), [](const Bound& b) { return b.rim; });
  }
  if (!window.is_graph()) find_overlaps();
}

/// Where an edge is, and in a refined set which normals its triangles leave free.
template <class Real>
void PatchSet<Real>::place(Index i) {
  EdgeFrame& e = edges_[i];
  if (e.placed) return;
  e.placed = true;
  if (coarse_ != nullptr) placed_list_.push_back(i);
  const auto& edge = window_->edges()[i];
  const Point3 a = window_->vertices()[edge.a].at, b = window_->vertices()[edge.b].at;
  e.a = place_of<Real>(a);
  e.z = a.z;
  const Real dx = Real(b.x) - a.x, dy = Real(b.y) - a.y;
  e.length = norm(dx, dy);
  if (e.length == 0) {
    e.z = std::max(a.z, b.z);
    return;
  }
  e.gx = dx / e.length;
  e.gy = dy / e.length;
  e.m = (Real(b.z) - a.z) / e.length;
  e.q = square_root(1 + e.m * e.m);
  if (coarse_ == nullptr) return;
  const auto& model = coarse_->edges_[i];
  e.shape = model.shape;
  e.lo_face = model.lo_face;
  e.hi_face = model.hi_face;
  if (e.lo_face != none) {
    const Limit l = limit(i, e.lo_face);
    e.lo = l.b, e.lo_up = l.up;
  }
  if (e.hi_face != none) {
    const Limit l = limit(i, e.hi_face);
    e.hi = l.b, e.hi_up = l.up;
  }
}

template <class Real>
typename PatchSet<Real>::Limit PatchSet<Real>::limit(Index i, Index f) const {
  const auto& edge = window_->edges()[i];
  const auto& face = window_->faces()[f];
  const EdgeFrame& e = edges_[i];
  const Point3 a = window_->vertices()[edge.a].at, b = window_->vertices()[edge.b].at;
  const Index third = face.vertex[0] + face.vertex[1] + face.vertex[2] - edge.a - edge.b;
  const Point3 at = window_->vertices()[third].at;
  const Vector3<Real> w = vector<Real>(at) - vector<Real>(a);
  const Real along = w.x * e.gx + w.y * e.gy;
  Real aside = w.y * e.gx - w.x * e.gy, up = (w.z - e.m * along) / e.q;
  if constexpr (!is_fine<Real>) {
    if (norm(aside, up) < thin * length(w)) std::tie(aside, up) = across_in_full(a, b, at);
  }
  if (face.vertical) aside = 0;
  if (aside == 0) return {0, 0, Limit::Side::upright, up > 0};
  const Real size = norm(aside, up);
  return {(aside > 0 ? -up : up) / size, absolute(aside) / size, aside > 0 ? Limit::Side::left : Limit::Side::right,
          false};
}

/// Which normals the triangles at an edge leave free (engines.md, section 3).
template <class Real>
void PatchSet<Real>::examine(Index i) {
  EdgeFrame& e = edges_[i];
  if (e.length == 0) return;
  for (const Index f : window_->faces_of_edge(i)) {
    const Limit l = limit(i, f);
    if (l.above) return;
    if (l.side == Limit::Side::left && (e.hi_face == none || l.b < e.hi)) e.hi = l.b, e.hi_up = l.up, e.hi_face = f;
    if (l.side == Limit::Side::right && (e.lo_face == none || l.b > e.lo)) e.lo = l.b, e.lo_up = l.up, e.lo_face = f;
  }
  if (is_below_another(i)) return;
  const Real sine = e.hi * e.lo_up - e.lo * e.hi_up, cosine = e.hi * e.lo + e.hi_up * e.lo_up;
  if (sine > flat_angle || (cosine < 0 && e.hi > e.lo)) {
    e.shape = EdgeShape::convex;
  } else if (sine >= -flat_angle && cosine > 0 && e.lo_face != none && e.hi_face != none) {
    e.shape = EdgeShape::flat;
  }
}

/// True if another edge runs above this one from one of its ends, in its vertical plane and at least as far: the sum with that
/// one alone is higher wherever a ball touches this one, but by next to nothing beside the wall they share.
template <class Real>
bool PatchSet<Real>::is_below_another(Index i) const {
  if (window_->is_graph()) return false;
  const auto& edge = window_->edges()[i];
  for (const Index v : {edge.a, edge.b}) {
    const Point3 from = window_->vertices()[v].at, to = window_->vertices()[edge.a + edge.b - v].at;
    const bool along_x = std::fabs(to.x - from.x) >= std::fabs(to.y - from.y);
    const auto way = [&](Point3 p) { return along_x ? p.x : p.y; };
    const bool forward = way(to) > way(from);
    for (const Index j : window_->edges_of_vertex(v)) {
      const auto& other = window_->edges()[j];
      const Point3 end = window_->vertices()[other.a + other.b - v].at;
      if (j == i || (forward ? way(end) < way(to) : way(end) > way(to))) continue;
      if (kernel::orientation({from.x, from.y}, {to.x, to.y}, {end.x, end.y}) != 0) continue;
      const int above = kernel::orientation({way(from), from.z}, {way(to), to.z}, {way(end), end.z});
      if (forward ? above > 0 : above < 0) return true;
    }
  }
  return false;
}

/// The numbers of a bound; what it means to its patch is left open.
template <class Real>
BoundOf<Real> PatchSet<Real>::bound(const Patch& p, BoundSource source, Index edge) const {
  if (source == BoundSource::rim) return {p.at, 0, 0, 0, BoundType::disc, true, none, true, source, none};
  const EdgeFrame& e = edges_[edge];
  Bound b{e.a, -e.gy, e.gx, 0, BoundType::line, false, none, false, source, edge};
  switch (source) {
    case BoundSource::low:
      b.c = radius_ * e.lo;
      break;
    case BoundSource::high:
      b.c = radius_ * e.hi;
      break;
    case BoundSource::middle:
      b.c = radius_ * (e.lo + e.hi) / 2;
      break;
    case BoundSource::face:
      b.c = radius_ * (p.gx * e.gy - p.gy * e.gx) / p.q;
      break;
    case BoundSource::start:
      return {e.a, e.gx, e.gy, e.m, BoundType::cone, false, none, false, source, edge};
    case BoundSource::end: {
      const Point at = place_of<Real>(window_->vertices()[window_->edges()[edge].b].at);
      return {at, -e.gx, -e.gy, -e.m, BoundType::cone, false, none, false, source, edge};
    }
    case BoundSource::rim:
      break;
  }
  return b;
}

template <class Real>
const typename PatchSet<Real>::NormalPolygon& PatchSet<Real>::normals_of(Index v) const {
  thread_local NormalPolygon polygon;  // its vectors are used again
  polygon.clear();
  for (const Index i : window_->edges_of_vertex(v)) {
    const EdgeFrame& e = edges_[i];
    if (e.length == 0) continue;
    polygon.add_edge(outward<Real>(e, window_->edges()[i].a == v), e.shape == EdgeShape::convex);
  }
  polygon.close();
  return polygon;
}

/// The sphere about a vertex, where the normals that all its edges leave free have an inside.
template <class Real>
void PatchSet<Real>::add_vertex(Index v) {
  const Point3 at = window_->vertices()[v].at;
  bool open = true, has_convex = false;
  for (const Index i : window_->edges_of_vertex(v)) {
    const auto& edge = window_->edges()[i];
    has_convex = has_convex || edges_[i].shape == EdgeShape::convex;
    if (edges_[i].length == 0) open = open && window_->vertices()[edge.a == v ? edge.b : edge.a].at.z < at.z;
  }
  if (!open || !has_convex) return continue_straight(v);
  const NormalPolygon& polygon = normals_of(v);
  if (!polygon.has_inside()) return continue_straight(v);

  const Index patch = Index(patches_.size());
  Patch p{};
  p.kind = FeatureKind::vertex;
  p.feature = window_->vertices()[v].feature;
  p.item = v;
  set_vertex(p);
  set_corners(p, polygon);
  p.first_bound = Index(bounds_.size());
  for (const Index i : window_->edges_of_vertex(v)) {
    EdgeFrame& e = edges_[i];
    if (e.length == 0) continue;
    const bool at_a = window_->edges()[i].a == v;
    Bound b = bound(p, at_a ? BoundSource::start : BoundSource::end, i);
    Real nearest = -1;
    for (const Vector3<Real> u : polygon.corners())
      nearest = std::max(nearest, (u.x * b.nx + u.y * b.ny + u.z * b.c) / e.q);
    if (nearest < -1e-9) continue;  // the others imply it
    b.negative = true;
    b.partner = e.patch;
    bounds_.push_back(b);
    if (e.patch != none) e.end_patch[at_a ? 0 : 1] = patch;
  }
  bool to_horizon = false;
  Rectangle<Real> r;
  Real widest = 0;
  for (const Vector3<Real> c : polygon.corners()) {
    for (const Vector3<Real> d : polygon.corners()) widest = std::max(widest, length(c - d));
    to_horizon = to_horizon || c.z < 1e-9;
  }
  const Real bulge = 1 - square_root(std::max(Real(0), 1 - widest * widest / 4)) + 1e-12;  // of a side over its chord
  for (std::size_t k = 0; k < p.corner_count; ++k) r.add(corners_[p.first_corner + k], radius_ * bulge);
  if (to_horizon) bounds_.push_back(bound(p, BoundSource::rim, none));
  p.bound_count = Index(bounds_.size()) - p.first_bound;
  patches_.push_back(p);
  boxes_.push_back(r.box);
}

/// Two edges in one line: their cylinders continue each other without a sphere between them.
template <class Real>
void PatchSet<Real>::continue_straight(Index v) {
  const auto around = window_->edges_of_vertex(v);
  const auto at_a = [&](Index i) { return window_->edges()[i].a == v; };
  for (std::size_t i = 0; i < around.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EdgeFrame &e = edges_[around[i]], &f = edges_[around[j]];
      if (e.patch == none || f.patch == none) continue;
      const Vector3<Real> u = outward<Real>(e, at_a(around[i])), w = outward<Real>(f, at_a(around[j]));
      if (length(cross(u, w)) > flat_angle || dot(u, w) > 0) continue;
      e.end_patch[at_a(around[i]) ? 0 : 1] = f.patch;
      f.end_patch[at_a(around[j]) ? 0 : 1] = e.patch;
    }
  }
}

template <class Real>
void PatchSet<Real>::set_vertex(Patch& p) {
  const Point3 at = window_->vertices()[p.item].at;
  p.at = place_of<Real>(at);
  p.z = at.z;
  p.top = p.z + radius_;
}

template <class Real>
void PatchSet<Real>::set_corners(Patch& p, const NormalPolygon& polygon) {
  p.first_corner = Index(corners_.size());
  p.corner_count = Index(polygon.corners().size());
  for (const Vector3<Real> c : polygon.corners()) corners_.push_back({p.at.x + radius_ * c.x, p.at.y + radius_ * c.y});
}

template <class Real>
void PatchSet<Real>::add_edge(Index i) {
  const EdgeFrame& e = edges_[i];
  Patch& p = patches_[e.patch];
  p.kind = FeatureKind::edge;
  p.feature = window_->edges()[i].feature;
  p.item = i;
  set_edge(p);
  p.first_bound = Index(bounds_.size());
  for (const bool high : {true, false}) {
    const Index face = high ? e.hi_face : e.lo_face;
    Bound b = bound(p, high ? BoundSource::high : BoundSource::low, i);
    b.negative = high;
    b.partner = face == none ? none : face_patch_[face];
    b.rim = face == none;
    bounds_.push_back(b);
  }
  for (int end = 0; end < 2; ++end) {
    const Index other = e.end_patch[end];
    Bound b = bound(p, end == 0 ? BoundSource::start : BoundSource::end, i);
    if (other != none && patches_[other].kind != FeatureKind::vertex && other < e.patch) {
      // The straight neighbour with the lower number has the function, so that the two agree.
      for (const Bound& theirs : bounds(other)) {
        if (theirs.partner != e.patch || theirs.type != BoundType::cone) continue;
        b = theirs;
        b.negative = true;
      }
    }
    b.partner = other;
    bounds_.push_back(b);
  }
  p.bound_count = Index(bounds_.size()) - p.first_bound;
  const Real most_up = e.lo < 0 && e.hi > 0 ? Real(1) : std::max(e.lo_up, e.hi_up),
             least_up = std::min(e.lo_up, e.hi_up);
  const Point3 b = window_->vertices()[window_->edges()[i].b].at;
  Rectangle<Real> r;
  for (const Real up : {least_up, most_up}) {
    const Real shift = -e.m / e.q * up * radius_;
    for (const Real aside : {e.lo * radius_, e.hi * radius_}) {
      for (const Point end : {e.a, place_of<Real>(b)}) {
        r.add({end.x + shift * e.gx - aside * e.gy, end.y + shift * e.gy + aside * e.gx}, 1e-12 * radius_);
      }
    }
  }
  boxes_[e.patch] = r.box;
}

template <class Real>
void PatchSet<Real>::set_edge(Patch& p) {
  const EdgeFrame& e = edges_[p.item];
  const Point3 b = window_->vertices()[window_->edges()[p.item].b].at;
  p.at = e.a;
  p.z = e.z;
  p.gx = e.gx;
  p.gy = e.gy;
  p.m = e.m;
  p.q = e.q;
  p.flat = 1 / e.q;
  p.length = e.length;
  const Real most_up = e.lo < 0 && e.hi > 0 ? Real(1) : std::max(e.lo_up, e.hi_up);
  p.top = std::max(e.z, Real(b.z)) + radius_ * most_up / e.q;
  p.first_corner = Index(corners_.size());
  p.corner_count = 4;
  for (const bool at_hi : {false, true}) {
    const Real aside = radius_ * (at_hi ? e.hi : e.lo), shift = -e.m / e.q * (at_hi ? e.hi_up : e.lo_up) * radius_;
    for (const Point end : {e.a, place_of<Real>(b)}) {
      corners_.push_back({end.x + shift * e.gx - aside * e.gy, end.y + shift * e.gy + aside * e.gx});
    }
  }
}

template <class Real>
void PatchSet<Real>::add_face(Index f) {
  const auto& face = window_->faces()[f];
  Patch& p = patches_[face_patch_[f]];
  p.kind = FeatureKind::face;
  p.feature = face.feature;
  p.item = f;
  set_face(p);
  p.first_bound = Index(bounds_.size());
  Rectangle<Real> r;
  for (int i = 0; i < 3; ++i) {
    r.add(corners_[p.first_corner + Index(i)], 1e-12 * radius_);
    const EdgeFrame& e = edges_[face.edge[i]];
    const Point3 third = window_->vertices()[face.vertex[(i + 2) % 3]].at;
    const bool left = (third.y - e.a.y) * e.gx - (third.x - e.a.x) * e.gy > 0;
    const bool at_hi = e.hi_face == f, at_lo = e.lo_face == f;
    BoundSource source = BoundSource::face;
    if (at_hi || at_lo) {
      if (e.shape == EdgeShape::convex) source = at_hi ? BoundSource::high : BoundSource::low;
      if (e.shape == EdgeShape::flat) source = BoundSource::middle;
    }
    Bound b = bound(p, source, face.edge[i]);
    b.negative = source == BoundSource::face ? !left : at_lo;
    if (source == BoundSource::middle)
      b.partner = face_patch_[at_hi ? e.lo_face : e.hi_face];
    else if (source != BoundSource::face)
      b.partner = e.patch;
    bounds_.push_back(b);
  }
  p.bound_count = 3;
  boxes_[face_patch_[f]] = r.box;
}

template <class Real>
void PatchSet<Real>::set_face(Patch& p) {
  const auto& face = window_->faces()[p.item];
  const auto point = [&](int i) { return window_->vertices()[face.vertex[i]].at; };
  const auto at = [&](int i) { return vector<Real>(point(i)); };
  const auto [nx, ny, nz] = normal_of<Real>(point(0), point(1), point(2));
  p.at = {at(0).x + radius_ * nx, at(0).y + radius_ * ny};
  p.z = at(0).z + radius_ * nz;
  p.gx = -nx / nz;
  p.gy = -ny / nz;
  p.q = square_root(1 + p.gx * p.gx + p.gy * p.gy);
  p.flat = nz;
  p.top = std::max({at(0).z, at(1).z, at(2).z}) + radius_ * nz;
  p.first_corner = Index(corners_.size());
  p.corner_count = 3;
  for (int i = 0; i < 3; ++i) corners_.push_back({at(i).x + radius_ * nx, at(i).y + radius_ * ny});
}

template <class Real>
Real PatchSet<Real>::ball_height(Point at, Real z, Point p) const {
  const Real dx = p.x - at.x, dy = p.y - at.y;
  const Real under = square_radius_ - (dx * dx + dy * dy);
  return under > 0 ? z + square_root(under) : below_everything;
}

template <class Real>
Real PatchSet<Real>::height(Index i, Point p) const {
  return contains(i, p) ? extended_height(i, p) : below_everything;
}

template <class Real>
Real PatchSet<Real>::cigar_height(Index edge, Point p) const {
  const EdgeFrame& e = edges_[edge];
  if (e.length == 0) return ball_height(e.a, e.z, p);
  const Real dx = p.x - e.a.x, dy = p.y - e.a.y;
  const Real along = dx * e.gx + dy * e.gy, aside = dy * e.gx - dx * e.gy;
  const Real under = square_radius_ - aside * aside;
  if (!(under > 0)) return below_everything;
  const Real up = square_root(under);
  const Real contact = along + e.m / e.q * up;
  if (contact < 0) return ball_height(e.a, e.z, p);
  if (contact > e.length) {
    return ball_height({e.a.x + e.length * e.gx, e.a.y + e.length * e.gy}, e.z + e.m * e.length, p);
  }
  return e.z + e.m * along + e.q * up;
}

template <class Real>
Real PatchSet<Real>::body_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::vertex) return extended_height(i, p);
  if (f.kind == FeatureKind::edge) {
    const Real dx = p.x - f.at.x, dy = p.y - f.at.y;
    const Real along = dx * f.gx + dy * f.gy, aside = dy * f.gx - dx * f.gy;
    const Real under = square_radius_ - aside * aside;
    if (!(under > 0)) return below_everything;
    const Real up = square_root(under);
    const Real contact = along + f.m * f.flat * up;
    if (contact < 0) return ball_height(f.at, f.z, p);
    if (contact > f.length) {
      return ball_height(f.end(), f.end_z(), p);
    }
    return f.z + f.m * along + f.q * up;
  }
  Real highest = below_everything;
  bool inside = true;
  const auto& sides = window_->faces()[f.item].edge;
  const std::span<const Bound> limits = bounds(i);
  for (int s = 0; s < 3; ++s) {
    if (limits[s].contains(p, square_radius_)) continue;
    inside = false;
    highest = std::max(highest, cigar_height(sides[s], p));
  }
  return inside ? f.z + (f.gx * (p.x - f.at.x) + f.gy * (p.y - f.at.y)) : highest;
}

template class PatchSet<double>;
template class PatchSet<DoubleDouble>;

}  // namespace krepl::terrain
