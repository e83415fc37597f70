#include "drop_terrains.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace krepl::test {

namespace {

using Index = Terrain::Index;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

Terrain::Split any_split(Random& random) {
  constexpr Terrain::Split splits[] = {Terrain::Split::rising, Terrain::Split::falling, Terrain::Split::shorter};
  return splits[random() % 3];
}

Terrain::Grid any_grid(Random& random) {
  Terrain::Grid grid;
  grid.columns = 2 + random() % 24, grid.rows = 2 + random() % 24;
  grid.first = {uniform(random, -50, 50), uniform(random, -50, 50)};
  grid.cell_x = exponential(random, -0.5, 0.5), grid.cell_y = grid.cell_x * exponential(random, -0.2, 0.2);
  grid.split = any_split(random);
  return grid;
}

template <class Height>
std::vector<double> heights(const Terrain::Grid& grid, const Height& height) {
  std::vector<double> z;
  for (std::size_t j = 0; j < grid.rows; ++j)
    for (std::size_t i = 0; i < grid.columns; ++i) z.push_back(height(i, j));
  return z;
}

void punch(Random& random, std::vector<double>& z, double share) {
  for (double& h : z)
    if (uniform(random, 0, 1) < share) h = missing;
  // One cell at least must be left.
  if (std::isnan(z[0])) z[0] = 1;
}

/// A sum of waves of falling height.
std::vector<double> rough(Random& random, const Terrain::Grid& grid, double height) {
  struct Wave {
    double x, y, phase, height;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < 5; ++k) {
    const double turn = uniform(random, 0, 2 * std::numbers::pi), pitch = 0.3 * std::pow(1.8, k);
    waves.push_back({std::cos(turn) * pitch, std::sin(turn) * pitch, uniform(random, 0, 7), height * std::pow(0.6, k)});
  }
  return heights(grid, [&](std::size_t i, std::size_t j) {
    double z = 0.05 * height * uniform(random, -1, 1);
    for (const Wave& w : waves) z += w.height * std::sin(w.x * double(i) + w.y * double(j) + w.phase);
    return z;
  });
}

DropCase rough_grid(Random& random) {
  const Terrain::Grid grid = any_grid(random);
  return grid_case("rough grid", grid, rough(random, grid, grid.cell_x * exponential(random, -2, 1.5)));
}

DropCase grid_with_holes(Random& random) {
  Terrain::Grid grid = any_grid(random);
  grid.columns += 3, grid.rows += 3;
  std::vector<double> z = rough(random, grid, grid.cell_x);
  punch(random, z, uniform(random, 0, 0.4));
  for (std::size_t s : {std::size_t{0}, std::size_t{1}, grid.columns, grid.columns + 1})
    if (std::isnan(z[s])) z[s] = 0;
  return grid_case("grid with holes", grid, z);
}

DropCase whole_numbers(Random& random) {
  Terrain::Grid grid = any_grid(random);
  grid.first = {double(random() % 9), double(random() % 9)};
  grid.cell_x = grid.cell_y = double(1 + random() % 3);
  const int steps = 1 + int(random() % 4);
  return grid_case("whole numbers", grid, heights(grid, [&](auto, auto) { return double(int(random() % unsigned(steps))); }));
}

DropCase flat(Random& random) {
  const Terrain::Grid grid = any_grid(random);
  const double level = double(random() % 3) * 17;
  return grid_case("flat", grid, heights(grid, [&](auto, auto) { return level; }));
}

DropCase spikes(Random& random) {
  const Terrain::Grid grid = any_grid(random);
  return grid_case("spikes", grid, heights(grid, [&](auto, auto) {
    return random() % 9 == 0 ? grid.cell_x * exponential(random, -1, 3.5) : 0.0;
  }));
}

/// A hollow that a ball of one radius fits nearly everywhere.
DropCase hollow(Random& random) {
  Terrain::Grid grid = any_grid(random);
  const double radius = double(grid.columns + grid.rows) * grid.cell_x;
  return grid_case("hollow", grid, heights(grid, [&](std::size_t i, std::size_t j) {
    const double x = (double(i) - double(grid.columns) / 2) * grid.cell_x;
    const double y = (double(j) - double(grid.rows) / 2) * grid.cell_y;
    return -std::sqrt(radius * radius - x * x - y * y);
  }));
}

DropCase far_away(Random& random) {
  Terrain::Grid grid = any_grid(random);
  grid.first = {500000 + uniform(random, 0, 1000), 4.6e6 + uniform(random, 0, 1000)};
  std::vector<double> z = rough(random, grid, grid.cell_x);
  for (double& h : z) h += 1000;
  return grid_case("coordinates of UTM size", grid, z);
}

DropCase large_grid(Random& random) {
  Terrain::Grid grid = any_grid(random);
  grid.columns = 60 + random() % 60, grid.rows = 60 + random() % 60;
  return grid_case("large grid", grid, rough(random, grid, 3 * grid.cell_x));
}

DropCase grid_as_mesh(Random& random) { return as_mesh(random() % 2 == 0 ? rough_grid(random) : whole_numbers(random)); }

/// Triangles anywhere: overhangs, crossings, slivers.
DropCase soup(Random& random) {
  std::vector<Point3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  const int count = 1 + int(random() % 60);
  const double size = exponential(random, -1, 1);
  for (int t = 0; t < count; ++t) {
    const Point3 at{uniform(random, 0, 10), uniform(random, 0, 10), uniform(random, 0, 3)};
    for (int k = 0; k < 3; ++k) {
      const double flatness = random() % 4 == 0 ? 1e-4 : 1;
      vertices.push_back({at.x + size * uniform(random, -1, 1), at.y + size * flatness * uniform(random, -1, 1),
                          at.z + size * uniform(random, -1, 1)});
    }
    const Index n = Index(3 * t);
    triangles.push_back({n, n + 1, n + 2});
  }
  return mesh_case("soup", vertices, triangles);
}

/// Boxes with vertical walls, top and bottom, on whole numbers: closed parts, several of them, touching and overlapping.
DropCase boxes(Random& random) {
  std::vector<Point3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  const int count = 1 + int(random() % 8);
  for (int b = 0; b < count; ++b) {
    const double x = double(random() % 8), y = double(random() % 8), z = double(random() % 3);
    const double dx = double(1 + random() % 4), dy = double(1 + random() % 4), dz = double(1 + random() % 4);
    const Index n = Index(vertices.size());
    for (int k = 0; k < 8; ++k) vertices.push_back({x + (k & 1 ? dx : 0), y + (k & 2 ? dy : 0), z + (k & 4 ? dz : 0)});
    constexpr Index quads[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (const auto& q : quads) {
      triangles.push_back({n + q[0], n + q[1], n + q[2]});
      triangles.push_back({n + q[0], n + q[2], n + q[3]});
    }
  }
  return mesh_case("boxes", vertices, triangles);
}

/// Walls that are vertical but for rounding, and needles.
DropCase walls(Random& random) {
  std::vector<Point3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  const int count = 1 + int(random() % 12);
  for (int t = 0; t < count; ++t) {
    const Point3 a{uniform(random, 0, 10), uniform(random, 0, 10), 0}, b{uniform(random, 0, 10), uniform(random, 0, 10), 0};
    const double lean = exponential(random, -17, -1), s = uniform(random, 0, 1), tall = exponential(random, -1, 1.5);
    const Index n = Index(vertices.size());
    vertices.insert(vertices.end(), {a, b, {a.x + s * (b.x - a.x) + lean, a.y + s * (b.y - a.y) - lean, tall}});
    triangles.push_back({n, n + 1, n + 2});
  }
  return mesh_case("walls", vertices, triangles);
}

}  // namespace

double uniform(Random& random, double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
double exponential(Random& random, double low, double high) { return std::pow(10, uniform(random, low, high)); }

DropCase grid_case(std::string name, const Terrain::Grid& grid, std::vector<double> z) {
  DropCase c;
  c.name = std::move(name);
  c.cell = std::sqrt(grid.cell_x * grid.cell_y);
  Result<Terrain> terrain = Terrain::from_grid(grid, z);
  if (!terrain) {
    ADD_FAILURE() << terrain.error().text();
    return c;
  }
  c.terrain = std::make_shared<const Terrain>(std::move(*terrain));
  const Point first = c.terrain->grid().first;
  const auto at = [&](std::size_t i, std::size_t j) {
    return Point3{first.x + double(i) * grid.cell_x, first.y + double(j) * grid.cell_y,
                  z[j * grid.columns + i] - c.terrain->origin().z};
  };
  const auto add = [&](Point3 a, Point3 b, Point3 d) {
    if (!std::isnan(a.z) && !std::isnan(b.z) && !std::isnan(d.z)) c.triangles.push_back({a, b, d});
  };
  for (std::size_t j = 0; j + 1 < grid.rows; ++j)
    for (std::size_t i = 0; i + 1 < grid.columns; ++i) {
      const Point3 sw = at(i, j), se = at(i + 1, j), nw = at(i, j + 1), ne = at(i + 1, j + 1);
      bool falling = grid.split == Terrain::Split::falling;
      if (grid.split == Terrain::Split::shorter) {
        const double down = std::abs(se.z - nw.z), rise = std::abs(sw.z - ne.z);
        falling = !std::isnan(down) && (std::isnan(rise) || down < rise);
      }
      if (falling) add(sw, se, nw), add(se, ne, nw);
      else add(sw, se, ne), add(sw, ne, nw);
    }
  return c;
}

DropCase mesh_case(std::string name, std::vector<Point3> vertices, std::vector<std::array<Index, 3>> triangles) {
  DropCase c;
  c.name = std::move(name);
  Result<Terrain> terrain = Terrain::from_triangles(vertices, triangles);
  if (!terrain) {
    ADD_FAILURE() << terrain.error().text();
    return c;
  }
  c.terrain = std::make_shared<const Terrain>(std::move(*terrain));
  const Point3 o = c.terrain->origin();
  for (const auto& t : triangles) {
    std::array<Point3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = {vertices[t[k]].x - o.x, vertices[t[k]].y - o.y, vertices[t[k]].z - o.z};
    c.triangles.push_back(p);
  }
  return c;
}

DropCase as_mesh(const DropCase& grid) {
  std::vector<Point3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  for (const auto& t : grid.triangles) {
    const Index n = Index(vertices.size());
    vertices.insert(vertices.end(), t.begin(), t.end());
    triangles.push_back({n, n + 1, n + 2});
  }
  DropCase c = mesh_case(grid.name + " as a mesh", vertices, triangles);
  c.cell = grid.cell;
  return c;
}

const std::vector<DropFamily>& drop_families() {
  static const std::vector<DropFamily> families{
      {"rough_grid", rough_grid}, {"grid_with_holes", grid_with_holes}, {"whole_numbers", whole_numbers},
      {"flat", flat},             {"spikes", spikes},                   {"hollow", hollow},
      {"far_away", far_away},     {"large_grid", large_grid},           {"grid_as_mesh", grid_as_mesh},
      {"soup", soup},             {"boxes", boxes},                     {"walls", walls}};
  return families;
}

double any_radius(Random& random, const DropCase& c) {
  if (random() % 4 == 0) return c.cell * double(1 + random() % 5);
  return c.cell * exponential(random, -2, 2);
}

Point any_place(Random& random, const DropCase& c, double radius) {
  const Point3 low = c.terrain->lowest(), high = c.terrain->highest();
  const auto& t = c.triangles[random() % c.triangles.size()];
  switch (random() % 6) {
    case 0: return {t[0].x, t[0].y};
    case 1: return {t[0].x + (t[1].x - t[0].x) * 0.25, t[0].y + (t[1].y - t[0].y) * 0.25};
    case 2: return {t[0].x + radius, t[0].y};
    case 3: {
      const double s = uniform(random, 0, 1), r = std::min(radius, 3 * c.cell);
      return {t[0].x + s * (t[1].x - t[0].x) + uniform(random, -r, r), t[0].y + s * (t[1].y - t[0].y) + uniform(random, -r, r)};
    }
    default: {
      const double margin = std::min(radius, high.x - low.x + high.y - low.y);
      return {uniform(random, low.x - margin, high.x + margin), uniform(random, low.y - margin, high.y + margin)};
    }
  }
}

}  // namespace krepl::test
