#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/mill.hpp"

namespace krepl::test {

/// The same moves from one thread and from two and three.
inline void expect_same_from_any_threads(const std::function<Result<MilledPath>(const Context&)>& mill) {
  std::vector<Move> first;
  for (const unsigned threads : {1u, 2u, 3u}) {
    Context context;
    context.threads = threads;
    const Result<MilledPath> milled = mill(context);
    ASSERT_TRUE(milled) << milled.error().text();
    const std::vector<Move>& moves = milled->path.moves;
    if (threads == 1) {
      first = moves;
      continue;
    }
    ASSERT_EQ(first.size(), moves.size()) << threads << " threads";
    for (std::size_t k = 0; k < moves.size(); ++k)
      ASSERT_TRUE(first[k].end == moves[k].end && first[k].centre == moves[k].centre) << k << ", " << threads << " threads";
  }
}

}  // namespace krepl::test
