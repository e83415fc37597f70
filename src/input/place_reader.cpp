#include "input/place_reader.hpp"

#include "input/csv_table.hpp"

namespace krepl::input {

Result<std::vector<Point>> read_places(const std::string& path, const Context& context) {
  return read_points(path, "x", "y", "places", context);
}

}  // namespace krepl::input
