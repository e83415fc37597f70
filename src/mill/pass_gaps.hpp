#pragma once

#include <cstdint>
#include <vector>

#include "krepl/drop_cutter.hpp"
#include "mill/pass_layout.hpp"

namespace krepl::mill {

/// Where the gaps between the passes of a layout get further passes, for places that what there is does not cover.
class PassGaps {
 public:
  struct Extra {
    std::size_t gap;  ///< before the pass of that number of the layout
    PassLayout::Pass pass;
    bool is_across;  ///< of the layout across()
  };

  /// `together`: places nearer to each other along the passes are served by one; `close`: how well places are known.
  PassGaps(const PassLayout& layout, double together, double close);

  /// Passes half-way between those that are there, over the stretches where places are; where all places of a stretch
  /// lie on one line, as along the foot of a wall, a pass beside it on its lower side. They are there from then on.
  std::vector<Extra> serve(const std::vector<Point3>& places, const DropCutter& cutter);
  /// Short passes across the others, over the places: they go down to the bottom of valleys that run along the others.
  std::vector<Extra> serve_across(const std::vector<Point3>& places) const;

  /// A pass of no length at a place.
  Extra at(Point3 place) const;

  /// Of passes at a right angle to the layout's; it has none.
  const PassLayout& across() const { return turned_; }

 private:
  struct Place {
    double along, across;  // in lattice steps, the latter from the first pass
    Point3 at;
  };
  struct Stretch {
    std::int64_t across, first, last;
  };
  Place place_of(Point3 p) const;
  std::size_t gap_of(double across) const;
  std::int64_t choose(const std::vector<Place>& run, std::int64_t low, std::int64_t high,
                      const DropCutter& cutter) const;

  const PassLayout& layout_;
  PassLayout turned_;
  double together_, close_;                  // in lattice steps
  std::vector<std::int64_t> across_;         // of the layout's passes
  std::vector<std::vector<Stretch>> extra_;  // of gaps
};

}  // namespace krepl::mill
