#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// A mesh as files have it: polygons over shared vertices, each with the line or running number that names it in
/// errors.
struct PolygonMesh {
  std::vector<Point3> vertices;
  std::vector<std::int64_t> corners;  ///< vertices of polygon i: corners[begin[i] .. begin[i+1])
  std::vector<std::uint64_t> begin{0};
  std::vector<std::uint64_t> place;
  const char* place_name = "line";  ///< what `place` counts
  std::vector<std::string> notes;

  std::size_t polygon_count() const { return place.size(); }
  void close_polygon(std::uint64_t number) {
    begin.push_back(corners.size());
    place.push_back(number);
  }
};

struct TriangleMesh {
  std::vector<Point3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::string> notes;
};

/// Cuts polygons into triangles; what has fewer than three corners is left out with a note. Errors: a corner that is no
/// vertex, no polygon at all, more than 2^32 vertices, cancelled.
Result<TriangleMesh> cut_into_triangles(PolygonMesh mesh, const Context& context = {});

/// Cuts one polygon (three corners or more, in order) by clipping ears in the coordinate plane that it faces most;
/// exact where the polygon is simple there. Returns false if no ear was left: then it crosses itself, and its triangles
/// overlap. O(n) for convex polygons, about O(n^2) for others.
bool triangulate(std::span<const Point3> vertices, std::span<const std::uint32_t> polygon,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace krepl::input
