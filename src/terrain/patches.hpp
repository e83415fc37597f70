#pragma once

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

/// One side of a patch's domain in the plane. Neighbouring patches hold the same numbers with opposite signs, so that exactly one
/// of them owns each point beside a seam, whatever the rounding.
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
};

/// The part of the sum's boundary that one feature can cause.
struct Patch {
  Terrain::FeatureKind kind;
  Index feature;
  Index first_bound;
  Index bound_count;
  Index first_corner;
  Index corner_count;
  Point at;       ///< a point of the plane, the edge's first vertex, or the vertex
  double z;       ///< height there (a face's plane is the one moved by R)
  double gx, gy;  ///< face: gradient; edge: unit direction in the plane
  double m, q;    ///< edge: rise per unit length in the plane, and sqrt(1 + m^2)
  double length;  ///< edge: in the plane
  Point low, high;  ///< bounding rectangle of the domain
  double top;       ///< at least its greatest height
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
  std::span<const Bound> bounds(Index i) const { return {bounds_.data() + patches_[i].first_bound, patches_[i].bound_count}; }

  /// Where sides of the domain end; two of them meet nowhere else.
  std::span<const Point> corners(Index i) const { return {corners_.data() + patches_[i].first_corner, patches_[i].corner_count}; }

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
  std::vector<Bound> bounds_;
  std::vector<Point> corners_;
  std::vector<EdgeFrame> edges_;
  std::vector<FaceFrame> faces_;
  std::vector<Index> vertex_patch_;
  std::vector<std::array<Index, 3>> face_edges_;  // per face patch, as bodies need them
};

}  // namespace krepl::terrain
