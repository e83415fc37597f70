#include "arcs/feature_rings.hpp"

namespace krepl::arcs {

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
