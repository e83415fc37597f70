#include "boundary_file.hpp"

#include <fmt/format.h>

#include <map>

#include "input/network_reader.hpp"

namespace krepl::app {

Result<MillBoundary> read_boundary(const std::string& path, const Context& context) {
  input::NetworkRequest request;
  request.path = path;
  const auto read = input::read_network(request, context);
  if (!read) return read.error();
  const Network& network = *read->network;
  const Point origin = network.origin();
  std::map<std::int64_t, std::vector<std::vector<Point>>> features;
  for (std::uint32_t p = 0; p < network.part_count(); ++p) {
    const std::int64_t feature = network.part_feature(p);
    if (!network.part_is_ring(p))
      return Error{ErrorCode::input, "a boundary consists of polygons", fmt::format("feature {}", feature),
                   "leave out lines and points"};
    std::vector<Point> ring;
    for (const std::uint32_t v : network.part(p))
      ring.push_back({network.vertices()[v].x + origin.x, network.vertices()[v].y + origin.y});
    if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    if (ring.size() >= 3) features[feature].push_back(std::move(ring));
  }
  MillBoundary boundary;
  for (auto& [feature, rings] : features) boundary.polygons.push_back(std::move(rings));
  if (boundary.polygons.empty())
    return Error{ErrorCode::input, "holds no polygon with an inside", "", "give polygons for the boundary"};
  return boundary;
}

}  // namespace krepl::app
