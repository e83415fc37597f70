#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// Rows of a text table with a header line, read field by field: no quoting, numbers with a decimal point.
class CsvTable {
 public:
  /// Reads the whole file (also .gz, or `-`) and its header. Errors: as checked_path, cannot be read, no header.
  static Result<CsvTable> open(const std::string& path);
  /// The same from text, whole lines of it; continue_with() gives more of them, once next() has come to the end.
  static Result<CsvTable> from_text(std::vector<char> text);
  void continue_with(std::vector<char> text) { text_ = std::move(text), position_ = 0; }

  /// The place of a column, whatever its case; an Error lists those there are.
  Result<std::size_t> column(std::string_view name) const;
  /// Goes to the next row that is neither blank nor a comment; false at the end.
  bool next();
  std::uint64_t line() const { return line_; }
  std::string place() const { return "line " + std::to_string(line_); }
  /// A field of the row, without surrounding blanks; empty if the row is too short.
  std::string_view field(std::size_t column) const;
  /// A field as a number; infinities and NaN are numbers here. Errors name the column and the line.
  Result<double> number(std::size_t column) const;
  /// The same, which must be finite.
  Result<double> finite(std::size_t column) const;

 private:
  bool next_line(std::string_view& line);
  void split(std::string_view line, std::vector<std::string_view>& fields) const;
  Error field_error(std::size_t column, const std::string& what) const;

  std::vector<char> text_;
  std::size_t position_ = 0;
  std::uint64_t line_ = 0;
  char separator_ = ',';
  std::vector<std::string> header_;
  std::vector<std::string_view> fields_;
};

/// Says whether the point in the table's row may follow those before it.
using PointCheck = std::function<Status(std::span<const Point> before, Point point, const CsvTable& table)>;

/// The points in two columns of a table, `things` for people. Errors: as CsvTable; what `check` says; no row below the header;
/// cancelled.
Result<std::vector<Point>> read_points(const std::string& path, std::string_view x_name, std::string_view y_name,
                                       std::string_view things, const Context& context, const PointCheck& check = {});

}  // namespace krepl::input
