#pragma once

#include <array>
#include <vector>

#include "incremental/numbers.hpp"
#include "krepl/terrain.hpp"

namespace krepl::incremental {

/// What a ball can touch: faces, edges and vertices of the terrain in one numbering. A lower number goes first where
/// heights are equal: faces before edges before vertices, each in the order of feature numbers.
struct Part {
  Terrain::FeatureKind kind;
  Index feature;                 ///< of the terrain
  Index item;                    ///< of triangles, edges or vertices
  std::vector<Index> triangles;  ///< that have it
  Box box;                       ///< of its patch: the places of balls that touch it
  Real low, high;                ///< heights of those balls
};

struct TrianglePart {
  std::array<Index, 3> vertex, edge;  ///< edge k runs between corners k and k + 1
  std::array<Vector, 3> corner;
  std::array<Vector, 3> inward;                     ///< unit, in the triangle's plane, from edge k to the third corner
  std::array<Vector, 3> along;                      ///< from corner k to the next
  std::array<Real, 3> per_square, per_flat_square;  ///< 1 / its square, in space and in the plane (0 if upright)
  Real turn;                                        ///< positive if the corners are counter-clockwise seen from above
  Vector normal;                                    ///< unit, upward
  bool vertical;
  Index part;  ///< none if vertical
  Box box;     ///< of the triangle
};

struct EdgePart {
  Index a, b;
  Vector at, end;
  Vector direction;  ///< unit, from a to b
  Vector aside, up;  ///< unit, with direction a right-handed frame; aside is horizontal, up points upwards
  Real length;
  Index part;  ///< none for an upright edge: a ball from above touches its upper end only
};

struct VertexPart {
  Vector at;
  Index part;
};

class Parts {
 public:
  /// Of a whole terrain.
  Parts(const Terrain& terrain, double radius);

  Real radius() const { return radius_; }
  /// S, the larger of R and the terrain's extent.
  Real scale() const { return scale_; }
  const std::vector<Part>& parts() const { return parts_; }
  const std::vector<TrianglePart>& triangles() const { return triangles_; }
  const std::vector<EdgePart>& edges() const { return edges_; }
  const std::vector<VertexPart>& vertices() const { return vertices_; }
  const Part& operator[](Index p) const { return parts_[p]; }
  const TrianglePart& triangle_of(Index p) const { return triangles_[parts_[p].item]; }
  const EdgePart& edge_of(Index p) const { return edges_[parts_[p].item]; }
  const VertexPart& vertex_of(Index p) const { return vertices_[parts_[p].item]; }

  /// Height of the ball over a place that touches the part in its inside; below_everything if none does.
  Real height(Index part, Vector place) const;
  /// Where a ball about c touches the part's plane, line or point.
  Vector contact(Index part, Vector c) const;
  /// True if both are edges in one line of space.
  bool are_in_one_line(Index first, Index second) const;
  /// Neighbours: their patches meet in a seam where they touch the same place. A face and another face or an edge need
  /// two vertices in common: such as lie one on the other in one plane do not continue each other.
  bool continue_smoothly(Index first, Index second) const;
  /// From a point to the triangle and everything straight below it, which is convex. A semi-krepl is what is nearer
  /// than R.
  Real prism_distance(Index triangle, Vector c) const;

 private:
  std::vector<Index> corners(Index part) const;

  Real radius_, scale_;
  std::vector<Part> parts_;
  std::vector<TrianglePart> triangles_;
  std::vector<EdgePart> edges_;
  std::vector<VertexPart> vertices_;
};

}  // namespace krepl::incremental
