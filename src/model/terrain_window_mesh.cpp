// Windows on meshes: sorted lists of the terrain's numbers; a number's place in its list is its number in the window.
#include <algorithm>

#include "model/terrain_window.hpp"

namespace krepl {
namespace {

using Index = Terrain::Index;

void sort_unique(std::vector<Index>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

Index place_of(const std::vector<Index>& sorted, Index number) {
  return Index(std::lower_bound(sorted.begin(), sorted.end(), number) - sorted.begin());
}

/// Runs visit(place, also in the subset) over a sorted list and a sorted subset of it.
template <class Visit>
void for_each_with_subset(const std::vector<Index>& all, const std::vector<Index>& subset, const Visit& visit) {
  auto next = subset.begin();
  for (const Index number : all) {
    const bool inside = next != subset.end() && *next == number;
    if (inside) ++next;
    visit(number, inside);
  }
}

}  // namespace

class TerrainWindow::MeshFill {
 public:
  MeshFill(TerrainWindow& window, const Terrain& terrain, Point low, Point high)
      : w_(window), t_(terrain), low_(low), high_(high) {}

  void run() {
    w_.core_triangle_.clear();
    if (!t_.tree_.empty()) descend(t_.tree_.size() - 1, 0);
    collect(w_.core_triangle_, w_.core_vertex_, w_.core_edge_);
    w_.triangle_.clear();
    for (const Index v : w_.core_vertex_) {
      const auto first = t_.vertex_triangle_.begin();
      w_.triangle_.insert(w_.triangle_.end(), first + t_.vertex_triangle_begin_[v],
                          first + t_.vertex_triangle_begin_[v + 1]);
    }
    sort_unique(w_.triangle_);
    collect(w_.triangle_, w_.vertex_, w_.edge_);
    add_all();
  }

 private:
  bool meets(const Terrain::Box& box) const {
    return box.min_x <= high_.x && box.max_x >= low_.x && box.min_y <= high_.y && box.max_y >= low_.y;
  }

  Terrain::Box box_of(Index triangle) const {
    const auto& v = t_.triangle_[triangle].vertex;
    const Point3 a = t_.vertex_[v[0]], b = t_.vertex_[v[1]], c = t_.vertex_[v[2]];
    return {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
  }

  /// Appends the core triangles below a box of the tree, in ascending order.
  void descend(std::size_t level, std::size_t index) {
    if (!meets(t_.tree_[level][index])) return;
    const std::size_t below = level == 0 ? t_.triangle_.size() : t_.tree_[level - 1].size();
    const std::size_t first = index * Terrain::tree_arity, last = std::min(first + Terrain::tree_arity, below);
    for (std::size_t i = first; i < last; ++i) {
      if (level > 0)
        descend(level - 1, i);
      else if (meets(box_of(Index(i))))
        w_.core_triangle_.push_back(Index(i));
    }
  }

  void collect(const std::vector<Index>& triangles, std::vector<Index>& vertices, std::vector<Index>& edges) const {
    vertices.clear();
    edges.clear();
    for (const Index t : triangles) {
      const Terrain::Triangle& triangle = t_.triangle_[t];
      vertices.insert(vertices.end(), triangle.vertex.begin(), triangle.vertex.end());
      edges.insert(edges.end(), triangle.edge.begin(), triangle.edge.end());
    }
    sort_unique(vertices);
    sort_unique(edges);
  }

  void add_all() {
    const auto first_edge = Index(t_.vertex_.size()), first_face = Index(first_edge + t_.edge_.size());
    for_each_with_subset(w_.vertex_, w_.core_vertex_, [&](Index v, bool core) {
      w_.vertices_.push_back({t_.vertex_[v], v, core});
    });
    for_each_with_subset(w_.edge_, w_.core_edge_, [&](Index e, bool core) {
      const Terrain::Edge edge = t_.edge_[e];
      w_.edges_.push_back({place_of(w_.vertex_, edge.a), place_of(w_.vertex_, edge.b), first_edge + e, core});
    });
    for_each_with_subset(w_.triangle_, w_.core_triangle_, [&](Index t, bool core) {
      const Terrain::Triangle& triangle = t_.triangle_[t];
      Face face{{}, {}, first_face + t, triangle.vertical, core};
      for (std::size_t i = 0; i < 3; ++i) {
        face.vertex[i] = place_of(w_.vertex_, triangle.vertex[i]);
        face.edge[i] = place_of(w_.edge_, triangle.edge[i]);
      }
      w_.faces_.push_back(face);
    });
  }

  TerrainWindow& w_;
  const Terrain& t_;
  Point low_, high_;
};

void TerrainWindow::fill_mesh(const Terrain& terrain, Point low, Point high) {
  if (!(low.x <= high.x) || !(low.y <= high.y)) return;
  MeshFill(*this, terrain, low, high).run();
}

}  // namespace krepl
