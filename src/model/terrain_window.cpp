#include "model/terrain_window.hpp"

namespace krepl {
namespace {

/// Compressed rows of which item i stands in the rows that `rows_of(i)` names; ascending within a row.
template <class RowsOf>
void compress(std::size_t rows, std::size_t items, const RowsOf& rows_of, std::vector<Terrain::Index>& begin,
              std::vector<Terrain::Index>& of) {
  using Index = Terrain::Index;
  begin.assign(rows + 1, 0);
  for (std::size_t i = 0; i < items; ++i)
    for (const Index row : rows_of(i)) ++begin[row + 1];
  for (std::size_t r = 0; r < rows; ++r) begin[r + 1] += begin[r];
  of.resize(begin[rows]);
  for (std::size_t i = 0; i < items; ++i)
    for (const Index row : rows_of(i)) of[begin[row]++] = Index(i);
  for (std::size_t r = rows; r > 0; --r) begin[r] = begin[r - 1];  // each has moved on to its row's end
  begin[0] = 0;
}

}  // namespace

void TerrainWindow::fill(const Terrain& terrain, Point low, Point high) {
  vertices_.clear();
  edges_.clear();
  faces_.clear();
  is_graph_ = terrain.is_grid();
  if (is_graph_)
    fill_grid(terrain, low, high);
  else
    fill_mesh(terrain, low, high);
  connect();
}

void TerrainWindow::connect() {
  compress(
      edges_.size(), faces_.size(), [&](std::size_t f) { return faces_[f].edge; }, edge_face_begin_, edge_face_);
  compress(
      vertices_.size(), faces_.size(), [&](std::size_t f) { return faces_[f].vertex; }, vertex_face_begin_,
      vertex_face_);
  compress(
      vertices_.size(), edges_.size(),
      [&](std::size_t e) {
        return std::array{edges_[e].a, edges_[e].b};
      },
      vertex_edge_begin_, vertex_edge_);
}

}  // namespace krepl
