#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::section {

/// Makes `count` cuts, each by make(i), on context.threads threads. The first error by number, if there is one.
template <class Cut, class Make>
Result<std::vector<Cut>> make_each(std::size_t count, const Context& context, const Make& make) {
  std::vector<Cut> result(count);
  std::vector<std::optional<Error>> errors(count);
  kernel::Progress progress(context, count);
  const bool done = kernel::parallel_blocks(context, count, 1, [&](std::size_t i, std::size_t) {
    Result<Cut> made = make(i);
    if (made)
      result[i] = std::move(*made);
    else
      errors[i] = made.error();
    progress.add(1);
  });
  for (const auto& error : errors) {
    if (error) return *error;
  }
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return result;
}

}  // namespace krepl::section
