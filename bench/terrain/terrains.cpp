#include "terrains.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

namespace bench {

using krepl::Point3;
using krepl::Result;
using krepl::Terrain;

namespace {

/// Midpoint displacement on 2^k + 1 samples a side; each level is 2^-0.8 as rough as the one before.
std::vector<double> displace(std::size_t side) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> z(side * side, 0.0);
  const auto at = [&](std::size_t i, std::size_t j) -> double& { return z[j * side + i]; };
  double height = 0.05 * double(side);  // a slope of about 0.4 from sample to sample
  for (std::size_t step = side - 1; step > 1; step /= 2, height *= std::pow(2, -0.8)) {
    const std::size_t half = step / 2;
    for (std::size_t j = half; j < side; j += step)
      for (std::size_t i = half; i < side; i += step)
        at(i, j) =
            (at(i - half, j - half) + at(i + half, j - half) + at(i - half, j + half) + at(i + half, j + half)) / 4 +
            height * normal(random);
    for (std::size_t j = 0; j < side; j += half)
      for (std::size_t i = (j / half) % 2 == 0 ? half : 0; i < side; i += step) {
        double sum = 0, count = 0;
        if (i >= half) sum += at(i - half, j), ++count;
        if (i + half < side) sum += at(i + half, j), ++count;
        if (j >= half) sum += at(i, j - half), ++count;
        if (j + half < side) sum += at(i, j + half), ++count;
        at(i, j) = sum / count + 0.7 * height * normal(random);
      }
  }
  return z;
}

}  // namespace

double Samples::cell() const { return std::sqrt(grid.cell_x * grid.cell_y); }

Samples read_samples(const std::string& path, double cell) {
  std::ifstream file(path);
  std::size_t columns = 0, rows = 0;
  double size = 0, no_data = NAN;
  std::string word;
  while (file >> word && std::isalpha(static_cast<unsigned char>(word[0]))) {
    double value = 0;
    file >> value;
    if (word == "ncols")
      columns = std::size_t(value);
    else if (word == "nrows")
      rows = std::size_t(value);
    else if (word == "cellsize")
      size = value;
    else if (word == "NODATA_value")
      no_data = value;
  }
  Samples s;
  std::vector<double> z(columns * rows);
  for (std::size_t k = 0; k < z.size(); ++k) {
    double value = 0;
    if (k == 0)
      value = std::strtod(word.c_str(), nullptr);
    else if (!(file >> value))
      return s;
    z[(rows - 1 - k / columns) * columns + k % columns] = value == no_data ? NAN : value;
  }
  s.grid.columns = columns, s.grid.rows = rows, s.grid.cell_x = s.grid.cell_y = cell > 0 ? cell : size;
  s.heights = std::move(z);
  return s;
}

Samples made(std::size_t triangles) {
  constexpr std::size_t side = 1025;
  const std::size_t kept = std::min(side, 1 + std::size_t(std::lround(std::sqrt(double(triangles) / 2))));
  const std::vector<double> z = displace(side);
  Samples s;
  s.grid.columns = s.grid.rows = kept;
  for (std::size_t j = 0; j < kept; ++j)
    for (std::size_t i = 0; i < kept; ++i) s.heights.push_back(z[j * side + i]);
  return s;
}

std::shared_ptr<const Terrain> as_grid(const Samples& samples) {
  Result<Terrain> terrain = Terrain::from_grid(samples.grid, samples.heights);
  return terrain ? std::make_shared<const Terrain>(std::move(*terrain)) : nullptr;
}

std::shared_ptr<const Terrain> as_mesh(const Samples& s) {
  std::vector<Point3> vertices;
  std::vector<std::array<Terrain::Index, 3>> triangles;
  const Terrain::Index columns = Terrain::Index(s.grid.columns);
  for (std::size_t j = 0; j < s.grid.rows; ++j)
    for (std::size_t i = 0; i < s.grid.columns; ++i)
      vertices.push_back({double(i) * s.grid.cell_x, double(j) * s.grid.cell_y, s.heights[j * columns + i]});
  for (Terrain::Index j = 0; j + 1 < s.grid.rows; ++j)
    for (Terrain::Index i = 0; i + 1 < columns; ++i) {
      const Terrain::Index v = j * columns + i;
      triangles.push_back({v, v + 1, v + columns + 1});
      triangles.push_back({v, v + columns + 1, v + columns});
    }
  Result<Terrain> terrain = Terrain::from_triangles(std::move(vertices), std::move(triangles));
  return terrain ? std::make_shared<const Terrain>(std::move(*terrain)) : nullptr;
}

}  // namespace bench
