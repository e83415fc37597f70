#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "krepl/point.hpp"
#include "output/surface_patch.hpp"

namespace krepl::output {

/// Triangles of one face of a surface, improved and refined until they are within a tolerance of its patch. The face's
/// border is kept as it is.
class PatchMesh {
 public:
  using Index = std::uint32_t;
  using Triangle = std::array<Index, 3>;

  PatchMesh(const SurfacePatch& patch, std::vector<Point3> points, const std::vector<Triangle>& triangles);

  /// A chord of the border, and the feature whose patch the surface has beyond it.
  struct Chord {
    Index from, to;
    Terrain::Index beyond;
    auto operator<=>(const Chord&) const = default;
  };

  /// Flips inner sides for shorter ones, and halves those that are too far below the patch.
  void refine(double max_error);
  /// Puts inner points between a chord and its curve, where the surface is the patch beyond the curve, on that patch.
  /// Chords are ascending.
  void lift(const Terrain& terrain, double radius, std::span<const Chord> chords);

  const std::vector<Point3>& points() const { return points_; }
  std::size_t triangle_count() const { return corner_.size() / 3; }
  Triangle triangle(std::size_t t) const { return {corner_[3 * t], corner_[3 * t + 1], corner_[3 * t + 2]}; }
  double deviation() const;
  /// Triangles that do not run counter-clockwise seen from above.
  std::size_t folded() const;

 private:
  static constexpr Index none = ~Index{0};
  // Side i of triangle t is 3t + i; it starts at corner i.
  static Index next(Index side) { return side % 3 == 2 ? side - 2 : side + 1; }
  static Index previous(Index side) { return side % 3 == 0 ? side + 2 : side - 1; }
  int turn(Index a, Index b, Index c) const;
  double area(Index a, Index b, Index c) const;  // twice, seen from above
  double cost(Index a, Index b) const;

  void connect();
  void pair(Index side, Index other);
  bool is_needle(Index a, Index b, Index c) const;
  bool may_reach(Index side, Index d) const;
  bool is_curved(Index a, Index b) const;
  bool should_flip_needles(Index a, Index b, Index c, Index d) const;
  bool should_flip(Index side) const;
  void flip(Index side);
  void settle();
  bool is_too_long(Index side) const;
  void halve(Index side);
  void halve_all();
  void lift_beside(Index border_side, const SurfacePatch& beyond);

  const SurfacePatch& patch_;
  std::vector<Point3> points_;
  const std::size_t border_points_;
  std::vector<Index> corner_, opposite_;
  std::vector<Index> doubtful_;  // sides that may have to be flipped
  bool narrow_ = false;  // flips and halves only where the view from above tells nothing
  double limit_ = std::numeric_limits<double>::infinity();  // of a side's height above its chord
};

}  // namespace krepl::output
