#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/subdivision.hpp"
#include "krepl/terrain.hpp"

namespace krepl {

/// What computing a surface cost. Printed by `krepl --verbose`.
struct SurfaceCounters {
  std::uint64_t patches = 0;            ///< faces, convex edges and convex vertices whose patches were looked at
  std::uint64_t cells = 0;              ///< cells of the plane's subdivision examined
  std::uint64_t leaves = 0;             ///< of them, settled
  std::uint64_t smallest_cells = 0;     ///< of those, settled only because they are as small as the coordinates tell
  std::uint64_t lines = 0;              ///< cell sides along which the boundary's section was computed
  std::uint64_t height_evaluations = 0;
  // Of the incremental engine only (incremental.hpp).
  std::uint64_t unions = 0;                   ///< semi-kreplach added
  std::uint64_t curves_traced = 0;            ///< of pairs of patches, and sides of patches
  std::uint64_t intersection_components = 0;  ///< of the new boundary with the old one, in all unions
  std::uint64_t closed_components = 0;        ///< of them, closed curves
  std::uint64_t most_components = 0;          ///< in one union
  std::uint64_t last_components = 0;          ///< in the last union
  std::uint64_t last_closed = 0;              ///< of them, closed curves
  std::uint64_t unions_with_several = 0;      ///< unions with more than one
};

/// The upper boundary of terrain (+) ball: every place where the centre of a ball of radius R lies when it rests on the
/// terrain, as a subdivision of the plane seen from above.
///
/// Face f > 0 of subdivision() is a maximal connected part of the boundary where the ball touches one feature of the
/// terrain: a piece of a plane (the ball touches a face), of a cylinder (an edge) or of a sphere (a vertex). Face 0 is the
/// outside; holes of the domain that the ball does not bridge are faces without a feature.
///
/// Coordinates are relative to terrain().origin().
class Surface {
 public:
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};

  enum class EdgeKind : std::uint8_t {
    seam,    ///< two patches join smoothly
    valley,  ///< the ball touches two places at once
    rim      ///< the surface ends in a vertical wall, at the outside or above a lower part
  };
  enum class Curve : std::uint8_t { line, circle, ellipse, quartic };

  struct Edge {
    EdgeKind kind;
    Curve curve;
    /// The features whose patches meet, the one left of half-edge 2e first. At a rim the lower side is none: the ball
    /// touches the upper feature only.
    std::array<Index, 2> feature;
  };

  double radius() const { return radius_; }
  const Terrain& terrain() const { return *terrain_; }
  const Subdivision& subdivision() const { return subdivision_; }
  const SurfaceCounters& counters() const { return counters_; }

  Point3 vertex(Index v) const { return vertex_[v]; }
  Edge edge(Index e) const;
  /// none for faces without a patch: face 0 and holes.
  Index face_feature(Index f) const { return face_feature_[f]; }

  /// Points of the true curve of edge e along half-edge 2e, both ends included, so many (at least 3) that they are about
  /// equally spaced. At a rim z is that of the upper patch.
  std::vector<Point3> curve(Index e, int points) const;
  /// Points of that curve between its ends, where the chord does not tell which part of it is meant; for most edges none.
  std::span<const Point3> guides(Index e) const;

  /// Topology by Subdivision::validate(), and labels: the ball touches something on both sides of each edge, or on the
  /// upper one of a rim.
  std::optional<std::string> validate() const;

 private:
  friend class SurfaceAssembly;
  friend class IncrementalAssembly;
  // An edge in one byte: its kind, its curve, and the lower side of a rim, left 0 or right 1, else 2. Its features are those of
  // its faces.
  static std::uint8_t style_of(EdgeKind kind, Curve curve, int lower) {
    return std::uint8_t(int(kind) | int(curve) << 2 | lower << 4);
  }

  double radius_ = 0;
  std::shared_ptr<const Terrain> terrain_;
  Subdivision subdivision_;
  std::vector<Point3> vertex_;
  std::vector<std::uint8_t> style_;   // per edge
  std::vector<Index> face_feature_;
  // Points between the ends of the few edges of which the chord does not tell the curve, along half-edge 2e.
  std::vector<Index> guided_edge_;    // ascending
  std::vector<Index> guide_begin_;    // per guided edge and one more: where its points start in guide_
  std::vector<Point3> guide_;
  SurfaceCounters counters_;
};

struct SurfaceOptions {
  /// Radius of the ball in the unit of the terrain: finite and positive.
  double radius = 0;
};

/// The exact surface of terrain (+) ball (thesis section 4.5 by subdivision of the plane; docs/surface.md).
///
/// Errors: radius not finite and positive, or finer or coarser than the coordinates can hold; cancelled; a place whose topology
/// cannot be certified (named). Expected linear time and memory in the number of triangles plus the size of the result.
Result<Surface> compute_surface(std::shared_ptr<const Terrain> terrain, const SurfaceOptions& options,
                                const Context& context = {});

}  // namespace krepl
