#pragma once

#include <string>

#include "krepl/route.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

/// A picture: obstacles, their zone (if not null), the route, and the disk at both ends.
Result<ZoneFileReport> write_route_svg(const std::string& path, const Route& route, const Network& network,
                                       const Zone* zone, const Context& context);

}  // namespace krepl::output
