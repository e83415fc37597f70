// What a user of the installed package writes: the zone of one segment has area 2 R L + pi R^2.
#include <cmath>
#include <cstdio>
#include <krepl/network.hpp>
#include <krepl/zone.hpp>
#include <memory>
#include <numbers>
#include <utility>

int main() {
  const krepl::Point line[] = {{0, 0}, {3, 4}};
  krepl::Network::Builder builder;
  builder.add_line(line);
  auto network = std::move(builder).build();
  if (!network) return 2;
  const auto zone = krepl::compute_zone(std::make_shared<const krepl::Network>(std::move(*network)), {.radius = 2});
  if (!zone) return 3;
  const double expected = 2 * 2 * 5 + std::numbers::pi * 4;
  std::printf("area %.9f, expected %.9f, pieces %zu\n", zone->area(), expected, zone->piece_count());
  return std::abs(zone->area() - expected) < 1e-9 * expected && zone->piece_count() == 4 && !zone->validate() ? 0 : 1;
}
