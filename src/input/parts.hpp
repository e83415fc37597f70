#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "input/geometry_source.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// Lines, rings and points as read, before projection and indexing.
struct Parts {
  enum class Kind : std::uint8_t { line, ring, point };
  std::vector<Point> points;
  std::vector<std::size_t> begin{0};  ///< part i holds points begin[i] .. begin[i+1]
  std::vector<std::int64_t> feature;
  std::vector<Kind> kind;
  bool has_height = false;  ///< Z or M was left out somewhere

  std::size_t size() const { return kind.size(); }
  /// Adds a geometry of any linear type. `place` names it in errors: "feature 7".
  Status add(const OGRGeometry& geometry, std::int64_t number, const std::string& place);

 private:
  Status add_curve(const OGRSimpleCurve& curve, Kind part_kind, std::int64_t number, const std::string& place);
  Status add_polygon(const OGRPolygon& polygon, std::int64_t number, const std::string& place);
  Status add_linear(const OGRGeometry& geometry, std::int64_t number, const std::string& place);
  Status add_vertex(double x, double y, const std::string& place, std::size_t vertex);
  void close_part(Kind part_kind, std::int64_t number);
};

}  // namespace krepl::input
