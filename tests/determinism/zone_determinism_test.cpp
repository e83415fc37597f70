// The same input gives the same bits with any number of threads: compared as hexadecimal dumps of everything a zone
// holds.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "support/environment.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {
namespace {

std::string dump(const Zone& zone) {
  std::string out;
  char buffer[300];
  for (std::uint32_t r = 0; r < zone.ring_count(); ++r) {
    std::snprintf(buffer, sizeof buffer, "ring %u hole %d\n", zone.ring_begin(r), int(zone.ring_is_hole(r)));
    out += buffer;
  }
  for (std::uint32_t p = 0; p < zone.polygon_count(); ++p) {
    out += "polygon " + std::to_string(zone.polygon(p).outer);
    for (const auto h : zone.polygon(p).holes) out += " " + std::to_string(h);
    out += "\n";
  }
  for (std::uint32_t e = 0; e < zone.piece_count(); ++e) {
    const Zone::Piece piece = zone.piece(e);
    std::snprintf(buffer, sizeof buffer, "%d %a %a %a %a %a %a %u %d\n", int(piece.kind), piece.start.x, piece.start.y,
                  piece.end.x, piece.end.y, piece.center.x, piece.center.y, piece.source, int(piece.reversed));
    out += buffer;
  }
  const Subdivision& s = zone.subdivision();
  for (std::size_t h = 0; h < s.half_edge_count(); ++h)
    out += std::to_string(s.origin[h]) + " " + std::to_string(s.next[h]) + " " + std::to_string(s.face[h]) + "\n";
  for (const auto f : s.face_outer) out += std::to_string(f) + " ";
  for (const auto f : s.face_inner) out += std::to_string(f) + " ";
  std::snprintf(buffer, sizeof buffer, "area %a perimeter %a\n", zone.area(), zone.perimeter());
  return out + buffer;
}

void expect_same_bits(const ZoneCase& c, const char* what) {
  // Otherwise oneTBB starts no more threads than the machine has cores, whatever is asked for.
  const tbb::global_control eight(tbb::global_control::max_allowed_parallelism, 8);
  std::string first;
  for (const unsigned threads : {1u, 2u, 3u, 8u, 1u}) {
    Context context;
    context.threads = threads;
    const auto zone = zone_of(c, context);
    ASSERT_TRUE(zone.ok()) << what << ": " << zone.error().text();
    const std::string now = dump(*zone);
    if (first.empty())
      first = now;
    else
      ASSERT_TRUE(now == first) << what << " differs with " << threads << " threads";
  }
}

/// A river-like tangle large enough for many blocks of work.
ZoneCase tangle(std::size_t vertices, double radius, std::uint64_t number) {
  std::mt19937_64 random(number);
  const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  ZoneCase c{{}, radius};
  for (std::size_t made = 0; made < vertices;) {
    std::vector<Point> v{{400 * unit(), 400 * unit()}};
    double heading = 6.28 * unit();
    for (int k = 0, n = 5 + int(random() % 200); k < n; ++k) {
      heading += unit() - 0.5;
      v.push_back({v.back().x + std::cos(heading), v.back().y + std::sin(heading)});
    }
    made += v.size();
    c.parts.push_back(line(std::move(v)));
  }
  return c;
}

TEST(Determinism, Tangles) {
  const auto vertices = std::size_t(150'000 * std::min(1.0, effort()));  // with sanitizers still several blocks
  for (const double radius : {0.2, 1.0, 10.0}) expect_same_bits(tangle(vertices, radius, seed()), "tangle");
}

TEST(Determinism, StreetsWithTies) {
  for (const double radius : {5.0, 4.9, 5.1}) {
    ZoneCase c{{}, radius};
    for (int k = 0; k <= 200; ++k) {
      c.parts.push_back(line({{0, 10.0 * k}, {2000, 10.0 * k}}));
      c.parts.push_back(line({{10.0 * k, 0}, {10.0 * k, 2000}}));
    }
    expect_same_bits(c, "streets");
  }
}

TEST(Determinism, EveryFamily) {
  std::mt19937_64 random(seed());
  for (int f = 0; f < int(Family::count); ++f)
    for (int k = 0; k < 20; ++k) {
      std::vector<std::uint8_t> bytes(80);
      for (auto& b : bytes) b = std::uint8_t(random());
      const ZoneCase c = decode(Family(f), bytes);
      expect_same_bits(c, text(c).c_str());
    }
}

}  // namespace
}  // namespace krepl::test
