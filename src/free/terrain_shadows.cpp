#include "free/terrain_shadows.hpp"

#include "kernel/parallel.hpp"

namespace krepl::free {
namespace {

/// Bits of x and y in turns: neighbours in this order are neighbours in the plane.
std::uint64_t interleaved(std::uint32_t x, std::uint32_t y) {
  const auto spread = [](std::uint64_t v) {
    v = (v | v << 16) & 0x0000FFFF0000FFFFu, v = (v | v << 8) & 0x00FF00FF00FF00FFu;
    v = (v | v << 4) & 0x0F0F0F0F0F0F0F0Fu, v = (v | v << 2) & 0x3333333333333333u;
    return (v | v << 1) & 0x5555555555555555u;
  };
  return spread(x) | spread(y) << 1;
}

}  // namespace

TerrainShadows::TerrainShadows(const Terrain& terrain, const Context& context)
    : terrain_(terrain),
      access_(terrain),
      first_edge_(Terrain::Index(access_.vertices().size())),
      first_triangle_(Terrain::Index(access_.vertices().size() + access_.edges().size())),
      block_(blocks_of(terrain)),
      tree_(boxes(context)) {}

std::vector<TerrainShadows::Block> TerrainShadows::blocks_of(const Terrain& terrain) {
  std::vector<Block> blocks;
  if (!terrain.is_grid()) return blocks;
  const auto across = [](std::size_t samples) { return std::uint32_t((samples - 1 + block_side - 1) / block_side); };
  const std::uint32_t columns = across(terrain.grid().columns), rows = across(terrain.grid().rows);
  blocks.reserve(std::size_t{columns} * rows);
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) blocks.push_back({column, row});
  std::sort(blocks.begin(), blocks.end(),
            [](Block a, Block b) { return interleaved(a.column, a.row) < interleaved(b.column, b.row); });
  return blocks;
}

std::vector<ShadowBox> TerrainShadows::boxes(const Context& context) const {
  const std::size_t triangles = access_.triangles().size();
  std::vector<ShadowBox> boxes(terrain_.is_grid() ? block_.size()
                                                  : (triangles + triangles_per_block - 1) / triangles_per_block);
  kernel::parallel_blocks(context, boxes.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b)
      for_each(b, [&](const Part& part) {
        for (const Point3& p : part.corner) boxes[b].add(p);
      });
  });
  return boxes;
}

Part TerrainShadows::mesh_part(std::size_t t) const {
  const auto& triangle = access_.triangles()[t];
  Part part;
  part.vertex = triangle.vertex;
  part.vertical = triangle.vertical;
  part.face = first_triangle_ + Terrain::Index(t);
  for (std::size_t k = 0; k < 3; ++k) {
    part.corner[k] = access_.vertices()[triangle.vertex[k]];
    part.edge[k] = first_edge_ + triangle.edge[k];
  }
  return part;
}

/// Numbers as terrain_grid.cpp says: 6 * sample + kind. Corners of a cell: bit 0 says +x, bit 1 says +y.
Part TerrainShadows::grid_part(std::size_t column, std::size_t row, bool falling, bool upper) const {
  static constexpr unsigned corners_of[2][2][3] = {{{0, 1, 3}, {0, 3, 2}}, {{0, 1, 2}, {1, 3, 2}}};  // [falling][upper]
  const std::size_t columns = terrain_.grid().columns, sample = row * columns + column;
  const auto at = [&](unsigned corner) { return sample + (corner & 1) + (corner >> 1) * columns; };
  Part part;
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned here = corners_of[falling][upper][k], next = corners_of[falling][upper][(k + 1) % 3];
    part.corner[k] = {access_.grid_x(column + (here & 1)), access_.grid_y(row + (here >> 1)),
                      access_.heights()[at(here)]};
    part.vertex[k] = Terrain::Index(6 * at(here));
    const unsigned kind = (here ^ next) == 1 ? 1 : (here ^ next) == 2 ? 2 : 3;
    part.edge[k] = Terrain::Index(6 * at(kind == 3 ? 0 : std::min(here, next)) + kind);
  }
  part.face = Terrain::Index(6 * sample + (upper ? 5 : 4));
  return part;
}

}  // namespace krepl::free
