#include "terrain_case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace krepl::test {

namespace {

using Record = input::ProfileRecord;

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same_bits(Point a, Point b) { return same_bits(a.x, b.x) && same_bits(a.y, b.y); }

std::string piece_text(const ProfilePiece& p) {
  char line[120];
  std::snprintf(line, sizeof line, "%d %u at %.17g %.17g", int(p.kind), p.index, p.start.x, p.start.y);
  return line;
}

std::optional<std::string> compare(std::span<const ProfilePiece> a, std::span<const ProfilePiece> b, const std::string& what) {
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    if (a[k].kind != b[k].kind || a[k].index != b[k].index || !same_bits(a[k].start, b[k].start))
      return what + ": piece " + std::to_string(k) + " is " + piece_text(b[k]) + ", not " + piece_text(a[k]);
  if (a.size() != b.size()) return what + ": " + std::to_string(b.size()) + " pieces, not " + std::to_string(a.size());
  return std::nullopt;
}

std::optional<std::string> compare_stream(const Profile& truth, std::size_t portion) {
  std::vector<ProfileRow> rows;
  auto stream = ProfileStream::open(
      truth.radius, [&](std::span<const ProfileRow> r) { rows.insert(rows.end(), r.begin(), r.end()); });
  if (!stream) return stream.error().text();
  for (std::size_t i = 0; i < truth.terrain.size(); i += portion) {
    const std::size_t count = std::min(portion, truth.terrain.size() - i);
    if (Status s = stream->push(std::span(truth.terrain).subspan(i, count)); !s) return s.error().text();
  }
  if (Status s = stream->finish(); !s) return s.error().text();
  const std::string what = "stream in portions of " + std::to_string(portion);
  for (std::size_t k = 0; k < std::min(rows.size(), truth.pieces.size()); ++k) {
    const ProfileRow row = truth.row(k);
    const bool arc = row.kind == ProfilePiece::Kind::arc;
    if (row.kind != rows[k].kind || row.index != rows[k].index || !same_bits(row.start, rows[k].start) ||
        !same_bits(row.end, rows[k].end) || (arc && !same_bits(row.center, rows[k].center)))
      return what + ": row " + std::to_string(k) + " differs";
  }
  if (rows.size() != truth.pieces.size()) return what + ": " + std::to_string(rows.size()) + " rows";
  return std::nullopt;
}

// Families. Steps are about 1; y about as large, unless the family is about something else.
using Random = std::mt19937_64;
double real(Random& r, double low, double high) { return std::uniform_real_distribution<double>(low, high)(r); }
int whole(Random& r, int low, int high) { return std::uniform_int_distribution<int>(low, high)(r); }

template <class F>
Terrain build(std::size_t points, F&& step) {
  Terrain t;
  Point p{0, 0};
  for (std::size_t i = 0; i < points; ++i) {
    t.push_back(p);
    step(p, i);
  }
  return t;
}

Terrain rough(Random& r, std::size_t n) {
  return build(n, [&](Point& p, std::size_t) { p = {p.x + real(r, 0.01, 2), real(r, -1, 1)}; });
}
Terrain walk(Random& r, std::size_t n) {
  return build(n, [&](Point& p, std::size_t) { p = {p.x + real(r, 0, 2), p.y + real(r, -1, 1)}; });
}
Terrain spiky(Random& r, std::size_t n) {
  return build(n, [&](Point& p, std::size_t) {
    p = {p.x + std::pow(10, real(r, -12, 1)), real(r, -1, 1) * std::pow(10, real(r, -3, 2))};
  });
}
Terrain lattice(Random& r, std::size_t n) {
  return build(n, [&](Point& p, std::size_t) { p = {p.x + 1, p.y + whole(r, -1, 1)}; });
}
Terrain lattice_with_cliffs(Random& r, std::size_t n) {
  return build(n, [&](Point& p, std::size_t) { p = {p.x + whole(r, 0, 2), double(whole(r, -3, 3))}; });
}
Terrain walls(Random& r, std::size_t n) {
  return build(n, [&](Point& p, std::size_t) {
    if (whole(r, 0, 2) == 0) p.x += whole(r, 1, 4);
    else p.y = whole(r, 0, 8);
  });
}
Terrain plateaus(Random& r, std::size_t n) {
  return build(n, [&](Point& p, std::size_t) {
    p.x += whole(r, 0, 3);
    if (whole(r, 0, 4) == 0) p.y = whole(r, -2, 2);
  });
}
Terrain smooth(Random& r, std::size_t n) {
  const double a = real(r, 0, 10), f = real(r, 0.001, 0.3), g = real(r, 0.001, 0.3);
  return build(n, [&](Point& p, std::size_t i) {
    p = {double(i + 1), a * std::sin(f * double(i + 1)) + a * std::cos(g * double(i + 1))};
  });
}
Terrain convex(Random& r, std::size_t n) {
  const double size = real(r, 0.1, 100);
  return build(n, [&](Point& p, std::size_t i) {
    const double x = (double(i + 1) / double(n) - 0.5) * 2 * size;
    p = {x + size, -x * x / size};
  });
}
Terrain concave(Random& r, std::size_t n) {
  Terrain t = convex(r, n);
  for (Point& p : t) p.y = -p.y;
  return t;
}
Terrain grooves(Random& r, std::size_t n) {
  const double depth = real(r, 0.1, 30);
  return build(n, [&](Point& p, std::size_t i) { p = {double(i / 2 + i % 2), i % 2 == 0 ? -depth : real(r, 0, 1e-9)}; });
}
/// Points on circles of radius 1 and 5, so that a disk of that radius touches many at once.
Terrain circles(Random& r, std::size_t n) {
  const double size = whole(r, 0, 1) == 0 ? 1 : 5;
  return build(n, [&](Point& p, std::size_t i) {
    const double a = std::acos(-1.0) * (1 - double(i % 16) / 16);
    p = {2 * size * double(i / 16) + size + size * std::cos(a), -size * std::sin(a)};
  });
}
Terrain far_away(Random& r, std::size_t n) {
  return moved(walk(r, n), 653251.25 + whole(r, 0, 3) * 1e6, 5.2e6);
}
Terrain repeated(Random& r, std::size_t n) {
  Terrain t = lattice_with_cliffs(r, n);
  for (std::size_t i = 1; i < t.size(); ++i)
    if (whole(r, 0, 1) == 0) t[i] = t[i - 1];
  return t;
}

constexpr Family all_families[] = {
    {"rough", rough},       {"walk", walk},         {"spiky", spiky},     {"lattice", lattice}, {"cliffs", lattice_with_cliffs},
    {"walls", walls},       {"plateaus", plateaus}, {"smooth", smooth},   {"convex", convex},   {"concave", concave},
    {"grooves", grooves},   {"circles", circles},   {"far away", far_away}, {"repeated", repeated}};

}  // namespace

std::span<const Family> families() { return all_families; }

std::vector<Record> records_of(const Profile& profile) {
  std::vector<Record> records;
  for (std::size_t k = 0; k < profile.pieces.size(); ++k) {
    const ProfileRow row = profile.row(k);
    records.push_back({Record::Kind(int(row.kind)), row.start, row.end, row.center,
                       row.kind == ProfilePiece::Kind::segment, row.index, k + 2});
  }
  return records;
}

Profile profile_of(Terrain terrain, double radius) {
  Context one_thread;
  one_thread.threads = 1;
  Result<Profile> result = compute_profile(std::move(terrain), radius, one_thread);
  if (result) return std::move(*result);
  ADD_FAILURE() << result.error().text();
  return {};
}

std::optional<std::string> fault_in(const Terrain& terrain, double radius, double allowed) {
  const Profile profile = profile_of(terrain, radius);
  if (profile.pieces.empty()) return "no result";
  verify::ProfileCheckOptions options;
  options.radius = radius;
  const auto records = records_of(profile);
  const auto report = verify::check_profile(terrain, records, options);
  if (!report) return report.error().text();
  // Rounding of the coordinates themselves cannot be undercut.
  double size = radius;
  for (const Point& p : terrain) size = std::max({size, std::fabs(p.x) + radius, std::fabs(p.y) + radius});
  const double limit = std::max(allowed * report->scale, 16 * 0x1p-53 * size);
  for (const verify::Check& check : report->checks) {
    if (check.ok() && !(check.worst > limit)) continue;
    char place[120];
    std::snprintf(place, sizeof place, " (worst %.3g, S %.3g) near %.17g %.17g", check.worst, report->scale,
                  check.where.x, check.where.y);
    return check.name + ": " + check.note + place;
  }
  const ProfileVertexCounts counts = count_profile_vertices(terrain, profile.pieces);
  if (counts.explicit_ones != report->explicit_vertices)
    return "explicit vertices: " + std::to_string(counts.explicit_ones) + ", verifier " +
           std::to_string(report->explicit_vertices);
  return std::nullopt;
}

std::optional<std::string> difference_in(const Terrain& terrain, double radius, std::span<const std::size_t> sizes,
                                         unsigned threads) {
  const Profile truth = profile_of(terrain, radius);
  ProfileEngine engine;
  std::vector<ProfilePiece> pieces(profile_capacity(terrain.size()));
  Context context;
  context.threads = threads;
  for (const std::size_t size : sizes) {
    engine.set_block_size(size);
    context.threads = size == sizes.back() ? threads : 1;  // on many tiny blocks threads only wait for each other
    const auto count = engine.compute(terrain, radius, pieces, context);
    const std::string what = "blocks of " + std::to_string(size) + ", " + std::to_string(context.threads) + " threads";
    if (!count) return what + ": " + count.error().text();
    if (auto d = compare(truth.pieces, std::span(pieces).first(*count), what)) return d;
    if (auto d = compare_stream(truth, size)) return d;
  }
  return std::nullopt;
}

std::string text(const Terrain& terrain, double radius) {
  std::string result;
  char line[100];
  std::snprintf(line, sizeof line, "radius %.17g\n", radius);
  result = line;
  for (const Point& p : terrain) {
    std::snprintf(line, sizeof line, "{%.17g, %.17g}, ", p.x, p.y);
    result += line;
  }
  return result;
}

double any_radius(std::mt19937_64& random, const Terrain& terrain) {
  const double width = terrain.back().x - terrain.front().x;
  const double mean = width > 0 ? width / double(terrain.size()) : 1;
  switch (whole(random, 0, 3)) {
    case 0: return whole(random, 1, 8);            // ties on lattices
    case 1: return std::pow(2, whole(random, -4, 6));
    default: return mean * std::pow(10, real(random, -6, 6));
  }
}

Terrain mirrored(Terrain terrain) {
  std::reverse(terrain.begin(), terrain.end());
  for (Point& p : terrain) p.x = -p.x;
  return terrain;
}
Terrain moved(Terrain terrain, double dx, double dy) {
  for (Point& p : terrain) p.x += dx, p.y += dy;
  return terrain;
}
Terrain scaled(Terrain terrain, double factor) {
  for (Point& p : terrain) p.x *= factor, p.y *= factor;
  return terrain;
}

}  // namespace krepl::test
