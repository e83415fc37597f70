#pragma once

#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// Reads places from a CSV file (also .gz, or `-`) with columns x and y; other columns are ignored.
///
/// Errors: as CsvTable, no row below the header, coordinates that are missing, not numbers or not finite (the line is named);
/// cancelled.
Result<std::vector<Point>> read_places(const std::string& path, const Context& context = {});

}  // namespace krepl::input
