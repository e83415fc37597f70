#pragma once

#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/profile.hpp"

namespace krepl::app {

/// A row per piece from left to right: kind,x0,y0,x1,y1,cx,cy,segment. Numbers have the fewest digits that give the same
/// double back; the lower ends of the half-lines are -inf; only arcs have a centre.
Status write_profile_csv(const std::string& path, const Profile& profile, const Context& context);

/// A picture of the terrain and the boundary of its sum, with true arcs; coordinates are relative to the left end and the
/// lowest point, y downwards.
Status write_profile_svg(const std::string& path, const Profile& profile, const Context& context);

}  // namespace krepl::app
