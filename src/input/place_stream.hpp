#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/byte_stream.hpp"
#include "input/csv_table.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// Places from a CSV file (also .gz, or `-`) with columns x, y and, if asked for, z, portion by portion: memory does
/// not grow with the file. Other columns are ignored.
class PlaceStream {
 public:
  /// Errors: as ByteStream and CsvTable. `label`: a column that next() can read too; it may be missing.
  static Result<PlaceStream> open(const std::string& path, bool with_z, const Context& context = {},
                                  std::string_view label = {});

  /// Replaces `places` by the next portion, which is empty at the end. z is 0 where it was not asked for. Errors: no
  /// row below the header; coordinates that are missing, not numbers or not finite (the line is named); cancelled.
  Status next(std::vector<Point3>& places, const Context& context = {}) { return next(places, nullptr, context); }
  /// The same with the text in the column `label` for each place, empty where there is none.
  Status next(std::vector<Point3>& places, std::vector<std::string>& labels, const Context& context = {}) {
    return next(places, &labels, context);
  }
  bool has_labels() const { return label_column_.has_value(); }

 private:
  PlaceStream(ByteStream bytes, bool with_z) : bytes_(std::move(bytes)), with_z_(with_z) {}
  Result<std::vector<char>> whole_lines(const Context& context);
  Result<Point3> place() const;
  Status next(std::vector<Point3>& places, std::vector<std::string>* labels, const Context& context);

  ByteStream bytes_;
  bool with_z_;
  std::vector<char> rest_;  // the beginning of a line
  bool at_end_ = false;
  CsvTable table_;
  std::size_t column_[3] = {};
  std::optional<std::size_t> label_column_;
  std::uint64_t count_ = 0;
};

}  // namespace krepl::input
