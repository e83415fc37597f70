// Every real file of KREPL_DATA/vector at radii from a fraction of a mean segment length to far above it: rings close
// and the boundary is within 1e-9 S of its true place, by brute force.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "support/environment.hpp"
#include "support/wkt_file.hpp"

namespace krepl::test {
namespace {

double mean_segment_length(const std::vector<InputPart>& parts) {
  double sum = 0;
  std::size_t count = 0;
  for (const InputPart& part : parts)
    for (std::size_t i = 0; i + 1 < part.vertices.size(); ++i, ++count)
      sum += std::hypot(part.vertices[i + 1].x - part.vertices[i].x, part.vertices[i + 1].y - part.vertices[i].y);
  return sum / double(count);
}

void expect_sound(ZoneCase& c, double lengths, double mean) {
  c.radius = lengths * mean;
  const auto zone = zone_of(c);
  ASSERT_TRUE(zone.ok()) << zone.error().text();
  EXPECT_EQ(fault_in(*zone, c, 0.02).value_or("sound"), "sound") << "R = " << lengths << " mean lengths";
  std::printf("  R = %5g lengths: %7zu pieces, %5zu polygons, %6zu holes\n", lengths, zone->piece_count(),
              zone->polygon_count(), zone->hole_count());
}

TEST(RealFiles, SoundAtAllRadii) {
  const auto paths = real_wkt_files();
  if (paths.empty()) GTEST_SKIP() << "no real data: set KREPL_DATA to a directory with vector/*.wkt";
  for (const auto& path : paths) {
    std::printf("%s\n", path.filename().c_str());
    SCOPED_TRACE(path.filename());
    ZoneCase c{read_wkt_file(path), 0};
    const double mean = mean_segment_length(c.parts);
    for (const double lengths : {0.1, 1.0, 10.0, 100.0}) expect_sound(c, lengths, mean);
    // The same lines without their filling have holes of their own.
    if (!c.parts.front().ring) continue;
    for (InputPart& part : c.parts) part.ring = false;
    for (const double lengths : {0.5, 5.0}) expect_sound(c, lengths, mean);
  }
}

}  // namespace
}  // namespace krepl::test
