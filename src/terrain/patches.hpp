#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/terrain_window.hpp"
#include "terrain/numbers.hpp"

namespace krepl::terrain {

using Index = std::uint32_t;
inline constexpr Index none = ~Index{0};
inline constexpr double below_everything = -std::numeric_limits<double>::infinity();

enum class BoundType : std::uint8_t {
  line,  ///< (p - at) . n - c
  cone,  ///< (p - at) . n + c sqrt(R^2 - |p - at|^2): the plane through a vertex orthogonal to an edge, on the sphere
  disc   ///< |p - at|^2 - R^2
};

/// What the numbers of a bound follow from.
enum class BoundSource : std::uint8_t {
  low,     ///< of an edge: the last normal to the right that a ball touching it can have
  high,    ///< to the left
  middle,  ///< of a flat edge: between the two
  face,    ///< of an edge: the normal of the patch's face
  start,   ///< of an edge: its first vertex
  end,     ///< its second vertex
  rim      ///< of a vertex, or of a whole body
};

/// What a ball from above sees of an edge; of a flat one no more than of the faces beside it.
enum class EdgeShape : std::uint8_t { hidden, flat, convex };

/// One side of a patch's domain in the plane. Neighbouring patches hold the same numbers with opposite signs, so that
/// exactly one of them owns each point beside a seam, whatever the rounding.
template <class Real>
struct BoundOf {
  using Point = PointOf<Real>;
  using Type = BoundType;
  Point at;
  Real nx, ny, c;
  Type type;
  bool negative;  ///< the patch lies where the value is negative (then zero is not part of it), else where it is >= 0
  Index partner;  ///< the patch beyond, which continues this one smoothly; none: the patch just ends
  bool rim;       ///< it ends in a vertical wall
  BoundSource source;
  Index edge;     ///< of the window, as the source says

  Real value(Point p, Real square_radius) const {
    const Real dx = p.x - at.x, dy = p.y - at.y;
    switch (type) {
      case Type::line: return dx * nx + dy * ny - c;
      case Type::disc: return dx * dx + dy * dy - square_radius;
      case Type::cone: break;
    }
    const Real under = square_radius - (dx * dx + dy * dy);
    return dx * nx + dy * ny + (under > 0 ? c * square_root(under) : Real(0));
  }
  bool contains(Point p, Real square_radius) const { return (value(p, square_radius) < 0) == negative; }
  /// The value times this is negative on the patch's side.
  Real sign() const { return negative ? 1 : -1; }
};
using Bound = BoundOf<double>;

/// The part of the sum's boundary that one feature can cause.
template <class Real>
struct PatchOf {
  using Point = PointOf<Real>;
  Terrain::FeatureKind kind;
  bool has_rim;  ///< one of the bounds is a rim
  bool overlaps;  ///< an edge that continues another one in its line, with a part of its own in common
  Index feature;
  Index item;  ///< number of the face, edge or vertex in the window
  Index first_bound;
  Index bound_count;
  Index first_corner;
  Index corner_count;
  Point at;     ///< a point of the plane, the edge's first vertex, or the vertex
  Real z;       ///< height there (a face's plane is the one moved by R)
  Real gx, gy;  ///< face: gradient; edge: unit direction in the plane
  Real m, q;    ///< edge: rise per unit length in the plane, and sqrt(1 + m^2); face: q is the length of (gx, gy, 1)
  Real flat;    ///< 1 / q: an edge's direction in space is flat (gx, gy, m), a face's normal flat (-gx, -gy, 1)
  Real length;  ///< edge: in the plane
  Real top;     ///< at least its greatest height

  /// Of an edge: its second vertex.
  Point end() const { return {at.x + length * gx, at.y + length * gy}; }
  Real end_z() const { return z + m * length; }
  /// Of an edge: how far along its line from its first vertex, and how far to the left of it, in the plane.
  Real along(Point p) const { return (p.x - at.x) * gx + (p.y - at.y) * gy; }
  Real aside(Point p) const { return (p.y - at.y) * gx - (p.x - at.x) * gy; }
  /// Of an edge: true if a segment of the plane comes nowhere nearer to its line than that.
  bool is_clear_of(Point a, Point b, Real distance) const {
    const Real s = aside(a), t = aside(b);
    return std::min(s, t) >= distance || std::max(s, t) <= -distance;
  }
};

/// All patches that may appear above a rectangle, and their domains.
template <class Real>
class PatchSet {
 public:
  using Point = PointOf<Real>;
  using Box = BoxOf<Real>;
  using Bound = BoundOf<Real>;
  using Patch = PatchOf<Real>;
  using Gradient = GradientOf<Real>;

  /// Patches of the core features of a window, in the order of feature numbers.
  void build(const TerrainWindow& window, double radius);

  /// Instead of that: the same patches in other numbers, each once it is asked for. What kind they are, and what is beside
  /// what, is as `coarse` has it. Both are kept.
  void refine(const TerrainWindow& window, const PatchSet<double>& coarse);
  /// Patches and their sides; vertices without corners.
  void load(std::span<const Index> patches);
  /// Also all corners, and the patches beyond the sides.
  void load_with_corners(std::span<const Index> patches);

  Real radius() const { return radius_; }
  Real square_radius() const { return square_radius_; }
  /// True if no feature lies above or below another.
  bool are_of_graph() const { return window_->is_graph(); }
  std::size_t size() const { return patches_.size(); }
  const Patch& operator[](Index i) const { return patches_[i]; }
  /// Bounding rectangle of the domain.
  const Box& box(Index i) const { return boxes_[i]; }
  std::span<const Bound> bounds(Index i) const { return {bounds_.data() + patches_[i].first_bound, patches_[i].bound_count}; }

  /// Where sides of the domain end; two of them meet nowhere else.
  std::span<const Point> corners(Index i) const {
    return {corners_.data() + patches_[i].first_corner, patches_[i].corner_count};
  }

  /// Height of the patch's whole plane, cylinder or sphere; below_everything where that has none.
  Real extended_height(Index i, Point p) const;
  /// The same within the patch's domain only.
  Real height(Index i, Point p) const;
  bool contains(Index i, Point p) const;
  /// Of extended_height. Steep, but finite, near the rim.
  Gradient gradient(Index i, Point p) const;

  /// Height of a convex body that is part of the sum and has the patch on its boundary: ball, cigar or krepl. Concave in p.
  Real body_height(Index i, Point p) const;

  /// The bound that patches i and j share, as that of i, if they are neighbours; null otherwise. Two edges in one line with a part
  /// in common are neighbours where the one that counts as seen there ends.
  const Bound* seam(Index i, Index j) const;

  /// Of patches that are equally high, true if i is the one that counts as seen.
  bool precedes(Index i, Index j) const;

 private:
  /// What is known of each edge of the window: its frame, and the stretch of normals b in [lo, hi] (components along the left
  /// normal of its direction in the plane) that a ball touching it from above can have.
  struct EdgeFrame {
    Point a;
    Real z, gx, gy, m, q, length;
    Real lo = -1, hi = 1, lo_up = 0, hi_up = 0;
    Index lo_face = none, hi_face = none;  ///< that the stretch ends at; none: horizontal
    EdgeShape shape = EdgeShape::hidden;
    Index end_patch[2] = {none, none};     ///< what continues the patch smoothly beyond a and b
    Index patch = none;
    bool placed = false;
  };
  /// What a triangle leaves of an edge's normals.
  struct Limit {
    Real b, up;
    enum class Side : std::uint8_t { left, right, upright } side;
    bool above;  ///< upright, and above the edge
  };
  class NormalPolygon;

  void place(Index edge);
  Limit limit(Index edge, Index face) const;
  void examine(Index edge);
  bool is_below_another(Index edge) const;
  /// Of the vertex asked for last.
  const NormalPolygon& normals_of(Index vertex) const;
  void find_overlaps();
  void add_face(Index face);
  void add_edge(Index edge);
  void add_vertex(Index vertex);
  void continue_straight(Index vertex);
  void set_face(Patch& p);
  void set_edge(Patch& p);
  void set_vertex(Patch& p);
  void set_corners(Patch& p, const NormalPolygon& polygon);
  Bound bound(const Patch& p, BoundSource source, Index edge) const;
  void prepare();
  void load(Index patch);
  void load_corners(Index patch);
  Real cigar_height(Index edge, Point p) const;
  Real ball_height(Point at, Real z, Point p) const;

  /// A bound that a patch shares with another one, but which is none of its domain, or not with that one.
  struct Overlap {
    Index patch, other;
    Bound side;
  };

  const TerrainWindow* window_ = nullptr;
  const PatchSet<double>* coarse_ = nullptr;
  template <class Other>
  friend class PatchSet;

  Real radius_ = 0, square_radius_ = 0;
  std::vector<Patch> patches_;
  std::vector<Box> boxes_;  // apart from patches_: most patches are told to be elsewhere by their box alone
  std::vector<Bound> bounds_;
  std::vector<Point> corners_;
  std::vector<Overlap> overlaps_;
  std::vector<EdgeFrame> edges_;
  std::vector<Index> face_patch_;
  // Of a refined set:
  std::vector<bool> loaded_;
  std::vector<Index> loaded_list_, placed_list_;  // patches and edges that are there
};

template <class Real>
inline Real PatchSet<Real>::extended_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  const Real dx = p.x - f.at.x, dy = p.y - f.at.y;
  if (f.kind == Terrain::FeatureKind::face) return f.z + (f.gx * dx + f.gy * dy);
  if (f.kind == Terrain::FeatureKind::vertex) {
    const Real under = square_radius_ - (dx * dx + dy * dy);
    return under > 0 ? f.z + square_root(under) : below_everything;
  }
  const Real along = dx * f.gx + dy * f.gy, aside = dy * f.gx - dx * f.gy;
  const Real under = square_radius_ - aside * aside;
  return under > 0 ? f.z + f.m * along + f.q * square_root(under) : below_everything;
}

template <class Real>
inline bool PatchSet<Real>::contains(Index i, Point p) const {
  if (!boxes_[i].contains(p)) return false;
  for (const Bound& b : bounds(i)) {
    if (!b.contains(p, square_radius_)) return false;
  }
  return true;
}

template <class Real>
inline GradientOf<Real> PatchSet<Real>::gradient(Index i, Point p) const {
  const Patch& f = patches_[i];
  if (f.kind == Terrain::FeatureKind::face) return {f.gx, f.gy};
  const Real dx = p.x - f.at.x, dy = p.y - f.at.y;
  const Real least = least_square * square_radius_;
  if (f.kind == Terrain::FeatureKind::vertex) {
    const Real z = square_root(std::max(least, square_radius_ - (dx * dx + dy * dy)));
    return {-dx / z, -dy / z};
  }
  const Real aside = dy * f.gx - dx * f.gy;
  const Real across = -f.q * aside / square_root(std::max(least, square_radius_ - aside * aside));
  return {f.m * f.gx - across * f.gy, f.m * f.gy + across * f.gx};
}

template <class Real>
inline const BoundOf<Real>* PatchSet<Real>::seam(Index i, Index j) const {
  for (const Bound& b : bounds(i)) {
    if (b.partner == j) return &b;
  }
  if (!patches_[i].overlaps) return nullptr;
  for (const Overlap& o : overlaps_) {
    if (o.patch == i && o.other == j) return &o.side;
  }
  return nullptr;
}

template <class Real>
inline bool PatchSet<Real>::precedes(Index i, Index j) const {
  const Patch &f = patches_[i], &g = patches_[j];
  if (f.kind != g.kind) return f.kind > g.kind;  // face, edge, vertex
  // Of two edges in one line the one of which the other may be a part.
  if (f.kind == Terrain::FeatureKind::edge && f.length != g.length) return f.length > g.length;
  return f.feature < g.feature;
}

extern template class PatchSet<double>;
extern template class PatchSet<DoubleDouble>;

}  // namespace krepl::terrain
