#include "mill/rough_rings.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::mill {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

/// Numbers of connected parts of what is far, `none` elsewhere; from `begin` on.
std::vector<std::uint32_t> label(const PlaneRaster& raster, const std::vector<char>& is_far, std::uint32_t begin,
                                 std::vector<std::size_t>& seeds) {
  std::vector<std::uint32_t> labels(raster.size(), none);
  std::vector<std::size_t> stack;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (!is_far[v] || labels[v] != none) continue;
    const auto number = begin + std::uint32_t(seeds.size());
    seeds.push_back(v);
    labels[v] = number, stack.push_back(v);
    while (!stack.empty()) {
      const std::size_t at = stack.back(), c = at % raster.columns;
      stack.pop_back();
      const auto attempt = [&](bool inside, std::size_t w) {
        if (inside && is_far[w] && labels[w] == none) labels[w] = number, stack.push_back(w);
      };
      attempt(c > 0, at - 1), attempt(c + 1 < raster.columns, at + 1);
      attempt(at >= raster.columns, at - raster.columns),
          attempt(at + raster.columns < labels.size(), at + raster.columns);
    }
  }
  return labels;
}

/// Adds the parts that are farther than a value, and their borders, to the forest; `labels` become their numbers.
void add_level(const LevelField& field, double value, std::vector<std::uint32_t>& labels,
               std::vector<std::size_t>& seeds, RingForest& forest) {
  const PlaneRaster& raster = field.raster();
  const std::vector<double>& distance = field.distance();
  std::vector<char> is_far(raster.size());
  for (std::size_t v = 0; v < is_far.size(); ++v) is_far[v] = distance[v] > value;
  seeds.clear();
  labels = label(raster, is_far, std::uint32_t(forest.nodes.size()), seeds);
  for (const std::size_t seed : seeds) forest.nodes.push_back({{}, {}, seed});
  for (std::size_t v = 0; v < labels.size(); ++v)
    if (labels[v] != none)
      if (RingNode& node = forest.nodes[labels[v]]; distance[v] > distance[node.farthest]) node.farthest = v;
  const auto crossing = [&](std::size_t far, std::size_t near) {
    const Point a = raster.place(far), b = raster.place(near);
    const double t = (distance[far] - value) / (distance[far] - distance[near]);
    return Point{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
  };
  for (RasterContour& ring : raster_contours(raster, is_far, crossing))
    forest.nodes[labels[ring.high]].rings.push_back(std::move(ring));
}

}  // namespace

RingForest find_rings(const LevelField& field, double first, double spacing) {
  RingForest forest;
  std::vector<std::uint32_t> before, labels, unused;
  std::vector<std::size_t> seeds;
  std::vector<std::vector<std::size_t>> cores;  // of nodes
  for (double k = 0; first + k * spacing <= field.largest(); ++k) {
    const std::size_t begin = forest.nodes.size();
    add_level(field, first + k * spacing, labels, seeds, forest);
    for (std::size_t n = 0; n < seeds.size(); ++n)
      (k == 0 ? forest.roots : forest.nodes[before[seeds[n]]].children).push_back(begin + n);
    // Half a spacing farther, for parts in which there is no further ring.
    const std::size_t middle = forest.nodes.size();
    add_level(field, first + (k + 0.5) * spacing, unused, seeds, forest);
    cores.resize(forest.nodes.size());
    for (std::size_t n = 0; n < seeds.size(); ++n) cores[labels[seeds[n]]].push_back(middle + n);
    before = labels;
  }
  for (std::size_t n = 0; n < forest.nodes.size(); ++n)
    if (forest.nodes[n].children.empty()) forest.nodes[n].children = cores[n];
  return forest;
}

}  // namespace krepl::mill
