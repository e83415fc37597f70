// One way to take a river network apart, in one process; see main() for the arguments.
// Prints one JSON object. compare.py starts it with a time limit, chooses the cases and makes the table.
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "../measure.hpp"
#include "../zone/lines.hpp"
#include "krepl/river.hpp"
#include "krepl/zone.hpp"
#ifdef KREPL_BENCH_GEOS
#include "peer_geos.hpp"
#endif

namespace bench {
namespace {

constexpr int fails = 1, not_built = 3;

int complain(const krepl::Error& error) {
  std::fprintf(stderr, "river_case: %s\n", error.text().c_str());
  return fails;
}

std::optional<krepl::Network> network_of(const Lines& lines, const krepl::Context& context) {
  krepl::Network::Builder builder;
  for (std::size_t i = 0; i < lines.count(); ++i) {
    builder.add_line({lines.points.data() + lines.begin[i], lines.begin[i + 1] - lines.begin[i]}, std::int64_t(i));
  }
  auto network = std::move(builder).build(context);
  if (!network) return complain(network.error()), std::nullopt;
  return std::move(*network);
}

/// CPU seconds for the zone of every sub-river on its own, at one mean segment length.
std::optional<double> zones_of_parts(const krepl::RiverNetwork& rivers, double radius, const krepl::Context& context) {
  const double start = cpu_seconds();
  for (krepl::RiverNetwork::Index i = 0; i < rivers.sub_rivers().size(); ++i) {
    auto part = rivers.network({&i, 1}, context);
    if (!part) return complain(part.error()), std::nullopt;
    const auto zone = krepl::compute_zone(std::make_shared<const krepl::Network>(std::move(*part)), {radius}, context);
    if (!zone) return complain(zone.error()), std::nullopt;
  }
  return cpu_seconds() - start;
}

/// Cleaning and indexing the lines is part of the operation. Water runs to outlets, guessed where none is known: nothing is
/// assumed about the lines.
int run_krepl(const Lines& lines) {
  krepl::Context context;
  context.threads = 1;
  std::optional<krepl::RiverNetwork> rivers;
  const auto measured = measure(
      [&] {
        rivers.reset();
        const auto network = network_of(lines, context);
        if (!network) return false;
        krepl::RiverOptions options;
        options.flow = krepl::RiverOptions::Flow::outlet;
        auto built = krepl::RiverNetwork::build(*network, options, context);
        if (!built) return complain(built.error()), false;
        rivers.emplace(std::move(*built));
        return true;
      },
      1);
  if (!measured) return fails;
  const auto zones = zones_of_parts(*rivers, mean_segment_length(lines), context);
  if (!zones) return fails;
  const krepl::RiverReport& report = rivers->report();
  std::printf("{\"segments\": %zu, \"cpu\": %.9g, \"runs\": %d, \"bytes\": %.0f, \"reaches\": %zu, \"sub_rivers\": %zu, "
              "\"crossings\": %zu, \"zones\": %.9g}\n",
              lines.segments(), measured->cpu, measured->runs, measured->bytes, rivers->reaches().size(),
              rivers->sub_rivers().size(), report.crossings + report.touches, *zones);
  return 0;
}

int run_geos([[maybe_unused]] const Lines& lines) {
#ifdef KREPL_BENCH_GEOS
  const auto reaches = reaches_by_geos(lines);
  if (!reaches) return fails;
  std::printf("{\"segments\": %zu, \"cpu\": %.9g, \"runs\": %d, \"bytes\": %.0f, \"reaches\": %zu}\n", lines.segments(),
              reaches->measured.cpu, reaches->measured.runs, reaches->measured.bytes, reaches->count);
  return 0;
#else
  return not_built;
#endif
}

int run(const std::string& engine, const std::string& path, std::size_t wanted) {
  const auto read = read_lines(path);
  if (!read || read->segments() == 0) return std::fprintf(stderr, "river_case: no lines in %s\n", path.c_str()), fails;
  const Lines lines = wanted > 0 ? resized(*read, wanted) : *read;
  if (engine == "krepl") return run_krepl(lines);
  if (engine == "geos") return run_geos(lines);
  return std::fprintf(stderr, "river_case: no engine %s\n", engine.c_str()), not_built;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: river_case ENGINE FILE SEGMENTS\n"
                         "  ENGINE    krepl or geos\n"
                         "  FILE      a file of lines\n"
                         "  SEGMENTS  that many; 0 takes the file as it is\n");
    return 2;
  }
  return bench::run(argv[1], argv[2], std::strtoull(argv[3], nullptr, 10));
}
