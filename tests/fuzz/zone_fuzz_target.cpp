// libFuzzer's entry: ./zone_fuzz CORPUS_DIRECTORY -max_total_time=60
#include <cstdio>
#include <cstdlib>

#include "fuzz/zone_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto fault = krepl::test::fuzz_zone({data, size});
  if (!fault) fault = krepl::test::fuzz_engines({data, size});
  if (fault) {
    std::fprintf(stderr, "%s\n", fault->c_str());
    std::abort();
  }
  return 0;
}
