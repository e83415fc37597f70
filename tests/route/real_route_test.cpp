// Routes through real files: found where the widest route says there is one, measured by brute force, no longer than it, and
// as long there as back.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "krepl/route.hpp"
#include "support/environment.hpp"
#include "support/route_oracle.hpp"
#include "support/wkt_file.hpp"

namespace krepl::test {
namespace {

struct Extent {
  double west = 1e300, east = -1e300, south = 1e300, north = -1e300;
};
Extent extent_of(const ZoneCase& c) {
  Extent e;
  for (const auto& part : c.parts)
    for (Point p : part.vertices)
      e = {std::min(e.west, p.x), std::max(e.east, p.x), std::min(e.south, p.y), std::max(e.north, p.y)};
  return e;
}

TEST(RealRoutes, FromCornerToCorner) {
  const auto paths = real_wkt_files();
  if (paths.empty()) GTEST_SKIP() << "no real data: set KREPL_DATA to a directory with vector/*.wkt";
  for (const auto& path : paths) {
    // Streets, lakes and polygons; brute force of all files would take many minutes.
    const std::string name = path.filename().string();
    if (!name.starts_with("roads_monaco_epsg") && !name.starts_with("earcut_water.") && !name.starts_with("streets_"))
      continue;
    ZoneCase c{read_wkt_file(path), 0};
    const Extent e = extent_of(c);
    const double size = std::max(e.east - e.west, e.north - e.south);
    auto network = network_of(c);
    ASSERT_TRUE(network.ok());
    const auto shared = std::make_shared<const Network>(std::move(*network));
    for (const double part : {1e-4, 3e-3}) {
      SCOPED_TRACE(testing::Message() << path.filename() << " R = " << part << " extents");
      c.radius = part * size;
      RouteOptions options;
      options.radius = c.radius;
      options.from = {e.west - 2 * c.radius, e.south - 2 * c.radius};
      options.to = {e.east + 2 * c.radius, e.north + 2 * c.radius};
      const auto there = compute_route(shared, options);
      ASSERT_TRUE(there.ok()) << there.error().text();
      EXPECT_EQ(fault_in_route(*there, c, options.from, options.to, true).value_or("none"), "none");
      std::swap(options.from, options.to);
      const auto back = compute_route(shared, options);
      ASSERT_TRUE(back.ok()) << back.error().text();
      EXPECT_NEAR(there->length, back->length, 1e-9 * size);
      options.prefer = RoutePreference::clearance;
      const auto widest = compute_route(shared, options);
      ASSERT_TRUE(widest.ok()) << widest.error().text();
      EXPECT_GE(widest->length, there->length * (1 - 1e-12));
      std::printf("%s R = %g: length %.9g, %zu pieces, %llu of %llu arcs\n", path.filename().c_str(), c.radius,
                  there->length, there->pieces.size(), static_cast<unsigned long long>(there->counters.arrivals),
                  static_cast<unsigned long long>(there->counters.arcs));
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace krepl::test
