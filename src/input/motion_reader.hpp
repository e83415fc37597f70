#pragma once

#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// Polylines of placements.
struct Motions {
  std::vector<Point3> points;
  std::vector<std::size_t> begin;  ///< of each motion; behind the last one their end
  std::vector<std::string> name;   ///< of each motion

  std::size_t size() const { return name.size(); }
};

/// Reads motions from a CSV file (also .gz, or `-`) with columns x, y and, if asked for, z, a row a point. Where there
/// is a column `motion`, rows that follow one another with the same text there are one motion; else all rows are one
/// motion, named 1. Errors: as read_places.
Result<Motions> read_motions(const std::string& path, bool with_z, const Context& context = {});

}  // namespace krepl::input
