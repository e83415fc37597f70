// One measurement in one process; see main() for the arguments.
// Prints one JSON object. compare.py starts it with a time limit, chooses the cases and makes the tables.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "../measure.hpp"
#include "operations.hpp"

namespace bench {
namespace {

Samples load(const std::string& terrain, double cell) {
  if (terrain.starts_with("made:")) return made(std::strtoull(terrain.c_str() + 5, nullptr, 10));
  return read_samples(terrain, cell);
}

std::unique_ptr<Operation> make(const std::string& name, const Task& task) {
  if (name == "surface") return make_surface(task);
  if (name == "dilation") return make_dilation(task);
#ifdef KREPL_BENCH_OPENVDB
  if (name == "openvdb") return make_openvdb(task);
#endif
  return make_drop(task, name);
}

int run(const std::string& name, const std::string& path, const std::string& form, double cell, double radius,
        double step, unsigned threads, int least_runs) {
  const Samples samples = load(path, cell);
  if (samples.heights.empty()) return std::fprintf(stderr, "terrain_case: cannot read %s\n", path.c_str()), 1;
  const auto terrain = form == "mesh" ? as_mesh(samples) : as_grid(samples);
  if (!terrain) return std::fprintf(stderr, "terrain_case: %s is no terrain\n", path.c_str()), 1;
  const double unit = samples.cell();
  const Task task{samples, terrain, radius * unit, step * radius * unit, threads};
  const auto operation = make(name, task);
  if (!operation) return std::fprintf(stderr, "terrain_case: this build has no %s\n", name.c_str()), 3;
  const auto measured = measure([&] { return operation->run(); }, least_runs);
  if (!measured) return std::fprintf(stderr, "terrain_case: %s failed\n", name.c_str()), 1;
  std::printf(
      "{\"triangles\": %zu, \"radius\": %.17g, \"cpu\": %.9g, \"wall\": %.9g, \"runs\": %d, \"bytes\": %.0f%s}\n",
      terrain->triangle_count(), task.radius, measured->cpu, measured->wall, measured->runs, measured->bytes,
      operation->facts().c_str());
  return 0;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  if (argc != 9) {
    std::fprintf(stderr,
                 "usage: terrain_case OPERATION TERRAIN FORM CELL RADIUS STEP THREADS RUNS\n"
                 "  OPERATION surface; build, cells, quarters, list or single (drop cutter); openvdb or dilation\n"
                 "  TERRAIN   an ESRI ASCII grid, or made:TRIANGLES\n"
                 "  FORM      grid or mesh\n"
                 "  CELL      its size; 0 takes that of the file\n"
                 "  RADIUS    in cells\n"
                 "  STEP      distance of a peer's samples, in radii\n"
                 "  THREADS   0 for all\n"
                 "  RUNS      least number of runs\n");
    return 2;
  }
  const auto number = [&](int i) { return std::strtod(argv[i], nullptr); };
  return bench::run(argv[1], argv[2], argv[3], number(4), number(5), number(6), unsigned(number(7)),
                    std::max(1, int(number(8))));
}
