#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "krepl/curve_network.hpp"

namespace krepl::arcs {

/// The radius of each segment, arc and vertex of a network: one for all, or of several parts that have it the largest, whose zone
/// holds the others.
class Radii {
 public:
  explicit Radii(double radius) : least_(radius), most_(radius) {}
  /// One for each part, all finite and positive. O(n log n).
  Radii(const CurveNetwork& network, std::span<const double> part_radii);

  double of_segment(std::uint32_t s) const { return segment_.empty() ? most_ : segment_[s]; }
  double of_arc(std::uint32_t a) const { return arc_.empty() ? most_ : arc_[a]; }
  /// Of the disk about it.
  double of_vertex(std::uint32_t v) const { return vertex_.empty() ? most_ : vertex_[v]; }
  double least() const { return least_; }
  double most() const { return most_; }

 private:
  double least_, most_;
  std::vector<double> segment_, arc_, vertex_;
};

}  // namespace krepl::arcs
