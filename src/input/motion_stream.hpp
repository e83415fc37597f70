#pragma once

#include <memory>
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

/// Motions from a file, portion by portion: memory grows with the longest motion, not with the file.
///
/// CSV (also .gz, or `-`) with columns x, y and, if asked for, z, a row a point: where there is a column `motion`, rows that follow
/// one another with the same text there are one motion; else all rows are one motion, named 1. Any OGR layer of lines, .wkt, .wkb:
/// a motion a line, named by the number of its feature (or line of the file), those of a multi-line 7.1, 7.2, ...
class MotionStream {
 public:
  /// `layer` and `where` choose what is read of a vector file. Errors: as PlaceStream; as open_geometry_source; --layer or --where
  /// for a CSV (usage).
  static Result<MotionStream> open(const std::string& path, bool with_z, const std::string& layer = "",
                                   const std::string& where = "", const Context& context = {});
  MotionStream(MotionStream&&) noexcept;
  MotionStream& operator=(MotionStream&&) noexcept;
  ~MotionStream();

  /// Replaces `motions` by the next portion of whole motions, which is empty at the end. Errors name line or feature: a coordinate
  /// that is missing or not finite; what is not a line, has arcs, or lacks the z that was asked for; coordinates in degrees; no
  /// motion at all; cancelled.
  Status next(Motions& motions, const Context& context = {});

 private:
  class Source;
  class Rows;
  class Lines;
  explicit MotionStream(std::unique_ptr<Source> source);
  std::unique_ptr<Source> source_;
};

}  // namespace krepl::input
