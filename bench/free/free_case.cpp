// One measurement in one process; see main() for the arguments. Prints one JSON object. compare.py starts it with a time limit,
// chooses the cases and makes the table.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "../measure.hpp"
#include "../terrain/terrains.hpp"
#include "krepl/drop_cutter.hpp"
#include "krepl/free_components.hpp"
#include "krepl/free_space.hpp"
#include "ways.hpp"

namespace bench {
namespace {

using krepl::Point;
using krepl::Point3;

constexpr std::size_t told = 50;  // clearances that are printed, for comparison

/// Krepl's, in the plane or in space: one thread.
template <class Space, class Place>
class Krepl : public Way {
 public:
  Krepl(Space space, std::vector<Place> places) : space_(std::move(space)), places_(std::move(places)), contacts_(places_.size()) {}
  bool run(std::vector<double>& clearances) override {
    krepl::Context one;
    one.threads = 1;
    if (!space_.clearance(places_, contacts_, one)) return false;
    for (std::size_t i = 0; i < places_.size(); ++i) clearances[i] = contacts_[i].clearance;
    return true;
  }

 private:
  Space space_;
  std::vector<Place> places_;
  std::vector<typename Space::Contact> contacts_;
};

/// Components of free space; told as numbers.
class Components : public Way {
 public:
  Components(krepl::FreeComponents parts, std::vector<Point> places) : parts_(std::move(parts)), places_(std::move(places)) {}
  bool run(std::vector<double>& numbers) override {
    for (std::size_t i = 0; i < places_.size(); ++i) numbers[i] = double(parts_.at(places_[i]));
    return true;
  }

 private:
  krepl::FreeComponents parts_;
  std::vector<Point> places_;
};

class BrutePlane : public Way {
 public:
  BrutePlane(const Lines& lines, double radius, std::vector<Point> places)
      : lines_(lines), radius_(radius), places_(std::move(places)) {}
  bool run(std::vector<double>& clearances) override {
    for (std::size_t i = 0; i < places_.size(); ++i) clearances[i] = std::sqrt(square(places_[i])) - radius_;
    return true;
  }

 private:
  double square(Point p) const {
    double best = INFINITY;
    for (std::size_t l = 0; l < lines_.count(); ++l)
      for (std::size_t j = lines_.begin[l]; j + 1 < lines_.begin[l + 1]; ++j) {
        const Point a = lines_.points[j], b = lines_.points[j + 1];
        const double dx = b.x - a.x, dy = b.y - a.y, px = p.x - a.x, py = p.y - a.y;
        const double t = std::clamp((px * dx + py * dy) / (dx * dx + dy * dy), 0.0, 1.0);
        best = std::min(best, (px - t * dx) * (px - t * dx) + (py - t * dy) * (py - t * dy));
      }
    return best;
  }
  const Lines& lines_;
  double radius_;
  std::vector<Point> places_;
};

struct Vec {
  double x, y, z;
};
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vec nearest_on_segment(Vec a, Vec b) {
  const Vec d = b - a;
  const double whole = dot(d, d);
  return whole > 0 ? a + std::clamp(-dot(a, d) / whole, 0.0, 1.0) * d : a;
}

/// The point of a triangle nearest to the origin.
Vec nearest_on_triangle(const std::array<Vec, 3>& t) {
  const Vec u = t[1] - t[0], v = t[2] - t[0], n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const double nn = dot(n, n);
  if (nn > 0) {
    const Vec foot = (dot(t[0], n) / nn) * n, w = foot - t[0];
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v), whole = uu * vv - uv * uv;
    const double s = (wu * vv - wv * uv) / whole, r = (wv * uu - wu * uv) / whole;
    if (s >= 0 && r >= 0 && s + r <= 1) return foot;
  }
  Vec best{INFINITY, 0, 0};
  for (int k = 0; k < 3; ++k) {
    const Vec near = nearest_on_segment(t[std::size_t(k)], t[std::size_t((k + 1) % 3)]);
    if (dot(near, near) < dot(best, best)) best = near;
  }
  return best;
}

/// All triangles of a grid and what is below them.
class BruteTerrain : public Way {
 public:
  BruteTerrain(const Samples& samples, double radius, std::vector<Point3> places)
      : samples_(samples), radius_(radius), places_(std::move(places)) {}
  bool run(std::vector<double>& clearances) override {
    for (std::size_t i = 0; i < places_.size(); ++i) clearances[i] = std::sqrt(square(places_[i])) - radius_;
    return true;
  }

 private:
  double square(Point3 p) const {
    const auto& grid = samples_.grid;
    const auto at = [&](std::size_t c, std::size_t r) {
      return Vec{grid.first.x + double(c) * grid.cell_x - p.x, grid.first.y + double(r) * grid.cell_y - p.y,
                 samples_.at(c, r) - p.z};
    };
    double best = INFINITY;
    for (std::size_t r = 0; r + 1 < grid.rows; ++r)
      for (std::size_t c = 0; c + 1 < grid.columns; ++c) {
        const Vec sw = at(c, r), se = at(c + 1, r), nw = at(c, r + 1), ne = at(c + 1, r + 1);
        for (const auto& t : {std::array{sw, se, ne}, std::array{sw, ne, nw}}) {
          if (std::isnan(t[0].z + t[1].z + t[2].z)) continue;
          Vec near = nearest_on_triangle(t);
          if (near.z > 0)  // level with the place, on what hangs down from it
            near = nearest_on_triangle({Vec{t[0].x, t[0].y, 0}, Vec{t[1].x, t[1].y, 0}, Vec{t[2].x, t[2].y, 0}});
          best = std::min(best, dot(near, near));
        }
      }
    return best;
  }
  const Samples& samples_;
  double radius_;
  std::vector<Point3> places_;
};

/// Anywhere in the box of the lines.
std::vector<Point> plane_places(const Lines& lines, std::size_t count) {
  Point low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  for (const Point& p : lines.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> x(low.x, high.x), y(low.y, high.y);
  std::vector<Point> places;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = x(random);
    places.push_back({at, y(random)});
  }
  return places;
}

/// Anywhere over the terrain, up to two radii above where the ball rests.
std::vector<Point3> terrain_places(const krepl::DropCutter& cutter, const krepl::Terrain& terrain, double radius, std::size_t count) {
  const Point3 low = terrain.lowest(), high = terrain.highest(), origin = terrain.origin();
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> x(low.x, high.x), y(low.y, high.y), up(0, 2 * radius);
  std::vector<Point3> places;
  while (places.size() < count) {
    const double at = x(random) + origin.x, north = y(random) + origin.y;
    const auto contact = cutter.at({at, north});
    const double above = up(random);
    if (contact.touches()) places.push_back({at, north, contact.height + above});
  }
  return places;
}

/// The file's obstacles with places, and what is measured on them.
struct Case {
  std::optional<Lines> lines;
  Samples samples;
  std::size_t items = 0;
  double radius = 0;
  std::unique_ptr<Way> way;
};

bool set_plane(Case& c, const std::string& way, const std::string& path, double radius, std::size_t count) {
  c.lines = read_lines(path);
  if (!c.lines) return false;
  c.items = c.lines->segments(), c.radius = radius * mean_segment_length(*c.lines);
  std::vector<Point> places = plane_places(*c.lines, count);
  if (way == "brute") c.way = std::make_unique<BrutePlane>(*c.lines, c.radius, std::move(places));
#ifdef KREPL_BENCH_GEOS
  if (way == "geos") c.way = make_geos(*c.lines, c.radius, places);
#endif
  if (way != "krepl" && way != "components") return true;
  krepl::Network::Builder builder;
  for (std::size_t i = 0; i < c.lines->count(); ++i)
    builder.add_line(std::span(c.lines->points).subspan(c.lines->begin[i], c.lines->begin[i + 1] - c.lines->begin[i]), {});
  auto network = std::move(builder).build();
  if (!network) return false;
  const auto shared = std::make_shared<const krepl::Network>(std::move(*network));
  if (way == "components") {
    auto parts = krepl::FreeComponents::build(shared, c.radius);
    if (!parts) return false;
    c.way = std::make_unique<Components>(std::move(*parts), std::move(places));
    return true;
  }
  auto space = krepl::DiskFreeSpace::build(shared, c.radius);
  if (!space) return false;
  c.way = std::make_unique<Krepl<krepl::DiskFreeSpace, Point>>(std::move(*space), std::move(places));
  return true;
}

bool set_terrain(Case& c, const std::string& way, const std::string& path, double cell, double radius,
                 std::size_t count) {
  c.samples = path.starts_with("made:") ? made(std::strtoull(path.c_str() + 5, nullptr, 10)) : read_samples(path, cell);
  const auto terrain = c.samples.heights.empty() ? nullptr : as_grid(c.samples);
  if (!terrain) return false;
  c.items = terrain->triangle_count(), c.radius = radius * c.samples.cell();
  const auto cutter = krepl::DropCutter::build(terrain, c.radius);
  if (!cutter) return false;
  std::vector<Point3> places = terrain_places(*cutter, *terrain, c.radius, count);
  if (way == "brute") c.way = std::make_unique<BruteTerrain>(c.samples, c.radius, std::move(places));
  if (way != "krepl") return true;
  auto space = krepl::BallFreeSpace::build(terrain, c.radius);
  if (!space) return false;
  c.way = std::make_unique<Krepl<krepl::BallFreeSpace, Point3>>(std::move(*space), std::move(places));
  return true;
}

int run(const std::string& where, const std::string& way, const std::string& path, double cell, double radius, std::size_t count) {
  Case c;
  const bool read =
      where == "plane" ? set_plane(c, way, path, radius, count) : set_terrain(c, way, path, cell, radius, count);
  if (!read) return std::fprintf(stderr, "free_case: %s cannot be taken\n", path.c_str()), 1;
  if (!c.way) return std::fprintf(stderr, "free_case: this build has no %s\n", way.c_str()), 3;
  std::vector<double> clearances(count);
  const auto measured = measure([&] { return c.way->run(clearances); }, 1);
  if (!measured) return std::fprintf(stderr, "free_case: %s failed\n", way.c_str()), 1;
  std::size_t free = 0;
  for (const double clearance : clearances) free += clearance >= 0;
  std::printf("{\"items\": %zu, \"radius\": %.17g, \"places\": %zu, \"free\": %zu, \"cpu\": %.9g, \"runs\": %d, \"first\": [",
              c.items, c.radius, count, free, measured->cpu, measured->runs);
  for (std::size_t i = 0; i < std::min(told, count); ++i) std::printf("%s%.17g", i == 0 ? "" : ", ", clearances[i]);
  std::printf("]}\n");
  return 0;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fprintf(stderr,
                 "usage: free_case WHERE WAY FILE CELL RADIUS PLACES\n"
                 "  WHERE   plane or terrain\n"
                 "  WAY     krepl, brute; in the plane also geos, components\n"
                 "  FILE    lines as WKT; an ESRI ASCII grid, or made:TRIANGLES\n"
                 "  CELL    its size; 0 takes that of the file\n"
                 "  RADIUS  in mean segment lengths, or cells\n"
                 "  PLACES  how many placements\n");
    return 2;
  }
  return bench::run(argv[1], argv[2], argv[3], std::strtod(argv[4], nullptr), std::strtod(argv[5], nullptr),
                    std::strtoull(argv[6], nullptr, 10));
}
