#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "krepl/point.hpp"

namespace bench {

/// Polylines as plain coordinates: line i has the points begin[i] .. begin[i+1].
struct Lines {
  std::vector<krepl::Point> points;
  std::vector<std::size_t> begin{0};

  std::size_t count() const { return begin.size() - 1; }
  std::size_t segments() const { return points.size() - count(); }
};

/// Reads a text of WKT LINESTRINGs, one a line, or of GMT multi-segments (">" lines between points "lon lat" in degrees,
/// projected to metres by the equidistant cylindrical projection, sphere of 6371007.2 m, true to scale at 45 degrees).
/// Consecutive equal points are dropped, as are lines of one point. Nothing if the file cannot be read.
std::optional<Lines> read_lines(const std::string& path);

/// Exactly `segments` segments: the first ones, or copies of the lines side by side in a square grid with gaps of
/// 1 % of their extent.
Lines resized(const Lines& lines, std::size_t segments);

double mean_segment_length(const Lines& lines);

}  // namespace bench
