#pragma once

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <optional>
#include <string>

namespace bench {

inline double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// A field of /proc/self/status in bytes.
inline double memory(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(field + ":")) return 1024 * std::strtod(line.c_str() + field.size() + 1, nullptr);
  return 0;
}

struct Measured {
  double cpu = INFINITY, wall = INFINITY;  ///< of the fastest run
  double bytes = 0;                        ///< peak above what was in memory before the first run
  int runs = 0;
};

/// The fastest of up to five runs within about ten seconds, but of `least` at least; memory is that of the first run.
/// Nothing if run() fails.
template <class Run>
std::optional<Measured> measure(Run&& run, int least) {
  malloc_trim(0);  // what reading the file freed would hide the operation's first allocations
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak so far (reading the file) does not count
  const double before = memory("VmRSS");
  Measured measured;
  for (double spent = 0; measured.runs < least || (measured.runs < 5 && spent < 10);) {
    const auto wall_start = std::chrono::steady_clock::now();
    const double cpu_start = cpu_seconds();
    if (!run()) return std::nullopt;
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
    measured.cpu = std::min(measured.cpu, cpu_seconds() - cpu_start);
    measured.wall = std::min(measured.wall, wall);
    if (measured.runs++ == 0) measured.bytes = memory("VmHWM") - before;
    spent += wall;
  }
  return measured;
}

}  // namespace bench
