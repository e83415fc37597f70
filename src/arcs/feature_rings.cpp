#include "arcs/feature_rings.hpp"

namespace krepl::arcs {

std::map<std::int64_t, std::vector<Index>> rings_by_feature(const CurveNetwork& network) {
  std::map<std::int64_t, std::vector<Index>> rings;
  const Network& straight = network.straight();
  for (Index p = 0; p < straight.part_count(); ++p)
    if (straight.part_is_ring(p)) rings[straight.part_feature(p)].push_back(p);
  return rings;
}

Result<FeatureRings> take_apart(const CurveNetwork& network, const std::vector<Index>& rings, const Context& context) {
  std::vector<RingSide> sides;
  std::vector<Index> collapsed;
  for (const Index ring : rings) {
    const std::size_t before = sides.size();
    append_sides(network, ring, sides);
    if (sides.size() == before) collapsed.push_back(ring);
  }
  auto arrangement = SideArrangement::make(network, sides, context);
  if (!arrangement) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return FeatureRings{std::move(*arrangement), std::move(collapsed)};
}

}  // namespace krepl::arcs
