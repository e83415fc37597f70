#pragma once

#include <string>

#include "krepl/profile.hpp"
#include "krepl/surface.hpp"

namespace krepl::lab {

/// A surface seen from above, as SVG: faces by what they are pieces of (sand: planes, blue: cylinders, red: spheres),
/// seams, valleys and rims as lines, vertices where the ball touches three places as dots. Curves are drawn by chords.
std::string svg_of(const Surface& surface, const std::string& title);

/// A 2D terrain and its sum with true arcs; implicit vertices as small, explicit ones as large dots.
std::string svg_of(const Profile& profile, const std::string& title);

}  // namespace krepl::lab
