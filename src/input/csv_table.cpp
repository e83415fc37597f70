#include "input/csv_table.hpp"

#include <charconv>
#include <cmath>

#include "input/whole_file.hpp"

namespace krepl::input {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view text) {
  std::string result;
  for (const char c : text) result += c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return result;
}

}  // namespace

Result<CsvTable> CsvTable::open(const std::string& path) {
  Result<std::vector<char>> text = read_whole_file(path);
  if (!text) return text.error();
  return from_text(std::move(*text));
}

Result<CsvTable> CsvTable::from_text(std::vector<char> text) {
  CsvTable table;
  table.text_ = std::move(text);
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (std::string_view(table.text_.data(), table.text_.size()).starts_with(byte_order_mark)) table.position_ = 3;
  std::string_view line;
  if (!table.next_line(line)) return Error{ErrorCode::input, "is empty", "", "give a header line and rows"};
  for (const char separator : {',', ';', '\t'}) {
    table.separator_ = separator;
    if (line.find(separator) != std::string_view::npos) break;
  }
  std::vector<std::string_view> names;
  table.split(line, names);
  for (std::string_view name : names) {
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    table.header_.push_back(lower(name));
  }
  return table;
}

Result<std::size_t> CsvTable::column(std::string_view name) const {
  std::string all;
  for (std::size_t i = 0; i < header_.size(); ++i) {
    if (header_[i] == name) return i;
    all += (i == 0 ? "" : ", ") + header_[i];
  }
  return Error{ErrorCode::input, "has no column '" + std::string(name) + "'", "line " + std::to_string(line_),
               "name it in the header; there are: " + all};
}

bool CsvTable::next() {
  std::string_view line;
  if (!next_line(line)) return false;
  split(line, fields_);
  return true;
}

bool CsvTable::next_line(std::string_view& line) {
  const std::string_view text(text_.data(), text_.size());
  while (position_ < text.size()) {
    const std::size_t end = std::min(text.find('\n', position_), text.size());
    line = trimmed(text.substr(position_, end - position_));
    position_ = end + 1;
    ++line_;
    if (!line.empty() && line.front() != '#') return true;
  }
  return false;
}

void CsvTable::split(std::string_view line, std::vector<std::string_view>& fields) const {
  fields.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator_, begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

std::string_view CsvTable::field(std::size_t column) const {
  return column < fields_.size() ? fields_[column] : std::string_view{};
}

Error CsvTable::field_error(std::size_t column, const std::string& what) const {
  return {ErrorCode::input, header_[column] + " " + what, place(), "correct or remove the line"};
}

Result<double> CsvTable::number(std::size_t column) const {
  std::string_view text = field(column);
  if (text.empty()) return field_error(column, "is missing");
  const std::string shown = "'" + std::string(text.substr(0, 40)) + "'";
  if (text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return field_error(column, shown + " is not a number");
  if (status == std::errc::result_out_of_range) return field_error(column, shown + " is out of the range of numbers");
  if (status != std::errc{}) return field_error(column, shown + " is not a number");
  return value;
}

Result<double> CsvTable::finite(std::size_t column) const {
  Result<double> value = number(column);
  if (value && !std::isfinite(*value)) return field_error(column, "is not finite");
  return value;
}

Result<std::vector<Point>> read_points(const std::string& path, std::string_view x_name, std::string_view y_name,
                                       std::string_view things, const Context& context, const PointCheck& check) {
  Result<CsvTable> table = CsvTable::open(path);
  if (!table) return table.error();
  const Result<std::size_t> x_column = table->column(x_name);
  if (!x_column) return x_column.error();
  const Result<std::size_t> y_column = table->column(y_name);
  if (!y_column) return y_column.error();
  std::vector<Point> points;
  while (table->next()) {
    const Result<double> x = table->finite(*x_column);
    if (!x) return x.error();
    const Result<double> y = table->finite(*y_column);
    if (!y) return y.error();
    const Point point{*x, *y};
    if (check) {
      if (Status right = check(points, point, *table); !right) return right.error();
    }
    points.push_back(point);
    if (points.size() % 65536 == 0 && context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  }
  if (points.empty())
    return Error{ErrorCode::input, "has no " + std::string(things), "", "give at least one row below the header"};
  return points;
}

}  // namespace krepl::input
