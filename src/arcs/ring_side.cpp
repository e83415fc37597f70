#include "arcs/ring_side.hpp"

#include <algorithm>
#include <array>

#include "model/arc_circle.hpp"
#include "model/part_segments.hpp"

namespace krepl::arcs {
namespace {

Index arc_over(const CurveNetwork& network, Index a, Index m, Index b) {
  if (b < a) std::swap(a, b);
  const auto key = std::array{a, b, m};
  const auto arcs = network.arcs();
  const auto at = std::lower_bound(arcs.begin(), arcs.end(), key, [](const CurveNetwork::Arc& arc, const auto& k) {
    return std::array{arc.start, arc.end, arc.middle} < k;
  });
  return Index(at - arcs.begin());
}

}  // namespace

void append_sides(const CurveNetwork& network, Index part, std::vector<RingSide>& out) {
  const Network& straight = network.straight();
  const auto chain = straight.part(part);
  const auto middles = network.part_middles(part);
  const auto at = [&](std::size_t i) { return chain[i % chain.size()]; };
  const std::size_t count = straight.part_is_ring(part) ? chain.size() : chain.size() - 1;
  auto middle = middles.begin();
  for (std::size_t i = 0; i < count; ++i) {
    RingSide side{at(i), at(i + 1), none, part, straight.part_feature(part)};
    if (middle == middles.end() || *middle != i + 1) {
      if (side.from == side.to) continue;
      side.source = find_segment(straight, side.from, side.to);
      out.push_back(side);
      continue;
    }
    ++middle, ++i;
    side.middle = side.to, side.to = at(i + 1);
    if (side.from == side.to && side.from == side.middle) continue;
    side.from_arc = true;
    side.source = arc_over(network, side.from, side.middle, side.to);
    const auto v = straight.vertices();
    const auto circle = model::arc_circle<quad>(v[side.from], v[side.middle], v[side.to]);
    side.left = circle.left, side.radius = circle.radius;
    side.centre = Vector<quad>{v[side.from].x, v[side.from].y} + Vector<quad>{circle.to_center_x, circle.to_center_y};
    side.arc = std::isfinite(double(side.radius));
    out.push_back(side);
  }
}

}  // namespace krepl::arcs
