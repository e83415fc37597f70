#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/surface.hpp"
#include "output/surface_edges.hpp"

namespace krepl::output {

/// A surface as triangles, counter-clockwise seen from above, relative to terrain().origin().
///
/// Faces that meet in a seam or valley share the vertices along it, so that the mesh is closed where the surface is. It ends at
/// rims: the walls below them are no part of the surface. A rim above a lower part has vertices of its own at the wall's
/// foot.
struct SurfaceMesh {
  using Index = std::uint32_t;
  struct Triangle {
    std::array<Index, 3> vertex;
    Surface::Index face;
  };
  std::vector<Point3> vertices;
  std::vector<Triangle> triangles;  ///< by ascending face
  double deviation = 0;             ///< bound of the distance between the mesh and the surface
  std::size_t folded = 0;           ///< triangles seen from below, in faces narrower than the tolerance
};

/// Triangles within max_error of the surface. Errors: more than 2^32 vertices; cancelled.
Result<SurfaceMesh> triangulate_surface(const Surface& surface, double max_error, const Context& context = {});

/// The mesh's vertices along the edges of a surface: which one each corner and each point of a chord is. Heights differ
/// between the two sides of a rim.
class BorderVertices {
 public:
  using Index = std::uint32_t;

  BorderVertices(const Surface& surface, const SurfaceEdges& edges);

  const std::vector<Point3>& vertices() const { return vertices_; }
  /// The same, once nothing else is asked any more.
  std::vector<Point3> take() && {
    for (std::vector<Index>* array : {&corner_, &inner_, &foot_}) *array = std::vector<Index>();
    return std::move(vertices_);
  }
  /// The loop of half-edge h as vertices, each once.
  std::vector<Index> loop(Surface::Index h) const;

 private:
  void join_corners();
  void number_corners();
  void number_inner();
  std::vector<Index> along(Surface::Index h) const;

  const Surface& surface_;
  const Subdivision& topology_;
  const SurfaceEdges& edges_;
  std::vector<Point3> vertices_;
  std::vector<Index> corner_;      // per half-edge: the vertex at its origin, as its face has it
  std::vector<Index> inner_, foot_;  // per edge: the first of its inner vertices, and of those at the wall's foot
};

}  // namespace krepl::output
