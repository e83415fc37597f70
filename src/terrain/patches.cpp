#include "terrain/patches.hpp"

#include <algorithm>
#include <array>

namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

namespace {

/// Angles below this, in radians, count as flat or straight: what is left out is 2^-36 R wide.
constexpr double flat_angle = 0x1p-36;

struct Vector3 {
  double x, y, z;
};
Vector3 operator-(Point3 p, Point3 q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
double dot(Vector3 v, Vector3 w) { return v.x * w.x + v.y * w.y + v.z * w.z; }
Vector3 cross(Vector3 v, Vector3 w) { return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x}; }
double length(Vector3 v) { return std::sqrt(dot(v, v)); }

struct Rectangle {
  Point low{1e300, 1e300}, high{-1e300, -1e300};
  void add(double x, double y, double margin = 0) {
    low = {std::min(low.x, x - margin), std::min(low.y, y - margin)};
    high = {std::max(high.x, x + margin), std::max(high.y, y + margin)};
  }
};

/// The normals that a ball touching a vertex from above can have: a convex polygon on the upper unit hemisphere, the part where
/// u . d <= 0 for the directions d of all edges. Its sides belong to convex edges or to the horizon.
class NormalPolygon {
 public:
  static constexpr int most = 64;
  void add_edge(Vector3 direction, bool convex) {
    if (count_ >= most) return;
    direction_[count_++] = direction;
    if (convex) side_[sides_++] = direction;
  }
  /// Finds the corners. False if the polygon has no inside wider than flat_angle.
  bool close() {
    side_[sides_++] = {0, 0, -1};
    for (int i = 0; i < sides_; ++i) {
      for (int j = 0; j < i; ++j) {
        const Vector3 u = cross(side_[i], side_[j]);
        const double l = length(u);
        if (!(l > 0)) continue;
        // Of two sides that are nearly parallel the corner is known the less.
        for (const double sign : {1 / l, -1 / l}) add_corner({sign * u.x, sign * u.y, sign * u.z}, 1e-13 + 1e-15 / l);
      }
    }
    Vector3 middle{0, 0, 0}, inwards{0, 0, 0};
    for (int i = 0; i < corners_; ++i) middle = sum(middle, corner_[i]);
    for (int i = 0; i < sides_; ++i) inwards = {inwards.x - side_[i].x, inwards.y - side_[i].y, inwards.z - side_[i].z};
    return corners_ >= 2 && (is_inside(middle) || is_inside(inwards));
  }
  std::span<const Vector3> corners() const { return {corner_.data(), std::size_t(corners_)}; }

 private:
  static Vector3 sum(Vector3 v, Vector3 w) { return {v.x + w.x, v.y + w.y, v.z + w.z}; }
  void add_corner(Vector3 u, double slack) {
    if (corners_ >= most || u.z < -slack) return;
    for (int i = 0; i < count_; ++i) {
      if (dot(u, direction_[i]) > slack) return;
    }
    corner_[corners_++] = u;
  }
  bool is_inside(Vector3 u) const {
    const double least = flat_angle * length(u);
    if (!(u.z > least)) return false;
    for (int i = 0; i < count_; ++i) {
      if (!(dot(u, direction_[i]) < -least)) return false;
    }
    return true;
  }

  std::array<Vector3, most> direction_, corner_;
  std::array<Vector3, most + 1> side_;
  int count_ = 0, sides_ = 0, corners_ = 0;
};

}  // namespace

void PatchSet::build(const TerrainWindow& window, double radius) {
  radius_ = radius;
  square_radius_ = radius * radius;
  patches_.clear();
  boxes_.clear();
  bounds_.clear();
  corners_.clear();
  face_edges_.clear();
  edges_.assign(window.edges().size(), {});
  faces_.assign(window.faces().size(), {0, 0, 0, none});
  vertex_patch_.assign(window.vertices().size(), none);
  examine_edges(window);
  // Numbers first, since neighbours name each other: faces, edges, vertices.
  Index number = 0;
  for (Index f = 0; f < faces_.size(); ++f) {
    if (window.faces()[f].core && !window.faces()[f].vertical) faces_[f].patch = number++;
  }
  for (Index e = 0; e < edges_.size(); ++e) {
    if (window.edges()[e].core && edges_[e].shape == EdgeFrame::Shape::convex) edges_[e].patch = number++;
  }
  patches_.reserve(number + window.vertices().size() / 2);
  bounds_.reserve(4 * patches_.capacity());
  patches_.resize(number);
  boxes_.resize(number);
  examine_vertices(window);  // adds the vertices' patches
  for (Index f = 0; f < faces_.size(); ++f) {
    if (faces_[f].patch != none) add_face(window, f);
  }
  for (Index e = 0; e < edges_.size(); ++e) {
    if (edges_[e].patch != none) add_edge(window, e);
  }
  for (Patch& p : patches_) {
    const std::span<const Bound> sides{bounds_.data() + p.first_bound, p.bound_count};
    p.has_rim = std::any_of(sides.begin(), sides.end(), [](const Bound& b) { return b.rim; });
  }
}

/// The frame of each edge, and which normals its triangles leave free (engines.md, section 3).
void PatchSet::examine_edges(const TerrainWindow& window) {
  for (Index i = 0; i < edges_.size(); ++i) {
    const auto& edge = window.edges()[i];
    const Point3 a = window.vertices()[edge.a].at, b = window.vertices()[edge.b].at;
    EdgeFrame& e = edges_[i];
    e.a = {a.x, a.y};
    e.z = a.z;
    e.patch = none;
    e.end_patch[0] = e.end_patch[1] = none;
    e.lo_face = e.hi_face = none;
    e.shape = EdgeFrame::Shape::hidden;
    const double dx = b.x - a.x, dy = b.y - a.y;
    e.length = std::sqrt(dx * dx + dy * dy);
    if (e.length == 0) {
      e.z = std::max(a.z, b.z);
      continue;
    }
    e.gx = dx / e.length;
    e.gy = dy / e.length;
    e.m = (b.z - a.z) / e.length;
    e.q = std::sqrt(1 + e.m * e.m);
    if (!edge.core) continue;
    double lo = -1, lo_up = 0, hi = 1, hi_up = 0;
    bool hidden = false;
    for (const Index f : window.faces_of_edge(i)) {
      const auto& face = window.faces()[f];
      const Index third = face.vertex[0] + face.vertex[1] + face.vertex[2] - edge.a - edge.b;
      const Vector3 w = window.vertices()[third].at - a;
      const double along = w.x * e.gx + w.y * e.gy;
      const double aside = face.vertical ? 0.0 : w.y * e.gx - w.x * e.gy;
      const double up = (w.z - e.m * along) / e.q;
      if (face.vertical || aside == 0) {
        hidden = hidden || up > 0;
        continue;
      }
      const double size = std::sqrt(aside * aside + up * up);
      const double b_limit = (aside > 0 ? -up : up) / size, up_limit = std::fabs(aside) / size;
      if (aside > 0 && (e.hi_face == none || b_limit < hi)) hi = b_limit, hi_up = up_limit, e.hi_face = f;
      if (aside < 0 && (e.lo_face == none || b_limit > lo)) lo = b_limit, lo_up = up_limit, e.lo_face = f;
    }
    if (hidden) continue;
    e.lo = lo;
    e.hi = hi;
    const double sine = hi * lo_up - lo * hi_up, cosine = hi * lo + hi_up * lo_up;
    if (sine > flat_angle || (cosine < 0 && hi > lo)) {
      e.shape = EdgeFrame::Shape::convex;
    } else if (sine >= -flat_angle && cosine > 0 && e.lo_face != none && e.hi_face != none) {
      e.shape = EdgeFrame::Shape::flat;
    }
  }
}

void PatchSet::examine_vertices(const TerrainWindow& window) {
  for (Index v = 0; v < vertex_patch_.size(); ++v) {
    if (window.vertices()[v].core) add_vertex(window, v);
  }
}

/// The sphere about a vertex, where the normals that all its edges leave free have an inside.
void PatchSet::add_vertex(const TerrainWindow& window, Index v) {
  const Point3 at = window.vertices()[v].at;
  const auto around = window.edges_of_vertex(v);
  struct Direction {
    double gx, gy, m, q;
    Index edge;
    bool at_a;
  };
  std::array<Direction, 60> direction;
  int count = 0;
  int convex_count = 0;
  NormalPolygon polygon;
  bool open = true;
  for (const Index i : around) {
    const EdgeFrame& e = edges_[i];
    const bool at_a = window.edges()[i].a == v;
    if (e.length == 0) {
      const Index other = at_a ? window.edges()[i].b : window.edges()[i].a;
      open = open && window.vertices()[other].at.z < at.z;
      continue;
    }
    const double sign = at_a ? 1 : -1;
    const Direction d{sign * e.gx, sign * e.gy, sign * e.m, e.q, i, at_a};
    if (e.shape == EdgeFrame::Shape::convex) ++convex_count;
    polygon.add_edge({d.gx / d.q, d.gy / d.q, d.m / d.q}, e.shape == EdgeFrame::Shape::convex);
    if (count < int(direction.size())) direction[count++] = d;
  }
  const auto unit = [](const Direction& d) { return Vector3{d.gx / d.q, d.gy / d.q, d.m / d.q}; };
  open = open && convex_count > 0 && polygon.close();
  if (!open) {
    // Two edges in one line: their cylinders continue each other without a sphere between them.
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < i; ++j) {
        EdgeFrame &e = edges_[direction[i].edge], &f = edges_[direction[j].edge];
        if (e.patch == none || f.patch == none) continue;
        const Vector3 u = unit(direction[i]), w = unit(direction[j]);
        if (length(cross(u, w)) > flat_angle || dot(u, w) > 0) continue;
        e.end_patch[direction[i].at_a ? 0 : 1] = f.patch;
        f.end_patch[direction[j].at_a ? 0 : 1] = e.patch;
      }
    }
    return;
  }

  const Index patch = Index(patches_.size());
  vertex_patch_[v] = patch;
  Patch p{};
  p.kind = FeatureKind::vertex;
  p.feature = window.vertices()[v].feature;
  p.at = {at.x, at.y};
  p.z = at.z;
  p.first_bound = Index(bounds_.size());
  for (int j = 0; j < count; ++j) {
    const Direction& d = direction[j];
    double nearest = -1;
    for (const Vector3 u : polygon.corners()) nearest = std::max(nearest, dot(u, unit(d)));
    if (nearest < -1e-9) continue;  // the others imply it
    const Index beyond = edges_[d.edge].patch;
    bounds_.push_back({p.at, d.gx, d.gy, d.m, Bound::Type::cone, true, beyond, false});
    if (beyond != none) edges_[d.edge].end_patch[d.at_a ? 0 : 1] = patch;
  }
  Rectangle box;
  bool to_horizon = false;
  double widest = 0;
  for (const Vector3 c : polygon.corners()) {
    for (const Vector3 d : polygon.corners()) widest = std::max(widest, length({c.x - d.x, c.y - d.y, c.z - d.z}));
    to_horizon = to_horizon || c.z < 1e-9;
  }
  const double bulge = 1 - std::sqrt(std::max(0.0, 1 - widest * widest / 4)) + 1e-12;  // of a side over its chord
  p.first_corner = Index(corners_.size());
  p.corner_count = Index(polygon.corners().size());
  for (const Vector3 c : polygon.corners()) {
    box.add(at.x + radius_ * c.x, at.y + radius_ * c.y, radius_ * bulge);
    corners_.push_back({at.x + radius_ * c.x, at.y + radius_ * c.y});
  }
  if (to_horizon) bounds_.push_back({p.at, 0, 0, 0, Bound::Type::disc, true, none, true});
  p.bound_count = Index(bounds_.size()) - p.first_bound;
  p.top = at.z + radius_;
  patches_.push_back(p);
  boxes_.push_back({box.low, box.high});
}

void PatchSet::add_edge(const TerrainWindow& window, Index i) {
  const EdgeFrame& e = edges_[i];
  const auto& edge = window.edges()[i];
  const Point3 b = window.vertices()[edge.b].at;
  Patch& p = patches_[e.patch];
  p.kind = FeatureKind::edge;
  p.feature = edge.feature;
  p.at = e.a;
  p.z = e.z;
  p.gx = e.gx;
  p.gy = e.gy;
  p.m = e.m;
  p.q = e.q;
  p.length = e.length;
  p.first_bound = Index(bounds_.size());
  const auto face_patch = [&](Index f) { return f == none ? none : faces_[f].patch; };
  bounds_.push_back({e.a, -e.gy, e.gx, radius_ * e.hi, Bound::Type::line, true, face_patch(e.hi_face), e.hi_face == none});
  bounds_.push_back({e.a, -e.gy, e.gx, radius_ * e.lo, Bound::Type::line, false, face_patch(e.lo_face), e.lo_face == none});
  for (int end = 0; end < 2; ++end) {
    const double sign = end == 0 ? 1 : -1;
    const Point at = end == 0 ? e.a : Point{b.x, b.y};
    Bound bound{at, sign * e.gx, sign * e.gy, sign * e.m, Bound::Type::cone, false, e.end_patch[end], false};
    const Index other = e.end_patch[end];
    if (other != none && other < patches_.size() && patches_[other].kind != FeatureKind::vertex && other < e.patch) {
      // The straight neighbour with the lower number has the function, so that the two agree.
      for (const Bound& theirs : bounds(other)) {
        if (theirs.partner != e.patch || theirs.type != Bound::Type::cone) continue;
        bound = theirs;
        bound.negative = true;
        bound.partner = other;
      }
    }
    bounds_.push_back(bound);
  }
  p.bound_count = Index(bounds_.size()) - p.first_bound;
  p.first_corner = Index(corners_.size());
  p.corner_count = 4;
  const double lo_up = std::sqrt(std::max(0.0, 1 - e.lo * e.lo)), hi_up = std::sqrt(std::max(0.0, 1 - e.hi * e.hi));
  const double most_up = e.lo < 0 && e.hi > 0 ? 1 : std::max(lo_up, hi_up), least_up = std::min(lo_up, hi_up);
  for (const bool at_hi : {false, true}) {
    const double aside = radius_ * (at_hi ? e.hi : e.lo), shift = -e.m / e.q * (at_hi ? hi_up : lo_up) * radius_;
    for (const Point end : {e.a, Point{b.x, b.y}}) {
      corners_.push_back({end.x + shift * e.gx - aside * e.gy, end.y + shift * e.gy + aside * e.gx});
    }
  }
  Rectangle box;
  for (const double up : {least_up, most_up}) {
    const double shift = -e.m / e.q * up * radius_;
    for (const double aside : {e.lo * radius_, e.hi * radius_}) {
      for (const double along : {0.0, e.length}) {
        box.add(e.a.x + (along + shift) * e.gx - aside * e.gy, e.a.y + (along + shift) * e.gy + aside * e.gx, 1e-12 * radius_);
      }
    }
  }
  boxes_[e.patch] = {box.low, box.high};
  p.top = std::max(e.z, b.z) + radius_ * most_up / e.q;
}

void PatchSet::add_face(const TerrainWindow& window, Index f) {
  const auto& face = window.faces()[f];
  const auto at = [&](int i) { return window.vertices()[face.vertex[i % 3]].at; };
  const Vector3 normal = cross(at(1) - at(0), at(2) - at(0));
  const double size = length(normal);
  const double nx = normal.x / size, ny = normal.y / size, nz = normal.z / size;
  Patch& p = patches_[faces_[f].patch];
  p.kind = FeatureKind::face;
  p.feature = face.feature;
  p.at = {at(0).x + radius_ * nx, at(0).y + radius_ * ny};
  p.z = at(0).z + radius_ * nz;
  p.gx = -nx / nz;
  p.gy = -ny / nz;
  p.q = std::sqrt(1 + p.gx * p.gx + p.gy * p.gy);
  p.first_bound = Index(bounds_.size());
  p.length = double(face_edges_.size());
  face_edges_.push_back(face.edge);
  p.first_corner = Index(corners_.size());
  p.corner_count = 3;
  Rectangle box;
  for (int i = 0; i < 3; ++i) {
    corners_.push_back({at(i).x + radius_ * nx, at(i).y + radius_ * ny});
    box.add(at(i).x + radius_ * nx, at(i).y + radius_ * ny, 1e-12 * radius_);
    const EdgeFrame& e = edges_[face.edge[i]];
    const Point3 third = at(i + 2);
    const bool left = (third.y - e.a.y) * e.gx - (third.x - e.a.x) * e.gy > 0;
    Bound bound{e.a, -e.gy, e.gx, radius_ * (ny * e.gx - nx * e.gy), Bound::Type::line, !left, none, false};
    const bool at_hi = e.hi_face == f, at_lo = e.lo_face == f;
    if (e.shape == EdgeFrame::Shape::convex && (at_hi || at_lo) && e.patch != none) {
      bound.c = radius_ * (at_hi ? e.hi : e.lo);
      bound.negative = at_lo;
      bound.partner = e.patch;
    } else if (e.shape == EdgeFrame::Shape::flat && (at_hi || at_lo)) {
      bound.c = radius_ * (e.lo + e.hi) / 2;
      bound.negative = at_lo;
      bound.partner = faces_[at_hi ? e.lo_face : e.hi_face].patch;
    }
    bounds_.push_back(bound);
  }
  p.bound_count = 3;
  boxes_[faces_[f].patch] = {box.low, box.high};
  p.top = std::max({at(0).z, at(1).z, at(2).z}) + radius_ * nz;
}

double PatchSet::ball_height(Point at, double z, Point p) const {
  const double dx = p.x - at.x, dy = p.y - at.y;
  const double under = square_radius_ - (dx * dx + dy * dy);
  return under > 0 ? z + std::sqrt(under) : below_everything;
}

double PatchSet::height(Index i, Point p) const { return contains(i, p) ? extended_height(i, p) : below_everything; }

double PatchSet::cigar_height(Index edge, Point p) const {
  const EdgeFrame& e = edges_[edge];
  if (e.length == 0) return ball_height(e.a, e.z, p);
  const double dx = p.x - e.a.x, dy = p.y - e.a.y;
  const double along = dx * e.gx + dy * e.gy, aside = dy * e.gx - dx * e.gy;
  const double under = square_radius_ - aside * aside;
  if (!(under > 0)) return below_everything;
  const double up = std::sqrt(under);
  const double contact = along + e.m / e.q * up;
  if (contact < 0) return ball_height(e.a, e.z, p);
  if (contact > e.length) {
    return ball_height({e.a.x + e.length * e.gx, e.a.y + e.length * e.gy}, e.z + e.m * e.length, p);
  }
  return e.z + e.m * along + e.q * up;
}

double PatchSet::body_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::vertex) return extended_height(i, p);
  if (f.kind == FeatureKind::edge) {
    const double dx = p.x - f.at.x, dy = p.y - f.at.y;
    const double along = dx * f.gx + dy * f.gy, aside = dy * f.gx - dx * f.gy;
    const double under = square_radius_ - aside * aside;
    if (!(under > 0)) return below_everything;
    const double up = std::sqrt(under);
    const double contact = along + f.m / f.q * up;
    if (contact < 0) return ball_height(f.at, f.z, p);
    if (contact > f.length) {
      return ball_height(f.end(), f.end_z(), p);
    }
    return f.z + f.m * along + f.q * up;
  }
  double highest = below_everything;
  bool inside = true;
  const auto& sides = face_edges_[Index(f.length)];
  const std::span<const Bound> limits = bounds(i);
  for (int s = 0; s < 3; ++s) {
    if (limits[s].contains(p, square_radius_)) continue;
    inside = false;
    highest = std::max(highest, cigar_height(sides[s], p));
  }
  return inside ? f.z + (f.gx * (p.x - f.at.x) + f.gy * (p.y - f.at.y)) : highest;
}

}  // namespace krepl::terrain
