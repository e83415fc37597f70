#pragma once

#include "mill/line_bodies.hpp"
#include "terrain/drop_cutter_search.hpp"

namespace krepl::mill {

/// Where on a line a cutter of this radius touches a triangle: one interval, empty (low > high) if nowhere.
Interval domain_of(const drop::Part& part, double radius, const Line& line);

}  // namespace krepl::mill
