#pragma once

#include <optional>
#include <vector>

#include "input/profile_reader.hpp"
#include "input/result_file.hpp"

namespace krepl::measure {

/// A number and its place in the plane.
struct PlacedInPlane {
  double value = 0;
  Point at{};
  bool found = false;

  void lower(double other, Point place) {
    if (!found || other < value) *this = {other, place, true};
  }
};

struct ZoneMeasure {
  std::optional<double> radius;
  std::size_t polygons = 0, holes = 0, segments = 0, arcs = 0;
  double area = 0, length = 0, segment_length = 0, arc_length = 0;
  PlacedInPlane shortest_piece, smallest_polygon, smallest_hole;  ///< polygons without their holes
};

/// Exact but for rounding; arcs are the true ones. Linear time.
ZoneMeasure measure_zone(const input::ResultZone& zone);

struct ProfileMeasure {
  std::size_t segments = 0, arcs = 0;
  double segment_length = 0, arc_length = 0;
  double lowest = 0, highest = 0;  ///< of the ends of pieces
  PlacedInPlane shortest_piece;
};

ProfileMeasure measure_profile(const std::vector<input::ProfileRecord>& pieces);

}  // namespace krepl::measure
