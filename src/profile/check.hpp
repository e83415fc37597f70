#pragma once

#include <cstdint>

#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::profile {

inline constexpr double smallest_radius = 1e-140;
inline constexpr double largest_size = 1e140;  ///< of the radius and of coordinates: their squares must not overflow

Status check_radius(double radius);
/// True if the first point can be taken; later ones are judged by Sweep::append against the one before.
bool usable(Point p);
/// What is wrong with vertex `index`; `before` is the vertex before it or null.
Error vertex_error(std::uint64_t index, Point p, const Point* before);
Error no_vertex_error();
Error too_many_vertices_error();
/// Vertices a run can number.
inline constexpr std::uint64_t most_vertices = (std::uint64_t{1} << 31) - 1;

}  // namespace krepl::profile
