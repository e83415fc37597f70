#include "input/place_reader.hpp"

#include "input/csv_table.hpp"

namespace krepl::input {

Result<std::vector<Point>> read_places(const std::string& path, const Context& context) {
  Result<CsvTable> table = CsvTable::open(path);
  if (!table) return table.error();
  const Result<std::size_t> x_column = table->column("x");
  if (!x_column) return x_column.error();
  const Result<std::size_t> y_column = table->column("y");
  if (!y_column) return y_column.error();
  std::vector<Point> places;
  while (table->next()) {
    const Result<double> x = table->finite(*x_column);
    if (!x) return x.error();
    const Result<double> y = table->finite(*y_column);
    if (!y) return y.error();
    places.push_back({*x, *y});
    if (places.size() % 65536 == 0 && context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  }
  if (places.empty()) return Error{ErrorCode::input, "has no places", "", "give at least one row below the header"};
  return places;
}

}  // namespace krepl::input
