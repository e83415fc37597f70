#pragma once

#include <utility>

#include "krepl/route.hpp"
#include "krepl/voronoi.hpp"
#include "route/plane.hpp"

namespace krepl::route {

/// An edge of the medial axis, with places on it told by a parameter: the way from the start for a line, the coordinate
/// along the directrix, from the focus, for a parabola.
class AxisEdge {
 public:
  AxisEdge(const VoronoiDiagram::Edge& edge, const Network& network);

  double start() const { return start_; }
  double end() const { return end_; }
  /// The parameter of a place on the edge; within its range for any other.
  double parameter(Point p) const;
  /// How far a place is from being on the edge, across the line or directrix.
  double residual(Point p) const;
  /// Least clearance and length between two parameters.
  double clearance(double t0, double t1) const;
  double length(double t0, double t1) const;
  Point place(double t) const;
  /// Of a parabola: where the tangents at two parameters meet.
  Point control(double t0, double t1) const;
  Route::Kind kind() const { return parabolic_ ? Route::Kind::parabola : Route::Kind::line; }
  Point focus() const { return focus_; }
  std::uint32_t focus_vertex() const { return focus_vertex_; }
  std::uint32_t directrix() const { return directrix_; }

 private:
  struct Site {
    bool is_vertex = false;
    Point a, direction;  // a vertex, or the line of a segment
    double distance(Point p) const;
  };
  static Site site_of(const VoronoiDiagram::Site& site, const Network& network);
  double along_parabola(double u) const;

  bool parabolic_;
  Site left_, right_;
  Point from_, to_, direction_;  // direction of the line, or of the directrix
  double start_, end_;
  Point focus_, apex_axis_;  // parabola: unit vector from the directrix to the focus
  double focal_ = 0;         // distance of focus and directrix
  std::uint32_t focus_vertex_ = Route::none, directrix_ = Route::none;
};

}  // namespace krepl::route
