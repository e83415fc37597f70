#include "lab/figures.hpp"

namespace krepl::lab {

Construction crossing_needles() {
  Construction c;
  c.add({-8, -8, 0}, {8, -8, 0}, {0, 9, 0});
  c.add({-3, -0.01, 0.3}, {3, -0.01, 0.3}, {3, 0.01, 0.3});
  c.add({-0.01, -3, 0.5}, {-0.01, 3, 0.5}, {0.01, 3, 0.5});
  return c;
}

Construction crossing_blades() {
  Construction c;
  c.add({-8, 0, 0}, {8, 0, 0}, {0, -8, 0});
  c.add({-6, 0.125, 0}, {6, 0.125, 0}, {0, 0.15625, 0.625});
  c.add({-4.5, 0.0625, 0.25}, {4.5, 0.0625, 0.25}, {0, 0.09375, 0.25});
  return c;
}

Construction two_components() {
  Construction c;
  c.vertices = {{0, 0, 0},          {1, 10, 0},    {-1, 10, 0},   {-0.70, 5, -0.3}, {-0.80, 4.8, -0.4},
                {-0.80, 5.2, -0.4}, {-0.76, 5, 4}, {-12, 10, -8}, {-3, -12, -8}};
  const std::size_t left = c.vertices.size();
  for (std::size_t i = 3; i < left; ++i) {
    const Point3 p = c.vertices[i];
    c.add({-p.x, p.y, p.z});
  }
  c.triangles = {{0, 1, 2}, {0, 8, 14}};
  for (const bool right : {false, true}) {
    // The names of docs and of the thesis's errata: b the notch's corner, q its side, n the needle's tip, f and g the
    // corners.
    const Terrain::Index b = right ? 1 : 2, o = right ? 6 : 0, q = 3 + o, q2 = 4 + o, q3 = 5 + o, n = 6 + o, f = 7 + o,
                         g = 8 + o;
    const Construction::Triangle side[] = {{0, b, q},   {0, q, q2}, {q, b, q3},  {q, n, q2}, {q, q3, n},
                                           {q2, n, q3}, {b, f, q3}, {q3, f, q2}, {q2, f, g}, {g, 0, q2}};
    c.triangles.insert(c.triangles.end(), std::begin(side), std::end(side));
  }
  return c;
}

}  // namespace krepl::lab
