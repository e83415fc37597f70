// libFuzzer's entry: ./surface_fuzz CORPUS_DIRECTORY -max_total_time=60
#include <cstdio>
#include <cstdlib>

#include "fuzz/surface_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (const auto fault = krepl::test::fuzz_small_surface({data, size})) {
    std::fprintf(stderr, "%s\n", fault->c_str());
    std::abort();
  }
  return 0;
}
