#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// A subdivision of space as found in a JSON file: plain numbers, nothing computed or checked but that they are there.
struct SubdivisionFile {
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};  ///< null

  struct Feature {
    std::array<Point3, 3> at;
    int count;  ///< vertex 1, edge 2, face 3
  };
  enum class EdgeKind : std::uint8_t { seam, valley, rim };
  enum class Curve : std::uint8_t { line, circle, ellipse, quartic };
  struct Edge {
    EdgeKind kind;
    Curve curve;
    std::array<Index, 2> feature;
    std::uint64_t first;  ///< its points: points[first] up to those of the next edge
  };
  struct HalfEdge {
    Index origin, twin, next, face, edge;
  };
  struct Face {
    Index feature, outer;
    std::uint64_t first_inner;
  };

  double radius = 0;
  std::vector<Feature> features;
  std::vector<Point3> vertices;
  std::vector<Edge> edges;
  std::vector<Point3> points;
  std::vector<HalfEdge> half_edges;
  std::vector<Face> faces;
  std::vector<Index> inner;

  std::uint64_t points_end(std::size_t edge) const {
    return edge + 1 < edges.size() ? edges[edge + 1].first : points.size();
  }
  std::uint64_t inner_end(std::size_t face) const {
    return face + 1 < faces.size() ? faces[face + 1].first_inner : inner.size();
  }
};

/// Reads a JSON subdivision as krepl writes it, in any order of its keys; unknown keys are passed over. Memory: the
/// numbers as doubles and indices, less than the file has bytes.
///
/// Errors name item, line and byte: not JSON, ends early, a key missing, a value of the wrong kind, an edge with fewer
/// than three points, a number that no double holds; another "krepl" or "version" than subdivision 1; cancelled.
Result<SubdivisionFile> read_subdivision(const std::string& path, const Context& context = {});

/// Whether a file begins like a subdivision and not like GeoJSON.
bool looks_like_subdivision(const std::string& path);

/// The same from the layers `faces`, `edges` and `vertices` of a GeoPackage. Edges have the points of their chords,
/// ends included: 2 or more. Where the file does not name the radius, it is the distance of the vertices
/// from what the ball touches there, to within rounding. Features that have no face have no points.
struct SubdivisionGeoPackage {
  SubdivisionFile file;
  std::string crs;  ///< name of the coordinate system; empty if unknown
};
/// Errors name layer and feature: a layer, a column or a geometry missing, items that are
/// not numbered in their order; cancelled.
Result<SubdivisionGeoPackage> read_subdivision_gpkg(const std::string& path, const Context& context = {});

/// Whether a file has these layers.
bool is_subdivision_gpkg(const std::string& path);

}  // namespace krepl::input
