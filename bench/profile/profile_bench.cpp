// Nanoseconds per segment of the profile engine, beside the time that moving the same bytes takes.
//
// Times are of a whole run; table.py divides. Names are profile/WAY/KIND/R:radius/n:segments. The storage is reused between
// runs and touched before the first, as in a program that computes many profiles. n = 1e8 (4.8 GB of pieces, 1.6 GB of
// points) only with KREPL_BENCH_LARGE=1.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "krepl/profile.hpp"
#include "terrains.hpp"

namespace krepl::bench {

namespace {

/// Storage for pieces, shared by all cases.
std::span<ProfilePiece> storage(std::size_t points) {
  static std::unique_ptr<ProfilePiece[]> pieces;
  static std::size_t size = 0;
  const std::size_t needed = profile_capacity(points);
  if (size < needed) {
    pieces.reset();
    pieces = std::make_unique_for_overwrite<ProfilePiece[]>(needed);
    size = needed;
    std::memset(static_cast<void*>(pieces.get()), 0, needed * sizeof(ProfilePiece));
  }
  return {pieces.get(), needed};
}

void report(benchmark::State& state, std::size_t segments, std::size_t pieces, const ProfileCounters* counters) {
  state.counters["pieces_per_segment"] = double(pieces) / double(segments);
  if (counters == nullptr) return;
  state.counters["pops_per_segment"] = double(counters->pops) / double(segments);
  state.counters["higher_precision"] = double(counters->in_double_double) / double(segments);
  state.counters["stack"] = double(counters->largest_stack);
}

void run(benchmark::State& state, Kind kind, double radius, std::size_t segments, unsigned threads) {
  const std::vector<Point>& points = terrain(kind, segments);
  const std::span<ProfilePiece> out = storage(points.size());
  ProfileEngine engine;
  Context context;
  context.threads = threads;
  std::size_t count = 0;
  for (auto _ : state) {
    const auto result = engine.compute(points, radius, out, context);
    if (!result) return state.SkipWithError(result.error().text().c_str());
    count = *result;
    benchmark::ClobberMemory();
  }
  report(state, segments, count, &engine.counters());
}

void run_stream(benchmark::State& state, Kind kind, double radius, std::size_t segments) {
  const std::vector<Point>& points = terrain(kind, segments);
  std::size_t count = 0;
  ProfileCounters counters;
  for (auto _ : state) {
    count = 0;
    auto stream = ProfileStream::open(radius, [&](std::span<const ProfileRow> rows) {
      benchmark::DoNotOptimize(rows.data());
      count += rows.size();
    });
    if (!stream || !stream->push(points) || !stream->finish()) return state.SkipWithError("the stream failed");
    counters = stream->counters();
  }
  report(state, segments, count, &counters);
}

/// The bound: reading the points once and writing as many bytes as the pieces have.
void move_bytes(benchmark::State& state, Kind kind, double radius, std::size_t segments) {
  const std::vector<Point>& points = terrain(kind, segments);
  const std::span<ProfilePiece> out = storage(points.size());
  ProfileEngine engine;
  const auto result = engine.compute(points, radius, out);
  if (!result) return state.SkipWithError(result.error().text().c_str());
  // Both by memcpy: the points into a buffer in the cache, the pieces out of one.
  std::vector<char> near(std::size_t{1} << 14);
  const auto* from = reinterpret_cast<const char*>(points.data());
  auto* to = reinterpret_cast<char*>(out.data());
  const std::size_t read = points.size() * sizeof(Point), written = *result * sizeof(ProfilePiece);
  for (auto _ : state) {
    for (std::size_t i = 0, j = 0; i < read || j < written;) {
      const std::size_t r = std::min(near.size(), read - i), w = std::min(near.size(), written - j);
      std::memcpy(near.data(), from + i, r), i += r;
      benchmark::ClobberMemory();
      std::memcpy(to + j, near.data(), w), j += w;
      benchmark::ClobberMemory();
    }
  }
  report(state, segments, *result, nullptr);
}

void add(Kind kind, double radius, std::size_t segments, bool all_ways) {
  const auto label = [&](const char* way) {
    char text[100];
    std::snprintf(text, sizeof text, "profile/%s/%s/R:%g/n:%g", way, name(kind), radius, double(segments));
    return std::string(text);
  };
  const auto add_one = [&](const char* way, auto work) {
    benchmark::RegisterBenchmark(label(way).c_str(), work)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->MeasureProcessCPUTime();
  };
  add_one("one", [=](benchmark::State& s) { run(s, kind, radius, segments, 1); });
  if (!all_ways) return;
  add_one("all", [=](benchmark::State& s) { run(s, kind, radius, segments, 0); });
  add_one("stream", [=](benchmark::State& s) { run_stream(s, kind, radius, segments); });
  add_one("bytes", [=](benchmark::State& s) { move_bytes(s, kind, radius, segments); });
}

}  // namespace

}  // namespace krepl::bench

int main(int argc, char** argv) {
  using namespace krepl::bench;
  for (const std::size_t n : {10'000, 100'000, 1'000'000, 10'000'000}) add(Kind::rough, 10, n, true);
  for (const double radius : {1.0, 10.0, 100.0})
    for (const Kind kind : all_kinds) add(kind, radius, 1'000'000, false);
  for (const double radius : {1.0, 100.0, 10'000.0}) add(Kind::rough, radius, 10'000'000, true);
  const char* large = std::getenv("KREPL_BENCH_LARGE");
  if (large != nullptr && *large == '1') add(Kind::rough, 10, 100'000'000, true);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
