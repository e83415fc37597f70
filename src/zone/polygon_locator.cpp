#include "zone/polygon_locator.hpp"

#include <algorithm>
#include <limits>

#include "kernel/odd_ones.hpp"
#include "kernel/vectors.hpp"

namespace krepl::zone {
namespace {

using vectors::cross;

}  // namespace

PolygonLocator::PolygonLocator(const Network& network) : sides_(sides_of(network)), tree_(boxes_of(sides_)) {}

std::vector<PolygonLocator::Side> PolygonLocator::sides_of(const Network& network) {
  std::vector<Side> sides;
  for (std::uint32_t part = 0; part < network.part_count(); ++part) {
    if (!network.part_is_ring(part)) continue;
    const auto chain = network.part(part);
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const auto a = chain[i], b = chain[(i + 1) % chain.size()];
      if (a != b) sides.push_back({network.vertices()[a], network.vertices()[b], network.part_feature(part)});
    }
  }
  return sides;
}

std::vector<kernel::Box> PolygonLocator::boxes_of(const std::vector<Side>& sides) {
  std::vector<kernel::Box> boxes((sides.size() + chunk - 1) / chunk);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    boxes[i / chunk].add(sides[i].p);
    boxes[i / chunk].add(sides[i].q);
  }
  return boxes;
}

void PolygonLocator::find(Point p, std::vector<std::int64_t>& features) const {
  features.clear();
  const auto far = [] { return -std::numeric_limits<double>::infinity(); };
  tree_.visit_left_of(p, far, [&](std::size_t box) {
    for (std::size_t i = box * chunk; i < std::min(sides_.size(), (box + 1) * chunk); ++i) {
      const Side& s = sides_[i];
      if ((s.p.y <= p.y) == (s.q.y <= p.y)) continue;
      const bool upward = s.p.y < s.q.y;
      if ((cross(s.p, s.q, p) < 0) == upward) features.push_back(s.feature);
    }
  });
  kernel::keep_odd_ones(features);
}

}  // namespace krepl::zone
