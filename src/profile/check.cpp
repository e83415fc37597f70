#include "profile/check.hpp"

#include <charconv>
#include <cmath>
#include <string>

namespace krepl::profile {

namespace {

std::string number(double x) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

}  // namespace

Status check_radius(double radius) {
  const std::string shown = "radius " + number(radius);
  if (std::isnan(radius)) return Error{ErrorCode::usage, "radius is not a number", "", "give a positive radius"};
  if (!(radius > 0)) return Error{ErrorCode::usage, shown + " is not positive", "", "give a positive radius"};
  if (radius < smallest_radius || radius > largest_size)
    return Error{ErrorCode::usage, shown + " is outside 1e-140 .. 1e140", "", "choose another unit"};
  return std::monostate{};
}

bool usable(Point p) { return std::fabs(p.x) <= largest_size && std::fabs(p.y) <= largest_size; }

Error vertex_error(std::uint64_t index, Point p, const Point* before) {
  const std::string where = "vertex " + std::to_string(index);
  if (!std::isfinite(p.x) || !std::isfinite(p.y))
    return {ErrorCode::input, "a coordinate is not finite", where, "remove or repair the point"};
  if (!usable(p)) return {ErrorCode::input, "a coordinate is above 1e140 in size", where, "choose another unit"};
  if (before != nullptr && p.x < before->x)
    return {ErrorCode::input, "x decreases from " + number(before->x) + " to " + number(p.x), where,
            "sort the points by x; a terrain has one height above each x, cliffs apart"};
  return {ErrorCode::input, "the step from the vertex before is above 1e140 in size", where, "choose another unit"};
}

Error no_vertex_error() {
  return {ErrorCode::input, "the terrain has no point", "", "give at least one point"};
}

Error too_many_vertices_error() {
  return {ErrorCode::input, "more than 2147483647 points", "", "cut the terrain into parts that overlap by 2R"};
}

}  // namespace krepl::profile
