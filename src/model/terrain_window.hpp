#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "krepl/terrain.hpp"

namespace krepl {

/// The part of a terrain near a rectangle of the plane as an explicit little mesh: grids and meshes look alike from
/// here. Buffers are kept from one fill() to the next.
///
/// *Core* are all triangles whose bounding rectangle meets the rectangle (closed), and their edges and vertices. Around
/// them are all further triangles that share a vertex with a core triangle, so that every core vertex and core edge has
/// all its triangles and edges here. Numbers below are indices into the window's own arrays; they follow feature
/// numbers, so the same features come in the same order in every window.
class TerrainWindow {
 public:
  using Index = Terrain::Index;

  struct Vertex {
    Point3 at;
    Index feature;
    bool core;
  };
  struct Edge {
    Index a, b;  ///< vertices; a has the lower feature number
    Index feature;
    bool core;
  };
  struct Face {
    std::array<Index, 3> vertex;  ///< counter-clockwise seen from above unless vertical, starting at the lowest number
    std::array<Index, 3> edge;    ///< edge i runs between vertex i and vertex (i + 1) % 3
    Index feature;
    bool vertical;                ///< exactly vertical: it has no upper side, so it is no feature to touch
    bool core;
  };

  void fill(const Terrain& terrain, Point low, Point high);

  /// True if nothing lies above or below anything else, as in grids.
  bool is_graph() const { return is_graph_; }
  std::span<const Vertex> vertices() const { return vertices_; }
  std::span<const Edge> edges() const { return edges_; }
  std::span<const Face> faces() const { return faces_; }
  std::span<const Index> faces_of_edge(Index e) const { return row(edge_face_begin_, edge_face_, e); }
  std::span<const Index> edges_of_vertex(Index v) const { return row(vertex_edge_begin_, vertex_edge_, v); }
  std::span<const Index> faces_of_vertex(Index v) const { return row(vertex_face_begin_, vertex_face_, v); }

 private:
  static std::span<const Index> row(const std::vector<Index>& begin, const std::vector<Index>& of, Index i) {
    return {of.data() + begin[i], begin[i + 1] - begin[i]};
  }

  class GridFill;
  class MeshFill;
  void fill_grid(const Terrain& terrain, Point low, Point high);
  void fill_mesh(const Terrain& terrain, Point low, Point high);
  void connect();

  bool is_graph_ = false;
  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<Face> faces_;
  std::vector<Index> edge_face_begin_, edge_face_, vertex_edge_begin_, vertex_edge_, vertex_face_begin_, vertex_face_;

  // Scratch of fill().
  std::vector<std::uint16_t> mark_;                 // grid: what of a sample is in the window
  std::vector<Index> vertex_number_, edge_number_;  // grid: by sample, and by sample and kind of edge
  // Mesh: ascending numbers of the terrain.
  std::vector<Index> core_triangle_, core_edge_, core_vertex_, triangle_, edge_, vertex_;
};

}  // namespace krepl
