#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "krepl/point.hpp"
#include "krepl/zone.hpp"

namespace krepl::lab {

/// A river without tributaries that does not cross itself, and the radius that belongs to it.
struct SubRiver {
  const char* name;
  std::vector<Point> vertices;
  double radius;
};

/// n reaches up and down, four radii long, all within one radius of width: each two cigars overlap, and the boundaries
/// of those that are not neighbours cross twice (figure 3.6's idea). Precondition: 3 or more, as for the other.
SubRiver bundle(std::size_t reaches);
/// The same reaches spread out, 0.9 radii apart: each cigar overlaps the two next to it on either side, as on ordinary
/// rivers.
SubRiver spread(std::size_t reaches);

/// Pairs of reaches of a bundle that are not neighbours, at two crossings each: what a sweep of their cigars has to
/// meet at least.
std::size_t bundle_crossings(std::size_t reaches);

/// The river, its cigars and its zone.
std::string svg_of(const SubRiver& river, const Zone& zone, const std::string& title);

}  // namespace krepl::lab
