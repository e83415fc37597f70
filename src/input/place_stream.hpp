#pragma once

#include <cstdint>
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
  /// Errors: as ByteStream and CsvTable.
  static Result<PlaceStream> open(const std::string& path, bool with_z, const Context& context = {});

  /// Replaces `places` by the next portion, which is empty at the end. z is 0 where it was not asked for. Errors: no
  /// row below the header; coordinates that are missing, not numbers or not finite (the line is named); cancelled.
  Status next(std::vector<Point3>& places, const Context& context = {});

 private:
  PlaceStream(ByteStream bytes, bool with_z) : bytes_(std::move(bytes)), with_z_(with_z) {}
  Result<std::vector<char>> whole_lines(const Context& context);
  Result<Point3> place() const;

  ByteStream bytes_;
  bool with_z_;
  std::vector<char> rest_;  // the beginning of a line
  bool at_end_ = false;
  CsvTable table_;
  std::size_t column_[3] = {};
  std::uint64_t count_ = 0;
};

}  // namespace krepl::input
