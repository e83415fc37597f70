#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "krepl/surface.hpp"
#include "model/terrain_window.hpp"

namespace krepl::terrain {

using Index = std::uint32_t;
inline constexpr Index none = ~Index{0};
inline constexpr double below_everything = -std::numeric_limits<double>::infinity();

struct Gradient {
  double x, y;
};
inline double size(Gradient g) { return std::sqrt(g.x * g.x + g.y * g.y); }

/// An axis-parallel rectangle; of no width or height where it is a stretch of a line.
struct Box {
  Point low, high;
  Point middle() const { return {(low.x + high.x) / 2, (low.y + high.y) / 2}; }
  double half_x() const { return (high.x - low.x) / 2; }
  double half_y() const { return (high.y - low.y) / 2; }
  double larger_side() const { return std::max(high.x - low.x, high.y - low.y); }
  /// Counter-clockwise from the lowest.
  std::array<Point, 4> corners() const { return {low, {high.x, low.y}, high, {low.x, high.y}}; }
  bool contains(Point p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
  bool meets(const Box& b) const { return b.high.x >= low.x && b.low.x <= high.x && b.high.y >= low.y && b.low.y <= high.y; }
};

/// One side of a patch's domain in the plane. Neighbouring patches hold the same numbers with opposite signs, so that
/// exactly one of them owns each point beside a seam, whatever the rounding.
struct Bound {
  enum class Type : std::uint8_t {
    line,  ///< (p - at) . n - c
    cone,  ///< (p - at) . n + c sqrt(R^2 - |p - at|^2): the plane through a vertex orthogonal to an edge, on the sphere
    disc   ///< |p - at|^2 - R^2
  };
  Point at;
  double nx, ny, c;
  Type type;
  bool negative;  ///< the patch lies where the value is negative (then zero is not part of it), else where it is >= 0
  Index partner;  ///< the patch beyond, which continues this one smoothly; none: the patch just ends
  bool rim;       ///< it ends in a vertical wall

  double value(Point p, double square_radius) const {
    const double dx = p.x - at.x, dy = p.y - at.y;
    switch (type) {
      case Type::line: return dx * nx + dy * ny - c;
      case Type::disc: return dx * dx + dy * dy - square_radius;
      default: break;
    }
    const double under = square_radius - (dx * dx + dy * dy);
    return dx * nx + dy * ny + (under > 0 ? c * std::sqrt(under) : 0.0);
  }
  bool contains(Point p, double square_radius) const { return (value(p, square_radius) < 0) == negative; }
  /// The value times this is negative on the patch's side.
  double sign() const { return negative ? 1 : -1; }
};

/// The part of the sum's boundary that one feature can cause.
struct Patch {
  Terrain::FeatureKind kind;
  bool has_rim;  ///< one of the bounds is a rim
  Index feature;
  Index first_bound;
  Index bound_count;
  Index first_corner;
  Index corner_count;
  Point at;       ///< a point of the plane, the edge's first vertex, or the vertex
  double z;       ///< height there (a face's plane is the one moved by R)
  double gx, gy;  ///< face: gradient; edge: unit direction in the plane
  double m, q;    ///< edge: rise per unit length in the plane, and sqrt(1 + m^2); face: q is the length of (gx, gy, 1)
  double length;  ///< edge: in the plane
  double top;     ///< at least its greatest height

  /// Of an edge: its second vertex.
  Point end() const { return {at.x + length * gx, at.y + length * gy}; }
  double end_z() const { return z + m * length; }
};

/// All patches that may appear above a rectangle, and their domains.
class PatchSet {
 public:
  /// Patches of the core features of a window, in the order of feature numbers.
  void build(const TerrainWindow& window, double radius);

  double radius() const { return radius_; }
  double square_radius() const { return square_radius_; }
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
  double extended_height(Index i, Point p) const;
  /// The same within the patch's domain only.
  double height(Index i, Point p) const;
  bool contains(Index i, Point p) const;
  /// Of extended_height. Steep, but finite, near the rim.
  Gradient gradient(Index i, Point p) const;

  /// Height of a convex body that is part of the sum and has the patch on its boundary: ball, cigar or krepl. Concave in p.
  double body_height(Index i, Point p) const;

  /// The bound that patches i and j share, if they are neighbours; null otherwise.
  const Bound* seam(Index i, Index j) const;

 private:
  void add_face(const TerrainWindow& window, Index f);
  void add_edge(const TerrainWindow& window, Index e);
  void add_vertex(const TerrainWindow& window, Index v);
  void examine_edges(const TerrainWindow& window);
  void examine_vertices(const TerrainWindow& window);
  double cigar_height(Index edge, Point p) const;
  double ball_height(Point at, double z, Point p) const;

  /// What is known of each edge of the window: its frame, and the stretch of normals b in [lo, hi] (components along the left
  /// normal of its direction in the plane) that a ball touching it from above can have.
  struct EdgeFrame {
    Point a;
    double z, gx, gy, m, q, length;
    double lo, hi;
    Index lo_face, hi_face;  ///< that the stretch ends at; none: horizontal
    enum class Shape : std::uint8_t { hidden, flat, convex } shape;
    Index end_patch[2];      ///< what continues the patch smoothly beyond a and b
    Index patch;
  };
  struct FaceFrame {
    double nx, ny, nz;  ///< unit normal, upwards
    Index patch;
  };

  double radius_ = 0, square_radius_ = 0;
  std::vector<Patch> patches_;
  std::vector<Box> boxes_;  // apart from patches_: most patches are told to be elsewhere by their box alone
  std::vector<Bound> bounds_;
  std::vector<Point> corners_;
  std::vector<EdgeFrame> edges_;
  std::vector<FaceFrame> faces_;
  std::vector<Index> vertex_patch_;
  std::vector<std::array<Index, 3>> face_edges_;  // per face patch, as bodies need them
};

inline double PatchSet::extended_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  const double dx = p.x - f.at.x, dy = p.y - f.at.y;
  if (f.kind == Terrain::FeatureKind::face) return f.z + (f.gx * dx + f.gy * dy);
  if (f.kind == Terrain::FeatureKind::vertex) {
    const double under = square_radius_ - (dx * dx + dy * dy);
    return under > 0 ? f.z + std::sqrt(under) : below_everything;
  }
  const double along = dx * f.gx + dy * f.gy, aside = dy * f.gx - dx * f.gy;
  const double under = square_radius_ - aside * aside;
  return under > 0 ? f.z + f.m * along + f.q * std::sqrt(under) : below_everything;
}

inline bool PatchSet::contains(Index i, Point p) const {
  if (!boxes_[i].contains(p)) return false;
  for (const Bound& b : bounds(i)) {
    if (!b.contains(p, square_radius_)) return false;
  }
  return true;
}

inline Gradient PatchSet::gradient(Index i, Point p) const {
  const Patch& f = patches_[i];
  if (f.kind == Terrain::FeatureKind::face) return {f.gx, f.gy};
  const double dx = p.x - f.at.x, dy = p.y - f.at.y;
  const double least = 1e-12 * square_radius_;
  if (f.kind == Terrain::FeatureKind::vertex) {
    const double z = std::sqrt(std::max(least, square_radius_ - (dx * dx + dy * dy)));
    return {-dx / z, -dy / z};
  }
  const double aside = dy * f.gx - dx * f.gy;
  const double across = -f.q * aside / std::sqrt(std::max(least, square_radius_ - aside * aside));
  return {f.m * f.gx - across * f.gy, f.m * f.gy + across * f.gx};
}

inline const Bound* PatchSet::seam(Index i, Index j) const {
  for (const Bound& b : bounds(i)) {
    if (b.partner == j) return &b;
  }
  return nullptr;
}

}  // namespace krepl::terrain
