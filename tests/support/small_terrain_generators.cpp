// Small terrains from bytes, and smaller ones from small ones.
#include <algorithm>
#include <cmath>
#include <limits>

#include "support/byte_reader.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {

namespace {

using Triangle = SmallTerrain::Triangle;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

// Radii at which balls touch many lattice points at once, and others.
double any_radius(ByteReader& in) {
  static const double table[] = {0.25,           0.3, 0.5, 0.75, 1, 1.25, 1.5, 2, 2.5, std::sqrt(0.5), std::sqrt(2.0),
                                 std::sqrt(5.0), 3,   5,   7,    20};
  return table[in.below(16)];
}

/// A grid of up to 6 x 6 samples; all that is left to read are its heights.
void shape(ByteReader& in, SmallTerrain& c) {
  c.grid.columns = 2 + in.below(5);
  c.grid.rows = 2 + in.below(5);
  c.grid.split = Terrain::Split(in.below(3));
  c.heights.assign(c.grid.columns * c.grid.rows, 0);
}

void diagonals(ByteReader& in, SmallTerrain& c) {
  shape(in, c);
  const unsigned most = 2 + in.below(4);
  std::vector<double> z(c.heights.size());
  for (double& h : z) h = in.below(most);
  c.is_grid = false;
  const auto at = [&](std::size_t i, std::size_t j) { return Point3{double(i), double(j), z[j * c.grid.columns + i]}; };
  for (std::size_t j = 0; j + 1 < c.grid.rows; ++j) {
    for (std::size_t i = 0; i + 1 < c.grid.columns; ++i) {
      const Point3 sw = at(i, j), se = at(i + 1, j), nw = at(i, j + 1), ne = at(i + 1, j + 1);
      if (in.below(2) == 0) {
        c.triangles.insert(c.triangles.end(), {Triangle{sw, se, nw}, Triangle{se, ne, nw}});
      } else {
        c.triangles.insert(c.triangles.end(), {Triangle{sw, se, ne}, Triangle{sw, ne, nw}});
      }
    }
  }
}

void steps(ByteReader& in, SmallTerrain& c) {
  c.is_grid = false;
  const unsigned columns = 1 + in.below(3), rows = 1 + in.below(3), most = 2 + in.below(3);
  std::vector<double> z(columns * rows);
  for (double& h : z) h = in.below(most);
  const auto quad = [&](Point3 p, Point3 q, Point3 r, Point3 s) {
    c.triangles.insert(c.triangles.end(), {Triangle{p, q, r}, Triangle{p, r, s}});
  };
  const auto level = [&](unsigned i, unsigned j) { return i < columns && j < rows ? z[j * columns + i] : -1.0; };
  for (unsigned j = 0; j < rows; ++j) {
    for (unsigned i = 0; i < columns; ++i) {
      const double h = level(i, j), x = 2 * i, y = 2 * j;
      quad({x, y, h}, {x + 2, y, h}, {x + 2, y + 2, h}, {x, y + 2, h});
      const double east = level(i + 1, j), north = level(i, j + 1);
      if (east != h) quad({x + 2, y, h}, {x + 2, y + 2, h}, {x + 2, y + 2, east}, {x + 2, y, east});
      if (north != h) quad({x, y + 2, h}, {x + 2, y + 2, h}, {x + 2, y + 2, north}, {x, y + 2, north});
    }
  }
}

void soup(ByteReader& in, SmallTerrain& c) {
  c.is_grid = false;
  const auto point = [&] {
    const unsigned b = in.byte();
    return Point3{double(b & 7), double(b >> 3 & 7), double(b >> 6)};
  };
  do {
    const Point3 p = point(), q = point(), r = point();
    c.triangles.push_back({p, q, r});
  } while (in.more() && c.triangles.size() < 8);
}

SmallTerrain without_row(const SmallTerrain& c, std::size_t row) {
  SmallTerrain s = c;
  const auto from = s.heights.begin() + std::ptrdiff_t(row * c.grid.columns);
  s.heights.erase(from, from + std::ptrdiff_t(c.grid.columns));
  --s.grid.rows;
  return s;
}

SmallTerrain without_column(const SmallTerrain& c, std::size_t column) {
  SmallTerrain s = c;
  s.heights.clear();
  for (std::size_t i = 0; i < c.heights.size(); ++i) {
    if (i % c.grid.columns != column) s.heights.push_back(c.heights[i]);
  }
  --s.grid.columns;
  return s;
}

}  // namespace

const char* name(SmallTerrainFamily family) {
  constexpr const char* names[] = {"grid", "steep", "holes", "diagonals", "steps", "soup"};
  return names[std::size_t(family)];
}

SmallTerrain decode_small_terrain(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return decode_small_terrain(SmallTerrainFamily::grid, bytes);
  return decode_small_terrain(SmallTerrainFamily(bytes[0] % unsigned(SmallTerrainFamily::count)), bytes.subspan(1));
}

SmallTerrain decode_small_terrain(SmallTerrainFamily family, std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  SmallTerrain c;
  c.radius = any_radius(in);
  switch (family) {
    case SmallTerrainFamily::diagonals:
      diagonals(in, c);
      return c;
    case SmallTerrainFamily::steps:
      steps(in, c);
      return c;
    case SmallTerrainFamily::soup:
      soup(in, c);
      return c;
    default:
      break;
  }
  shape(in, c);
  const unsigned most = family == SmallTerrainFamily::steep ? 200 : 2 + in.below(4);
  for (double& h : c.heights) {
    h = in.below(most);
    if (family == SmallTerrainFamily::holes && in.below(6) == 0) h = missing;
  }
  return c;
}

std::vector<SmallTerrain> smaller(const SmallTerrain& c) {
  std::vector<SmallTerrain> all;
  if (!c.is_grid) {
    for (std::size_t t = 0; t < c.triangles.size() && c.triangles.size() > 1; ++t) {
      all.push_back(c);
      all.back().triangles.erase(all.back().triangles.begin() + std::ptrdiff_t(t));
    }
    // A vertex lowered in all triangles that use it.
    for (const auto& t : c.triangles) {
      for (const Point3 p : t) {
        if (!(p.z > 0)) continue;
        all.push_back(c);
        for (auto& u : all.back().triangles) {
          for (Point3& q : u) {
            if (q == p) q.z = std::floor((q.z - 0.5) / 1);
          }
        }
      }
    }
    return all;
  }
  for (std::size_t r = 0; r < c.grid.rows && c.grid.rows > 2; ++r) all.push_back(without_row(c, r));
  for (std::size_t k = 0; k < c.grid.columns && c.grid.columns > 2; ++k) all.push_back(without_column(c, k));
  for (std::size_t i = 0; i < c.heights.size(); ++i) {
    for (const double h : {0.0, std::floor(c.heights[i] / 2), c.heights[i] - 1}) {
      if (std::isnan(c.heights[i]) ? h != 0 : !(h >= 0 && h < c.heights[i])) continue;
      all.push_back(c);
      all.back().heights[i] = h;
    }
  }
  return all;
}

}  // namespace krepl::test
