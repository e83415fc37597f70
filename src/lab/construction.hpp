#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "krepl/error.hpp"
#include "krepl/point.hpp"
#include "krepl/terrain.hpp"

namespace krepl::lab {

/// A terrain made for a purpose, with the radius that belongs to it.
struct Construction {
  using Triangle = std::array<Terrain::Index, 3>;

  std::vector<Point3> vertices;
  std::vector<Triangle> triangles;
  double radius = 1;

  Terrain::Index add(Point3 p) {
    vertices.push_back(p);
    return Terrain::Index(vertices.size() - 1);
  }
  void add(Terrain::Index a, Terrain::Index b, Terrain::Index c) { triangles.push_back({a, b, c}); }
  void add(Point3 a, Point3 b, Point3 c) {
    const Terrain::Index first = add(a);
    add(b), add(c);
    add(first, first + 1, first + 2);
  }
};

/// Errors: those of Terrain::from_triangles.
Result<std::shared_ptr<const Terrain>> terrain_of(const Construction& construction);

/// Wavefront OBJ; `title` and the radius go into comments. Coordinates have all their digits.
std::string obj_text(const Construction& construction, const std::string& title);

/// Whether the projections of two triangles have more in common than their borders; what is thinner than 1e-9 of the
/// largest coordinate does not count. Then the triangles are no terrain in the sense of the thesis. O(n^2).
bool projections_overlap(const Construction& construction);
/// The same for the triangles at vertex v against all others only: what moving v can change.
bool projections_overlap_at(const Construction& construction, Terrain::Index v);

}  // namespace krepl::lab
