#include "kernel/pages.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace krepl::kernel {
namespace {

TEST(Pages, MemoryIsReservedAndNothingIsChanged) {
  for (const unsigned threads : {1u, 2u}) {
    Context context;
    context.threads = threads;
    std::vector<int> numbers{1, 2, 3};
    reserve_pages(context, numbers, 3'000'000);
    EXPECT_GE(numbers.capacity(), 3'000'000u);
    EXPECT_EQ(numbers, (std::vector<int>{1, 2, 3}));
    const int* const place = numbers.data();
    reserve_large(numbers, 10);  // less than there is
    resize_pages(context, numbers, 3'000'000, 7);
    EXPECT_EQ(numbers.data(), place);
    EXPECT_EQ(numbers[2], 3);
    EXPECT_EQ(numbers[3], 7);
    EXPECT_EQ(numbers.back(), 7);
  }
}

/// Arrays of all lengths from many threads, longer ones than a piece among them, are there until they are released.
TEST(Pages, StoreKeepsArrays) {
  Store<int> store;
  constexpr int count = 200;
  const auto length = [](std::size_t i) { return i == 7 ? std::size_t{10'000'000} : i % 5 * 40'000; };
  std::vector<std::span<const int>> kept(count);
  Context context;
  context.threads = 2;
  parallel_blocks(context, count, 1, [&](std::size_t i, std::size_t) {
    std::vector<int> array(length(i));
    std::iota(array.begin(), array.end(), int(i));
    kept[i] = store.keep(array);
  });
  std::size_t places = 0;
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(kept[i].size(), length(i));
    for (std::size_t k = 0; k < kept[i].size(); k += 997) ASSERT_EQ(kept[i][k], int(i + k));
    if (!kept[i].empty()) ASSERT_EQ(kept[i].back(), int(i + kept[i].size() - 1));
    places += kept[i].size();
    store.release(kept[i]);
  }
  EXPECT_GT(places, 20'000'000u);
  EXPECT_EQ(store.keep(std::vector<int>{5})[0], 5);
}

}  // namespace
}  // namespace krepl::kernel
