// One segment Voronoi diagram in one process; see main() for the arguments.
// Prints one JSON object. compare.py starts it with a time limit, chooses the cases and makes the table.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "../measure.hpp"
#include "../zone/lines.hpp"
#include "diagrams.hpp"

namespace bench {
namespace {

using krepl::Point;

/// Bundles of x-monotone meanders that do not cross, on integers: Boost.Polygon takes nothing else.
Polylines meanders(std::size_t segments) {
  std::mt19937_64 random(20060401);
  std::uniform_real_distribution<double> unit(-1, 1);
  const std::size_t count = std::size_t(std::sqrt(double(segments)) / 4) + 1, each = segments / count;
  Polylines lines(count);
  for (std::size_t i = 0; i < count; ++i) {
    double level = 0, slope = 0;
    for (std::size_t k = 0; k <= each; ++k) {
      slope = 0.9 * slope + 60 * unit(random);
      level = 0.98 * level + slope;
      lines[i].push_back({std::round(1000 * (double(k) + 0.3 * unit(random))),
                          std::round(16000 * double(i) + std::clamp(level, -7900.0, 7900.0))});
    }
  }
  return lines;
}

/// A street grid, cut where streets meet: every crossing ties with three others.
Polylines grid(std::size_t segments) {
  const int blocks = int(std::sqrt(double(segments) / 2));
  Polylines lines;
  for (int i = 0; i <= blocks; ++i) {
    auto& east = lines.emplace_back();
    for (int k = 0; k <= blocks; ++k) east.push_back({100.0 * k, 100.0 * i});
    auto& north = lines.emplace_back();
    for (int k = 0; k <= blocks; ++k) north.push_back({100.0 * i, 100.0 * k});
  }
  return lines;
}

/// Outlines of random pixels, half of all.
Polylines pixels(std::size_t segments) {
  const int side = int(std::sqrt(double(segments)));
  std::mt19937_64 random(1);
  std::vector<char> full(std::size_t(side + 2) * std::size_t(side + 2));
  const auto at = [&](int i, int k) -> char& { return full[std::size_t(i) * std::size_t(side + 2) + std::size_t(k)]; };
  for (int i = 1; i <= side; ++i)
    for (int k = 1; k <= side; ++k) at(i, k) = random() % 2 != 0;
  Polylines lines;
  for (int i = 0; i <= side; ++i) {
    for (int k = 0; k <= side; ++k) {
      const double x = k, y = i;
      if (at(i, k) != at(i + 1, k)) lines.push_back({{x, y}, {x + 1, y}});
      if (at(i, k) != at(i, k + 1)) lines.push_back({{x, y}, {x, y + 1}});
    }
  }
  return lines;
}

Polylines lines_of(const std::string& data, std::size_t segments) {
  if (data == "meanders") return meanders(segments);
  if (data == "grid") return grid(segments);
  if (data == "pixels") return pixels(segments);
  const auto read = read_lines(data);
  if (!read || read->segments() == 0) return {};
  const Lines lines = segments > 0 ? resized(*read, segments) : *read;
  Polylines all;
  for (std::size_t i = 0; i < lines.count(); ++i)
    all.emplace_back(lines.points.begin() + std::ptrdiff_t(lines.begin[i]),
                     lines.points.begin() + std::ptrdiff_t(lines.begin[i + 1]));
  return all;
}

std::unique_ptr<Builder> make(const std::string& name, const Polylines& lines) {
  if (name == "krepl") return make_krepl(lines);
  if (name == "boost") return make_boost(lines);
#ifdef KREPL_BENCH_CGAL
  if (name == "cgal") return make_cgal(lines);
#endif
  return nullptr;
}

int run(const std::string& name, const std::string& data, std::size_t wanted) {
  const Polylines lines = lines_of(data, wanted);
  std::size_t segments = 0;
  for (const auto& line : lines) segments += line.size() - 1;
  if (segments == 0) return std::fprintf(stderr, "voronoi_case: no lines in %s\n", data.c_str()), 1;
  const auto builder = make(name, lines);
  if (!builder) return std::fprintf(stderr, "voronoi_case: this build has no engine %s\n", name.c_str()), 3;
  const auto measured = measure([&] { return builder->run(); }, 1);
  if (!measured) return 1;
  std::printf("{\"segments\": %zu, \"cpu\": %.9g, \"runs\": %d, \"bytes\": %.0f%s}\n", segments, measured->cpu,
              measured->runs, measured->bytes, builder->more().c_str());
  return 0;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: voronoi_case ENGINE DATA SEGMENTS\n"
                         "  ENGINE    krepl, boost or cgal\n"
                         "  DATA      meanders, grid, pixels, or a file of lines\n"
                         "  SEGMENTS  about that many; 0 takes a file as it is\n");
    return 2;
  }
  return bench::run(argv[1], argv[2], std::strtoull(argv[3], nullptr, 10));
}
