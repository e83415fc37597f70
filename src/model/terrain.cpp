#include "krepl/terrain.hpp"

#include <algorithm>
#include <cmath>

namespace krepl {

double Terrain::extent() const {
  return std::max({std::abs(lowest_.x), std::abs(lowest_.y), std::abs(lowest_.z), std::abs(highest_.x),
                   std::abs(highest_.y), std::abs(highest_.z)});
}

std::size_t Terrain::feature_bound() const {
  if (is_grid_) return 6 * grid_.columns * grid_.rows;
  return vertex_.size() + edge_.size() + triangle_.size();
}

Terrain::FeatureKind Terrain::feature_kind(Index feature) const {
  if (is_grid_) {
    const unsigned k = feature % 6;
    return k == 0 ? FeatureKind::vertex : k < 4 ? FeatureKind::edge : FeatureKind::face;
  }
  if (feature < vertex_.size()) return FeatureKind::vertex;
  return feature < vertex_.size() + edge_.size() ? FeatureKind::edge : FeatureKind::face;
}

Terrain::Corners Terrain::corners(Index feature) const {
  if (is_grid_) return grid_corners(feature);
  if (feature < vertex_.size()) return {{vertex_[feature]}, 1};
  feature -= Index(vertex_.size());
  if (feature < edge_.size()) return {{vertex_[edge_[feature].a], vertex_[edge_[feature].b]}, 2};
  const auto& v = triangle_[feature - edge_.size()].vertex;
  return {{vertex_[v[0]], vertex_[v[1]], vertex_[v[2]]}, 3};
}

}  // namespace krepl
