// Random and adversarial terrains. Real numbers, but for `whole-numbers`, so that what is tangent is so by structure
// only.
#include "lab/families.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/lower_bound.hpp"

namespace krepl::lab {

namespace {

using Index = Terrain::Index;

/// A triangulated grid of unit cells, its vertices moved a bit, each cell split its own way. Heights come from the
/// caller.
template <class Height>
Construction moved_grid(Random& random, std::size_t triangles, Height&& height) {
  const std::size_t cells = std::max<std::size_t>(1, triangles / 2);
  std::size_t columns = 1 + random.below(std::size_t(std::sqrt(double(cells))));
  std::size_t rows = cells / columns;
  if (random.one_in(2)) std::swap(rows, columns);
  Construction c;
  for (std::size_t j = 0; j <= rows; ++j) {
    for (std::size_t i = 0; i <= columns; ++i) {
      const double x = double(i) + random.between(-0.2, 0.2), y = double(j) + random.between(-0.2, 0.2);
      c.add({x, y, height(x, y)});
    }
  }
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      const Index sw = Index(j * (columns + 1) + i), se = sw + 1, nw = sw + Index(columns) + 1, ne = nw + 1;
      if (random.one_in(2))
        c.add(sw, se, ne), c.add(sw, ne, nw);
      else
        c.add(sw, se, nw), c.add(se, ne, nw);
    }
  }
  c.radius = random.scaled(0.2, 10);
  return c;
}

Construction rough(Random& random, std::size_t triangles) {
  const double amplitude = random.scaled(0.1, 4);
  return moved_grid(random, triangles, [&](double, double) { return amplitude * random.between(0, 1); });
}

Construction whole_numbers(Random& random, std::size_t triangles) {
  const std::size_t levels = 2 + random.below(4);
  return moved_grid(random, triangles, [&](double, double) { return double(random.below(levels)); });
}

/// Waves of ever shorter length and lower height, as in real ground.
Construction fractal(Random& random, std::size_t triangles) {
  struct Wave {
    double x, y, phase, height;
  };
  std::vector<Wave> waves;
  const double amplitude = random.scaled(0.2, 4);
  for (int k = 0; k < 6; ++k) {
    const double direction = random.between(0, 2 * std::numbers::pi), number = 0.4 * std::pow(1.8, k);
    waves.push_back({number * std::cos(direction), number * std::sin(direction), random.between(0, 6.3),
                     amplitude * std::pow(0.6, k)});
  }
  return moved_grid(random, triangles, [&](double x, double y) {
    double z = 0;
    for (const Wave& w : waves) z += w.height * std::sin(w.x * x + w.y * y + w.phase);
    return z;
  });
}

Construction spikes(Random& random, std::size_t triangles) {
  const std::size_t share = 2 + random.below(6);
  const double top = random.scaled(0.5, 4);
  return moved_grid(random, triangles, [&](double, double) {
    return random.one_in(share) ? top * random.between(0.5, 1) : random.between(0, 0.2);
  });
}

/// Lines across a strip, high and low in turn, with heights of their own at both ends.
Construction ridges(Random& random, std::size_t triangles) {
  Construction c;
  const double length = random.scaled(2, 50), depth = random.scaled(0.1, 2), uneven = random.scaled(0.01, 1);
  const std::size_t lines = triangles / 2 + 1;
  for (std::size_t k = 0; k < lines; ++k) {
    const double y = double(k) + random.between(-0.3, 0.3), z = k % 2 == 0 ? 0 : -depth;
    const Index a = c.add({0, y, z + uneven * random.between(-1, 1)});
    const Index b = c.add({length, y + random.between(-0.15, 0.15), z + uneven * random.between(-1, 1)});
    if (k > 0) c.add(a - 2, b - 2, b), c.add(a - 2, b, a);
  }
  c.radius = random.scaled(0.5, 2 * double(lines));
  return c;
}

/// Long thin triangles about one vertex, high and low in turn.
Construction fan(Random& random, std::size_t triangles) {
  Construction c;
  const double depth = random.scaled(0.1, 3), top = random.between(-1, 2);
  c.add({0, 0, top});
  for (std::size_t k = 0; k < triangles; ++k) {
    const double turn = 2 * std::numbers::pi * (double(k) + random.between(-0.3, 0.3)) / double(triangles);
    const double length = random.between(3, 6);
    c.add({length * std::cos(turn), length * std::sin(turn), (k % 2 == 0 ? 0 : -depth) + random.between(-0.2, 0.2)});
  }
  for (std::size_t k = 0; k < triangles; ++k) c.add(0, Index(1 + k), Index(1 + (k + 1) % triangles));
  c.radius = random.scaled(0.3, 6);
  return c;
}

/// Standing triangles of many shapes beside the edge of a large one, as in figures.hpp: what stops the ball on the
/// large one is an envelope of bumps of which two may cross four times.
Construction blades(Random& random, std::size_t triangles) {
  Construction c;
  c.add({-20, 0, 0}, {20, 0, 0}, {0, -30, 0});
  const double step = 0.5 / double(triangles);
  for (std::size_t k = 1; k < triangles; ++k) {
    const double y = step * double(k), middle = random.between(-6, 6), half = random.scaled(0.3, 10);
    c.add({middle - half, y, random.between(0, 0.3)}, {middle + half, y, random.between(0, 0.3)},
          {middle + half * random.between(-0.8, 0.8), y + 0.4 * step, random.between(0, 0.9)});
  }
  c.radius = random.scaled(0.7, 1.5);
  return c;
}

void shake(Random& random, Construction& c, double by, double upright) {
  for (Point3& p : c.vertices)
    p = {p.x + random.between(-by, by), p.y + random.between(-by, by), p.z + random.between(-upright, upright)};
  c.radius *= random.between(0.9, 1.1);
}

/// The lower bound with grooves and needles in any proportion, shaken.
Construction shaken_lower_bound(Random& random, std::size_t triangles) {
  const std::size_t most = (triangles - 32) / 8, grooves = 2 + 2 * random.below(most / 2);
  Construction c = lower_bound(grooves, std::max<std::size_t>(1, (triangles - 26 - 8 * grooves) / 6));
  // Tops only: the floor's fans are narrow, and no ball gets there.
  const double by = random.scaled(1e-3, 0.2) / double(grooves);
  for (Point3& p : c.vertices) p.z += p.z >= 0 ? random.between(-by, by) : 0;
  c.radius *= random.between(0.9, 1.1);
  return c;
}

Construction shaken_islands(Random& random, std::size_t triangles) {
  const std::size_t islands = 2 + 2 * random.below((triangles - 1) / 2);
  Construction c = lower_bound_islands(islands, triangles - islands);
  shake(random, c, random.scaled(1e-4, 0.05) / double(islands), random.scaled(1e-3, 0.2) / double(islands));
  return c;
}

/// Two layers of needles across each other over a large triangle, as in figure 4.5.
Construction crossing_layers(Random& random, std::size_t triangles) {
  Construction c;
  const std::size_t along_x = (triangles - 1) / 2, along_y = triangles - 1 - along_x;
  const double far = 1.5 * double(along_y + 1);
  c.add({-far, -far, 0}, {4 * far, -far, 0}, {-far, 4 * far, 0});
  for (std::size_t k = 0; k < along_x; ++k) {
    const double y = 1.5 * double(k) + random.between(-0.1, 0.1), z = random.between(0.05, 0.3);
    c.add({-1, y, z}, {far, y, random.between(0.05, 0.3)}, {far, y + 0.02, z});
  }
  for (std::size_t k = 0; k < along_y; ++k) {
    const double x = 1.5 * double(k) + random.between(-0.1, 0.1), z = random.between(0.35, 0.6);
    c.add({x, -1, z}, {x, far, random.between(0.35, 0.6)}, {x + 0.02, far, z});
  }
  c.radius = random.scaled(0.4, 1);
  return c;
}

Construction soup(Random& random, std::size_t triangles) {
  Construction c;
  const double size = std::sqrt(double(triangles));
  const auto any = [&] { return Point3{random.between(0, size), random.between(0, size), random.between(0, 2)}; };
  for (std::size_t k = 0; k < triangles; ++k) {
    const Point3 a = any(), b = any(), d = any();
    c.add(a, b, d);
  }
  c.radius = random.scaled(0.2, 4);
  return c;
}

constexpr Family all[] = {
    {"rough", "grid, random heights", 2, true, rough},
    {"fractal", "grid, waves of falling length", 2, true, fractal},
    {"whole-numbers", "grid, few whole heights", 2, true, whole_numbers},
    {"spikes", "grid, some vertices far up", 2, true, spikes},
    {"ridges", "long lines, high and low in turn", 2, true, ridges},
    {"fan", "long triangles about one vertex", 5, true, fan},
    {"blades", "standing triangles beside an edge", 3, true, blades},
    {"lower-bound", "section 4.3, shaken", 48, true, shaken_lower_bound},
    {"islands", "section 4.3 of islands, shaken", 3, true, shaken_islands},
    {"crossing", "layers of needles, no terrain", 5, false, crossing_layers},
    {"soup", "any triangles, no terrain", 1, false, soup},
};

}  // namespace

std::span<const Family> families() { return all; }

}  // namespace krepl::lab
