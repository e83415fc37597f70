#pragma once

#include <string>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::lab {

/// A chart with logarithmic axes, as SVG.
struct Chart {
  struct Series {
    std::string name;
    std::vector<Point> points;  ///< x and y positive; others are left out
    bool line = true;           ///< joined, or places only
    bool dashed = false;        ///< a line without places: what theory says
  };
  std::string title, x_name, y_name;
  std::vector<Series> series;
};

/// Self-contained; the same bytes for the same chart. An empty chart gives axes only.
std::string svg_of(const Chart& chart);

}  // namespace krepl::lab
