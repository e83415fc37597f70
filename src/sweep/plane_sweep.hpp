#pragma once

#include <optional>

#include "krepl/error.hpp"
#include "sweep/predicates.hpp"

namespace krepl::sweep {

/// Finds the boundary of what is covered by sweeping a line from left to right [bentley1979]: the curves that it cuts
/// stand in a balanced tree from below to above, each with the number of times that the place below it is covered;
/// events are ends of curves and crossings of neighbours. O((n + k) log n) for n curves and k crossings.
///
/// Returns nothing if more crossings than `most` were met. Errors: cancelled; decisions that contradict each other
/// (ErrorCode::computation, names the place). Precondition: no two curves overlap (see overlay).
Result<std::optional<Outline>> sweep(Outline outline, std::uint64_t most, Predicates& predicates,
                                     const Context& context);

}  // namespace krepl::sweep
