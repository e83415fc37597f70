#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "input/subdivision_file.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"
#include "krepl/terrain.hpp"

namespace krepl::view {

/// Triangles and lines of something that is drawn, in the order of its faces. Coordinates are relative to `origin`.
struct Shape {
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};

  /// The numbers are those of the page's script (surface/kinds.js); the first three
  /// are the number of input points less one.
  enum class FaceKind : std::uint8_t { sphere = 0, cylinder = 1, plane = 2, wall = 3, ground = 4 };
  struct Face {
    FaceKind kind;
    Index feature;                 ///< what the ball touches there: index into `features`; none of walls and ground
    std::uint64_t first_triangle;  ///< its triangles end where those of the next face begin
  };
  enum class LineKind : std::uint8_t { seam = 0, valley = 1, rim = 2 };
  struct Line {
    LineKind kind;
    Index face;           ///< it runs along the border of this face and uses that face's vertices
    std::uint64_t first;  ///< its vertices: line_vertices[first] up to those of the next line
  };
  /// Features of the terrain by 1, 2 or 3 points.
  struct Feature {
    std::array<Point3, 3> at;
    int count;
  };

  Point3 origin{};
  double radius = 0;  ///< 0: of a terrain
  std::vector<Feature> features;
  std::vector<Point3> vertices;
  std::vector<Face> faces;
  std::vector<std::array<Index, 3>> triangles;  ///< counter-clockwise seen from above
  std::vector<Line> lines;
  std::vector<Index> line_vertices;

  std::uint64_t triangles_end(std::size_t face) const {
    return face + 1 < faces.size() ? faces[face + 1].first_triangle : triangles.size();
  }
  std::uint64_t line_end(std::size_t line) const {
    return line + 1 < lines.size() ? lines[line + 1].first : line_vertices.size();
  }
};

/// A surface's patches as triangles, its edges as chords, all within `max_error` (> 0) of the true ones, and the
/// vertical walls between a rim and the surface below it. Time is linear in the triangles, memory some 60 bytes each.
///
/// Errors name the item: links that lead nowhere or loops that do not close, coordinates that are not finite, a
/// surface without a face, more than 2^32 - 1 vertices; cancelled.
Result<Shape> surface_shape(const input::SubdivisionFile& surface, double max_error, const Context& context = {});

/// All triangles of a terrain, vertical ones too; `origin` is that of the surface it is drawn with.
Shape terrain_shape(const Terrain& terrain, Point3 origin);

}  // namespace krepl::view
