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
      attempt(at >= raster.columns, at - raster.columns), attempt(at + raster.columns < labels.size(), at + raster.columns);
    }
  }
  return labels;
}

}  // namespace

RingForest find_rings(const LevelField& field, double first, double spacing) {
  const PlaneRaster& raster = field.raster();
  const std::vector<double>& distance = field.distance();
  RingForest forest;
  std::vector<std::uint32_t> before;
  std::vector<char> is_far(raster.size());
  for (double k = 0; first + k * spacing <= field.largest(); ++k) {
    const double value = first + k * spacing;
    for (std::size_t v = 0; v < is_far.size(); ++v) is_far[v] = distance[v] > value;
    std::vector<std::size_t> seeds;
    const auto begin = std::uint32_t(forest.nodes.size());
    std::vector<std::uint32_t> labels = label(raster, is_far, begin, seeds);
    for (const std::size_t seed : seeds) {
      if (k == 0)
        forest.roots.push_back(forest.nodes.size());
      else
        forest.nodes[before[seed]].children.push_back(forest.nodes.size());
      forest.nodes.push_back({{}, {}, seed});
    }
    for (std::size_t v = 0; v < labels.size(); ++v)
      if (labels[v] != none)
        if (RingNode& node = forest.nodes[labels[v]]; distance[v] > distance[node.farthest]) node.farthest = v;
    for (RasterContour& ring : raster_contours(raster, is_far, [&](std::size_t far, std::size_t near) {
           const Point a = raster.place(far), b = raster.place(near);
           const double t = (distance[far] - value) / (distance[far] - distance[near]);
           return Point{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
         }))
      forest.nodes[labels[ring.high]].rings.push_back(std::move(ring));
    before = std::move(labels);
  }
  return forest;
}

}  // namespace krepl::mill
