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

  std::vector<std::size_t> middle;  ///< ascending: points that are the middle of an arc between their neighbours

  bool keep_arcs = false;    ///< arcs stay arcs, unless there is an `arc_error`
  double arc_error = 0;      ///< largest deviation of chords that may stand for an arc; 0: arcs are kept, or refused
  std::size_t arcs = 0;      ///< arcs that chords stand for
  double arc_deviation = 0;  ///< how far these chords deviate

  std::size_t size() const { return kind.size(); }
  /// Adds a geometry of any linear or curved type. `place` names it in errors: "feature 7". An arc that two geometries
  /// share gets the same chords in both, whichever way it runs.
  Status add(const OGRGeometry& geometry, std::int64_t number, const std::string& place);
  /// The middles of arcs in part i, counted from its first point.
  std::vector<std::uint32_t> middles_of(std::size_t i) const;

 private:
  Status add_curve(const OGRSimpleCurve& curve, Kind part_kind, std::int64_t number, const std::string& place);
  Status add_polygon(const OGRPolygon& polygon, std::int64_t number, const std::string& place);
  Status add_linear(const OGRGeometry& geometry, std::int64_t number, const std::string& place);
  Status add_curved(const OGRGeometry& geometry, std::int64_t number, const std::string& place);
  /// Appends a curve's vertices; its first one is left out if it is there already.
  Status add_vertices(const OGRCurve& curve, const std::string& place);
  Status add_arcs(const OGRSimpleCurve& string, const std::string& place);
  Status add_vertex(double x, double y, const std::string& place, std::size_t vertex);
  Status close_curve(const OGRCurve& curve, Kind part_kind, std::int64_t number, const std::string& place);
  void close_part(Kind part_kind, std::int64_t number);
};

}  // namespace krepl::input
