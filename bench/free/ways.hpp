#pragma once

#include <memory>
#include <vector>

#include "../zone/lines.hpp"
#include "krepl/point.hpp"

namespace bench {

/// A way to the clearances of placements. The obstacles are indexed when it is made, before the clock starts.
class Way {
 public:
  virtual ~Way() = default;
  /// One for each place; false if it cannot be done.
  virtual bool run(std::vector<double>& clearances) = 0;
};

std::unique_ptr<Way> make_geos(const Lines& lines, double radius, const std::vector<krepl::Point>& places);

}  // namespace bench
