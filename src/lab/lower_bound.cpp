#include "lab/lower_bound.hpp"

namespace krepl::lab {

namespace {

using Index = Terrain::Index;

constexpr double needle_distance = 1.75;  // spheres of neighbours meet below the strips
constexpr double needle_height = 0.4;     // a sphere reaches 0.8 from its needle
constexpr double trough_width = 0.25;
constexpr double trough_depth = 1.5;  // needles so steep that only their tips are touched
constexpr double grooves_width = 1;   // of all together: the spheres reach beyond them

/// Positions in x at both ends of the terrain: the walls' top and foot, the ridges' foot and end; the feet themselves.
struct Ends {
  std::array<double, 2> top, foot, ridge_foot, ridge;
  std::array<std::vector<Index>, 2> feet;
};

Ends ends_of(std::size_t needles) {
  const double length = 0.5 + double(needles + 1) * needle_distance;
  return {{0, length}, {0.0625, length - 0.0625}, {0.125, length - 0.125}, {0.25, length - 0.25}, {}};
}

struct Builder {
  Construction c;
  Ends ends;
  std::vector<double> ridge_y;
  std::vector<std::array<Index, 2>> ridge;
  std::size_t trough;  // it lies between this ridge and the next
  double depth;        // of the grooves

  /// A groove between two ridges: its bottom is a line.
  void groove(std::size_t k) {
    const double y = (ridge_y[k] + ridge_y[k + 1]) / 2;
    const Index a = c.add({ends.ridge_foot[0], y, -depth}), b = c.add({ends.ridge_foot[1], y, -depth});
    ends.feet[0].push_back(a), ends.feet[1].push_back(b);
    for (const auto& side : {ridge[k], ridge[k + 1]}) c.add(side[0], a, b), c.add(side[0], b, side[1]);
  }

  /// The trough: two steep sides and a row of pyramids on its floor, base to base.
  void needles(std::size_t count) {
    std::vector<double> x{ends.ridge_foot[0]};
    for (std::size_t i = 0; i <= count; ++i) x.push_back(ends.ridge[0] + needle_distance * (double(i) + 0.5));
    x.push_back(ends.ridge_foot[1]);
    std::array<std::vector<Index>, 2> base;
    for (std::size_t side = 0; side < 2; ++side) {
      const double y = (side == 0 ? -1 : 1) * trough_width / 4;
      for (const double at : x) base[side].push_back(c.add({at, y, -trough_depth}));
      const auto& top = ridge[trough + side];
      for (std::size_t i = 0; i + 1 < x.size(); ++i) c.add(top[0], base[side][i], base[side][i + 1]);
      c.add(top[0], base[side].back(), top[1]);
      ends.feet[0].push_back(base[side].front()), ends.feet[1].push_back(base[side].back());
    }
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      const std::array<Index, 4> floor{base[0][i], base[0][i + 1], base[1][i + 1], base[1][i]};
      if (i == 0 || i + 2 == x.size()) {
        c.add(floor[0], floor[1], floor[2]), c.add(floor[0], floor[2], floor[3]);
        continue;
      }
      const Index tip = c.add({(x[i] + x[i + 1]) / 2, 0, needle_height});
      for (std::size_t k = 0; k < 4; ++k) c.add(floor[k], floor[(k + 1) % 4], tip);
    }
  }

  /// A wall across one end, the floor before it, and the ridges' ends. The floor is a fan from both its far corners.
  void wall(std::size_t end) {
    const std::vector<Index>& feet = ends.feet[end];
    const double first_y = ridge_y.front(), last_y = ridge_y.back();
    const Index top[] = {c.add({ends.top[end], first_y, needle_height}), c.add({ends.top[end], last_y, needle_height})};
    const Index foot[] = {c.add({ends.foot[end], first_y, -depth}), c.add({ends.foot[end], last_y, -depth})};
    c.add(top[0], foot[0], foot[1]), c.add(top[0], foot[1], top[1]);
    const std::size_t half = feet.size() / 2;
    for (std::size_t i = 0; i + 1 < feet.size(); ++i) c.add(foot[i < half ? 0 : 1], feet[i], feet[i + 1]);
    c.add(foot[0], feet[half], foot[1]);
    for (std::size_t k = 0, i = 0; k < ridge.size(); ++k, ++i) {
      if (k == trough + 1) ++i;  // the trough has two feet
      c.add(ridge[k][end], feet[i], feet[i + 1]);
    }
  }
};

}  // namespace

Construction lower_bound(std::size_t grooves, std::size_t needles) {
  const double step = grooves_width / double(grooves);
  Builder b{{}, ends_of(needles), {}, {}, grooves / 2, step};
  for (std::size_t k = 0; k <= grooves / 2; ++k)
    b.ridge_y.push_back(-trough_width / 2 - step * double(grooves / 2 - k));
  for (std::size_t k = 0; k <= grooves / 2; ++k) b.ridge_y.push_back(trough_width / 2 + step * double(k));
  for (const double y : b.ridge_y)
    b.ridge.push_back({b.c.add({b.ends.ridge[0], y, 0}), b.c.add({b.ends.ridge[1], y, 0})});
  const auto outer_feet = [&](double y) {
    for (std::size_t end = 0; end < 2; ++end) b.ends.feet[end].push_back(b.c.add({b.ends.ridge_foot[end], y, -step}));
  };
  outer_feet(b.ridge_y.front());
  for (std::size_t k = 0; k + 1 < b.ridge_y.size(); ++k) k == b.trough ? b.needles(needles) : b.groove(k);
  outer_feet(b.ridge_y.back());
  for (std::size_t end = 0; end < 2; ++end) b.wall(end);
  return std::move(b.c);
}

std::size_t lower_bound_vertices(std::size_t grooves, std::size_t needles) {
  return 2 * (grooves + 1) * (needles + 1) + 40;
}

Construction lower_bound_islands(std::size_t blades, std::size_t needles) {
  Construction c;
  const double length = needle_distance * double(needles + 1), step = grooves_width / double(blades);
  for (std::size_t k = 0; k < blades; ++k) {
    const std::size_t from_middle = k < blades / 2 ? blades / 2 - 1 - k : k - blades / 2;
    const double side = k < blades / 2 ? -1 : 1, y = side * (trough_width / 2 + step * double(from_middle));
    c.add({0, y, 0}, {length, y, 0}, {length / 2, y + side * step / 4, -step / 2});
  }
  for (std::size_t i = 0; i < needles; ++i) {
    const double x = needle_distance * double(i + 1), y = trough_width / 4;
    c.add({x, 0, needle_height}, {x - 0.25, -y, -trough_depth}, {x + 0.25, y, -trough_depth});
  }
  return c;
}

}  // namespace krepl::lab
