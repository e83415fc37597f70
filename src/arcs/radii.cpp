#include "arcs/radii.hpp"

#include <algorithm>

#include "arcs/ring_side.hpp"

namespace krepl::arcs {

Radii::Radii(const CurveNetwork& network, std::span<const double> part_radii)
    : least_(*std::min_element(part_radii.begin(), part_radii.end())),
      most_(*std::max_element(part_radii.begin(), part_radii.end())),
      segment_(network.straight().segments().size(), 0),
      arc_(network.arcs().size(), 0),
      vertex_(network.straight().vertices().size(), 0) {
  const Network& straight = network.straight();
  std::vector<RingSide> sides;
  for (std::uint32_t p = 0; p < straight.part_count(); ++p) {
    const auto widen = [&](double& radius) { radius = std::max(radius, part_radii[p]); };
    sides.clear();
    append_sides(network, p, sides);
    for (const RingSide& side : sides) {
      widen((side.from_arc ? arc_ : segment_)[side.source]);
      widen(vertex_[side.from]);
      widen(vertex_[side.to]);
    }
    if (sides.empty()) widen(vertex_[straight.part(p)[0]]);
  }
}

}  // namespace krepl::arcs
