#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace krepl::kernel {

/// Leaves those values of a list that stand in it an odd number of times, each once, sorted: what holds a place by the even-odd
/// rule, of the features whose sides a ray has met. O(n log n).
template <class Value>
void keep_odd_ones(std::vector<Value>& list) {
  std::sort(list.begin(), list.end());
  std::size_t kept = 0;
  for (std::size_t i = 0, j = 0; i < list.size(); i = j) {
    while (j < list.size() && list[j] == list[i]) ++j;
    if ((j - i) % 2 == 1) list[kept++] = list[i];
  }
  list.resize(kept);
}

}  // namespace krepl::kernel
