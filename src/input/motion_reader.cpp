#include "input/motion_reader.hpp"

#include "input/csv_table.hpp"

namespace krepl::input {

Result<Motions> read_motions(const std::string& path, bool with_z, const Context& context) {
  Result<CsvTable> table = CsvTable::open(path);
  if (!table) return table.error();
  std::size_t column[3] = {};
  for (std::size_t k = 0; k < (with_z ? 3u : 2u); ++k) {
    const Result<std::size_t> found = table->column(std::string_view("xyz").substr(k, 1));
    if (!found) return found.error();
    column[k] = *found;
  }
  const Result<std::size_t> named = table->column("motion");
  Motions motions;
  while (table->next()) {
    double p[3] = {};
    for (std::size_t k = 0; k < (with_z ? 3u : 2u); ++k) {
      const Result<double> number = table->finite(column[k]);
      if (!number) return number.error();
      p[k] = *number;
    }
    const std::string_view name = named ? table->field(*named) : "1";
    if (motions.name.empty() || motions.name.back() != name) {
      motions.begin.push_back(motions.points.size());
      motions.name.emplace_back(name);
    }
    motions.points.push_back({p[0], p[1], p[2]});
    if (motions.points.size() % 65536 == 0 && context.cancelled())
      return Error{ErrorCode::cancelled, "cancelled", "", ""};
  }
  if (motions.points.empty())
    return Error{ErrorCode::input, "has no motions", "", "give at least one row below the header"};
  motions.begin.push_back(motions.points.size());
  return motions;
}

}  // namespace krepl::input
