#pragma once

#include <cstdint>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/surface.hpp"
#include "lab/report.hpp"

namespace krepl::lab {

/// Section 4.3: vertices of d(T (+) B) over n/2 grooves and n/2 needles for each n, as one terrain and as islands, and
/// the exponent with which they grow. Errors: an n that is not a multiple of 4 or not in [4, 1024] (usage); counts
/// other than the argument of lower_bound.hpp gives (computation); cancelled.
Result<Report> lower_bound_experiment(const std::vector<std::size_t>& n, const Context& context);

/// Section 2.3: vertices of the extremal 2D terrains of n segments for each n. Errors: an n not in [2, 10^7] (usage);
/// counts other than the theorems give (computation); cancelled.
Result<Report> profiles_experiment(const std::vector<std::size_t>& n, const Context& context);

/// Section 3.3, figure 3.6: crossings met by a sweep over all cigars at once and by clean-up in rounds, for a sub-river of
/// n reaches of which each two cigars overlap, and for one that is spread out. Errors: an n not in [3, 4000] (usage);
/// fewer crossings than the construction must have, or another zone than compute_zone gives (computation); cancelled.
Result<Report> sweep_experiment(const std::vector<std::size_t>& n, const Context& context);

/// Figure 4.5: three triangles and the balls that touch all of them, by both engines. Error: not four (computation).
Result<Report> pseudospheres_experiment(const Context& context);

/// Theorem 4.5.4: in how many components the last of 22 triangles meets the others. Error: not two (computation).
Result<Report> components_experiment(const Context& context);

struct ConjectureOptions {
  std::size_t count = 10000;                      ///< terrains in all, one or more
  std::vector<std::size_t> sizes{8, 16, 32, 64};  ///< triangles, 1 to 1000; families that need more are left out
  std::uint64_t seed = 1;
  double limit = 60;  ///< seconds of the clock for a terrain; what takes longer is counted as late
};
/// Conjecture 4.5.6: the greatest number of vertices against n lambda_2(n), by family of random terrains and n.
/// Up to n = 32 a record counts only if both engines find it. Errors: options out of range (usage); cancelled. Terrains
/// without a result are counted.
Result<Report> conjecture_experiment(const ConjectureOptions& options, const Context& context);

struct SearchOptions {
  std::vector<std::size_t> sizes{4, 8, 16};  ///< triangles, 3 to 100
  std::size_t steps = 2000;                  ///< changes tried from each start
  std::size_t restarts = 4;                  ///< starts of each family and size
  std::uint64_t seed = 1;
  double limit = 10;  ///< seconds of the clock for a terrain; what takes longer is not taken
};
/// Hill climbing: random terrains changed step by step, as long as they do not lose vertices. Errors as above.
Result<Report> search_experiment(const SearchOptions& options, const Context& context);

/// Vertices against triangles over parts of an elevation model about its middle, each half as wide as the next larger
/// one. Errors: a mesh (input); those of the surface.
Result<Report> crops_experiment(const Terrain& terrain, const std::vector<double>& radii, const Context& context);

}  // namespace krepl::lab
