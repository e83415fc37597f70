#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"
#include "krepl/surface.hpp"

namespace krepl {

namespace section {
struct Parts;
}

/// A true piece of the curve in which a plane cuts a surface, from start to end. A level or vertical plane cuts planes,
/// cylinders and spheres in lines, circles and ellipses.
struct CutPiece {
  using Index = Surface::Index;
  enum class Kind : std::uint8_t { line, circle, ellipse };

  Kind kind = Kind::line;
  /// The piece lies on a vertical wall below a rim of the surface, not on a patch: in a contour it runs below the rim (a line or
  /// a circle), in a section it is a vertical line.
  bool wall = false;
  /// Face of the surface's subdivision; of a wall, the upper one.
  Index face = Surface::none;
  /// What the ball touches, of the terrain; of a wall, what it touches at the rim.
  Index feature = Surface::none;
  Point3 start, end;
  /// Of circles and ellipses: centre + cos(t) axis[0] + sin(t) axis[1] for t from `from` to `to`, which may descend. The axes of
  /// a circle are orthogonal and equally long; of an ellipse they are conjugate, in contours orthogonal.
  Point3 centre;
  std::array<Point3, 2> axis;
  double from = 0, to = 0;

  /// The point at s in [0, 1]: start at 0, end at 1.
  Point3 at(double s) const;
  /// Derivative of at(s); of no certain length.
  Point3 tangent(double s) const;
  /// Appends points after start up to end, at most max_error from the piece between them.
  void append_points(double max_error, std::vector<Point3>& points) const;
  /// The part from s to t, 0 <= s < t <= 1.
  CutPiece part(double s, double t) const;
};

/// A contour or waterline: the boundary of the places where the sum reaches as high as `level`, in closed rings. Within R of a
/// wall's rim it runs along the wall: the sum is solid below its surface.
///
/// Rings run with the higher side on the left: outer rings counter-clockwise, holes clockwise. They touch in points at most.
struct Contour {
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};

  double level = 0;
  std::vector<CutPiece> pieces;      ///< ring after ring; the end of each is the start of the next
  std::vector<Index> ring_begin{0};  ///< per ring and one more: its first piece
  std::vector<bool> ring_is_hole;    ///< lower inside
  std::vector<Index> ring_parent;    ///< the ring directly around it; none for outermost ones. Holes have outer rings, and
                                     ///< outer rings holes
  std::size_t ring_count() const { return ring_is_hole.size(); }
  std::span<const CutPiece> ring(std::size_t r) const {
    return {pieces.data() + ring_begin[r], ring_begin[r + 1] - ring_begin[r]};
  }
};

/// A section or drive curve: the surface above a straight line of the plane, from left to right as one looks along the
/// normal on the line's left.
struct Section {
  using Index = std::uint32_t;
  Point from, to;
  std::vector<CutPiece> pieces;       ///< chain after chain; the end of each is the start of the next
  std::vector<Index> chain_begin{0};  ///< per chain and one more. Between chains the line meets no part of the sum: a chain
                                      ///< starts and ends at `from`, at `to`, or at a rim with nothing beyond
  std::size_t chain_count() const { return chain_begin.size() - 1; }
  std::span<const CutPiece> chain(std::size_t c) const {
    return {pieces.data() + chain_begin[c], chain_begin[c + 1] - chain_begin[c]};
  }
};

struct ContourOptions {
  /// What lies exactly at the level: flat ground there belongs to the higher side (the contour is the boundary of h >= level)
  /// or to the lower one (h > level: the ball may rest on such ground).
  bool ties_are_high = true;
};

/// Cuts a surface at heights and along lines. All coordinates are relative to terrain().origin().
///
/// The subdivision's edges are walked: which of an edge's ends are higher than the level, or left of the line, and where it
/// crosses, is decided once for the two faces beside it; so rings close and chains connect whatever the rounding. What lies
/// exactly at the level or on the line is decided by moving the level (down, or up if ties are low) or the line (to its right)
/// by 2^-40 S where a vertex, or the top of a cylinder or sphere, is that near. Points are within 1e-12 S of the level, or of
/// the line, and of the surface, like those of the surface itself. Of a line along a wall what lies left of it counts.
/// Rings smaller than 2^-36 S are left out.
class SurfaceCutter {
 public:
  /// Linear time, about a tenth of computing the surface; 7 bytes an edge. Errors: cancelled.
  static Result<SurfaceCutter> build(std::shared_ptr<const Surface> surface, const Context& context = {});

  const Surface& surface() const;

  /// No rings if the level is above or below everything. Errors: level not finite (usage).
  /// The time is that of the edges crossed, some 10 us each, and a few ns for each edge with rims or near the level.
  Result<Contour> contour(double level, const ContourOptions& options = {}) const;
  /// The same at several levels, in their order, on context.threads threads. Errors as above; cancelled.
  Result<std::vector<Contour>> contours(std::span<const double> levels, const ContourOptions& options = {},
                                        const Context& context = {}) const;

  /// Errors: ends not finite, or equal (usage). The time is that of the edges crossed by the whole line, some 5 us each.
  Result<Section> section(Point from, Point to) const;
  struct Line {
    Point from, to;
  };
  /// Along several lines, in their order, on context.threads threads. Errors as above; cancelled.
  Result<std::vector<Section>> sections(std::span<const Line> lines, const Context& context = {}) const;

 private:
  explicit SurfaceCutter(std::shared_ptr<const section::Parts> parts) : parts_(std::move(parts)) {}
  std::shared_ptr<const section::Parts> parts_;
};

}  // namespace krepl
