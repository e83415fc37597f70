#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "krepl/terrain.hpp"
#include "model/terrain_window.hpp"

namespace krepl::test {

using Index = Terrain::Index;

/// What a window must be cut from, written down without any of the library's tables: features by number.
struct ReferenceMesh {
  struct Face {
    std::array<Index, 3> vertex;  // feature numbers, as TerrainWindow::Face has them
    bool vertical = false;
  };
  std::map<Index, Point3> vertex;
  std::map<std::pair<Index, Index>, Index> edge;  // by its vertices, the lower one first
  std::map<Index, Face> face;

  static std::pair<Index, Index> side(const Face& f, int i) {
    const auto [a, b] = std::minmax(f.vertex[std::size_t(i)], f.vertex[std::size_t((i + 1) % 3)]);
    return {a, b};
  }
};

/// The features that a window over [low, high] must hold, and which of them are core.
struct ExpectedWindow {
  std::map<Index, bool> vertex, edge, face;
};

inline ExpectedWindow expected_window(const ReferenceMesh& mesh, Point low, Point high) {
  ExpectedWindow e;
  std::set<Index> core_vertices, core_faces;
  for (const auto& [number, face] : mesh.face) {
    double min_x = 1e300, max_x = -1e300, min_y = 1e300, max_y = -1e300;
    for (const Index v : face.vertex) {
      const Point3 p = mesh.vertex.at(v);
      min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x), min_y = std::min(min_y, p.y),
      max_y = std::max(max_y, p.y);
    }
    if (min_x > high.x || max_x < low.x || min_y > high.y || max_y < low.y) continue;
    core_faces.insert(number);
    core_vertices.insert(face.vertex.begin(), face.vertex.end());
  }
  for (const auto& [number, face] : mesh.face) {
    const bool core = core_faces.contains(number);
    if (std::none_of(face.vertex.begin(), face.vertex.end(), [&](Index v) { return core_vertices.contains(v); }))
      continue;
    e.face[number] = core;
    for (int i = 0; i < 3; ++i) {
      e.vertex[face.vertex[std::size_t(i)]] = core_vertices.contains(face.vertex[std::size_t(i)]);
      bool& edge_core = e.edge[mesh.edge.at(ReferenceMesh::side(face, i))];
      edge_core = edge_core || core;
    }
  }
  return e;
}

template <class Items>
std::map<Index, bool> features_of(const Items& items) {
  std::map<Index, bool> found;
  Index last = 0;
  for (const auto& item : items) {
    EXPECT_TRUE(found.empty() || item.feature > last) << "features are not in order";
    last = item.feature;
    found[item.feature] = item.core;
  }
  return found;
}

/// Compares everything in the window with the reference: features, flags, corners, and all neighbours.
inline void expect_window(const TerrainWindow& window, const ReferenceMesh& mesh, Point low, Point high) {
  const ExpectedWindow expected = expected_window(mesh, low, high);
  ASSERT_EQ(features_of(window.vertices()), expected.vertex);
  ASSERT_EQ(features_of(window.edges()), expected.edge);
  ASSERT_EQ(features_of(window.faces()), expected.face);
  std::map<Index, std::vector<Index>> faces_of_edge, faces_of_vertex, edges_of_vertex;
  for (const auto& v : window.vertices()) ASSERT_EQ(v.at, mesh.vertex.at(v.feature));
  for (Index e = 0; e < window.edges().size(); ++e) {
    const auto& edge = window.edges()[e];
    ASSERT_LT(edge.a, edge.b);
    ASSERT_EQ(mesh.edge.at({window.vertices()[edge.a].feature, window.vertices()[edge.b].feature}), edge.feature);
    edges_of_vertex[edge.a].push_back(e);
    edges_of_vertex[edge.b].push_back(e);
  }
  for (Index f = 0; f < window.faces().size(); ++f) {
    const auto& face = window.faces()[f];
    const ReferenceMesh::Face& want = mesh.face.at(face.feature);
    ASSERT_EQ(face.vertical, want.vertical);
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(window.vertices()[face.vertex[i]].feature, want.vertex[i])
          << "corner " << i << " of face " << face.feature;
      ASSERT_EQ(window.edges()[face.edge[i]].feature, mesh.edge.at(ReferenceMesh::side(want, int(i))));
      faces_of_vertex[face.vertex[i]].push_back(f);
      faces_of_edge[face.edge[i]].push_back(f);
    }
  }
  const auto same = [](std::span<const Index> row, const std::vector<Index>& want) {
    return std::equal(row.begin(), row.end(), want.begin(), want.end());
  };
  for (Index v = 0; v < window.vertices().size(); ++v) {
    ASSERT_TRUE(same(window.faces_of_vertex(v), faces_of_vertex[v]));
    ASSERT_TRUE(same(window.edges_of_vertex(v), edges_of_vertex[v]));
  }
  for (Index e = 0; e < window.edges().size(); ++e) ASSERT_TRUE(same(window.faces_of_edge(e), faces_of_edge[e]));
}

/// Each feature's corners, as the terrain itself tells them.
inline void expect_corners(const Terrain& terrain, const ReferenceMesh& mesh) {
  const auto same = [&](Index feature, std::vector<Index> vertices) {
    const Terrain::Corners c = terrain.corners(feature);
    ASSERT_EQ(std::size_t(c.count), vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) ASSERT_EQ(c.point[i], mesh.vertex.at(vertices[i]));
  };
  for (const auto& [v, at] : mesh.vertex) {
    ASSERT_EQ(terrain.feature_kind(v), Terrain::FeatureKind::vertex);
    same(v, {v});
  }
  for (const auto& [ends, e] : mesh.edge) {
    ASSERT_EQ(terrain.feature_kind(e), Terrain::FeatureKind::edge);
    same(e, {ends.first, ends.second});
  }
  for (const auto& [f, face] : mesh.face) {
    ASSERT_EQ(terrain.feature_kind(f), Terrain::FeatureKind::face);
    ASSERT_LT(f, terrain.feature_bound());
    same(f, {face.vertex.begin(), face.vertex.end()});
  }
}

}  // namespace krepl::test
