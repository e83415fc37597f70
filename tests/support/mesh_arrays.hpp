#pragma once

#include <array>
#include <vector>

#include "output/surface_mesh.hpp"

namespace krepl::test {

/// All triangles of a mesh, which makes them face by face.
struct MeshArrays {
  using Index = output::SurfaceMesh::Index;
  struct Triangle {
    std::array<Index, 3> vertex;
    Surface::Index face;
  };
  std::vector<Point3> vertices;
  std::vector<Triangle> triangles;

  explicit MeshArrays(const output::SurfaceMesh& mesh) {
    for (Index v = 0; v < mesh.border().count(); ++v) vertices.push_back(mesh.border().vertex(v));
    for (std::size_t block = 0; block < mesh.block_count(); ++block)
      mesh.visit(block, {}, [&](const output::SurfaceMesh::Face& face) { add(face); });
  }

 private:
  void add(const output::SurfaceMesh::Face& face) {
    const auto& points = face.triangles.points();
    std::vector<Index> number(face.border.begin(), face.border.end());
    for (std::size_t i = number.size(); i < points.size(); ++i) {
      number.push_back(Index(vertices.size()));
      vertices.push_back(points[i]);
    }
    for (std::size_t t = 0; t < face.triangles.triangle_count(); ++t) {
      const auto [a, b, c] = face.triangles.triangle(t);
      triangles.push_back({{number[a], number[b], number[c]}, face.face});
    }
  }
};

}  // namespace krepl::test
