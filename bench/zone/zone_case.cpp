// One measurement in one process; see main() for the arguments.
// Prints one JSON object. compare.py starts it with a time limit, chooses the cases and makes the table.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "../measure.hpp"
#include "engines.hpp"

namespace bench {

int chords_of_circle(double radius, double chord_error) {
  return int(std::ceil(std::numbers::pi / std::acos(1 - chord_error / radius)));
}

namespace {

std::unique_ptr<Engine> make(const std::string& name, const Task& task) {
  if (name == "krepl") return make_krepl(task);
#ifdef KREPL_BENCH_GEOS
  if (name == "geos") return make_geos(task);
#endif
#ifdef KREPL_BENCH_CLIPPER
  if (name == "clipper") return make_clipper(task);
#endif
  if (name == "boost") return make_boost(task);
  return nullptr;
}

int run(const std::string& name, const std::string& path, std::size_t segments, double radius, double chord,
        unsigned threads, int least_runs) {
  auto lines = read_lines(path);
  if (!lines || lines->segments() == 0) return std::fprintf(stderr, "zone_case: cannot read %s\n", path.c_str()), 1;
  if (segments > 0) lines = resized(*lines, segments);
  const double length = mean_segment_length(*lines);
  const Task task{*lines, radius * length, chord * radius * length, threads};
  const auto engine = make(name, task);
  if (!engine) return std::fprintf(stderr, "zone_case: this build has no engine %s\n", name.c_str()), 3;
  const auto measured = measure([&] { return engine->run(); }, least_runs);
  if (!measured) return std::fprintf(stderr, "zone_case: %s failed\n", name.c_str()), 1;
  const Outcome outcome = engine->outcome();
  std::printf("{\"segments\": %zu, \"vertices\": %zu, \"radius\": %.17g, \"mean_length\": %.17g, \"cpu\": %.9g, "
              "\"wall\": %.9g, \"runs\": %d, \"bytes\": %.0f, \"out_vertices\": %zu, \"holes\": %zu, \"area\": %.17g}\n",
              lines->segments(), lines->points.size(), task.radius, length, measured->cpu, measured->wall,
              measured->runs, measured->bytes, outcome.vertices, outcome.holes, outcome.area);
  return 0;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  if (argc != 7 && argc != 8) {
    std::fprintf(stderr, "usage: zone_case ENGINE FILE SEGMENTS RADIUS CHORD THREADS [RUNS]\n"
                         "  ENGINE    krepl, geos, clipper or boost\n"
                         "  SEGMENTS  cut or repeat the file to that many; 0 takes it as it is\n"
                         "  RADIUS    in mean segment lengths\n"
                         "  CHORD     largest distance of a chord from its arc, in radii\n"
                         "  RUNS      least number of runs (default: 1)\n");
    return 2;
  }
  return bench::run(argv[1], argv[2], std::strtoull(argv[3], nullptr, 10), std::strtod(argv[4], nullptr),
                    std::strtod(argv[5], nullptr), unsigned(std::strtoul(argv[6], nullptr, 10)),
                    argc > 7 ? std::max(1, std::atoi(argv[7])) : 1);
}
