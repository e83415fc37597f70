#pragma once

#include <memory>
#include <string>
#include <vector>

#include "krepl/point.hpp"

namespace bench {

using Polylines = std::vector<std::vector<krepl::Point>>;

/// A way to the segment Voronoi diagram, from coordinates in memory.
class Builder {
 public:
  virtual ~Builder() = default;
  /// Builds the diagram anew; the one before is dropped first. False if it fails.
  virtual bool run() = 0;
  /// What else there is to tell of the last one, as members of a JSON object, each with a comma before it.
  virtual std::string more() { return {}; }
};

std::unique_ptr<Builder> make_krepl(const Polylines& lines);
/// Boost.Polygon assumes that segments meet at their ends only, and takes integers of 32 bits.
std::unique_ptr<Builder> make_boost(const Polylines& lines);
/// CGAL's segment Delaunay graph for segments that meet at their ends only; exact by filtered predicates.
std::unique_ptr<Builder> make_cgal(const Polylines& lines);

}  // namespace bench
