#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

/// One edge of a Voronoi diagram or medial axis, ready to be written.
struct AxisLine {
  std::vector<Point> points;  ///< two or more
  std::optional<Point> control;  ///< of a parabola, as a quadratic Bezier curve from the first point to the last
  std::string kind;              ///< `line` or `parabola`
  double start_clearance = 0, end_clearance = 0,
         minimum = 0;                                  ///< distance from the sites at the ends, and the least along it
  std::int64_t left_feature = -1, right_feature = -1;  ///< the input features it runs between
  std::string left_site, right_site;                   ///< `s3` a segment, `v4` a vertex of the input
};

/// Calls its argument with every line in turn, until that returns false.
using AxisSource = std::function<void(const std::function<bool(const AxisLine&)>&)>;

/// Writes lines with their attributes: WKT (geometry only), GeoJSON, or any format of OGR that has lines. The file
/// appears whole or not at all. Errors: usage for svg (see write_axis_svg), dxf and wkb; whatever keeps the file from being written;
/// cancelled.
Status write_axis(const std::string& path, const AxisSource& lines, const ZoneFormat& format, const std::string& crs,
                  const Context& context = {});

/// A picture: the network, and the lines on it, parabolas as quadratic Bezier curves, which they are exactly. What is
/// farther from the network than a tenth of its extent is out of sight. `data-origin` tells what coordinates are relative to.
Status write_axis_svg(const std::string& path, const AxisSource& lines, const Network& network, const Context& context = {});

}  // namespace krepl::output
