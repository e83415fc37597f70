#pragma once

#include <map>
#include <memory>
#include <vector>

#include "mill/lifted_cutter.hpp"
#include "terrain/drop_cutter_stretch.hpp"

namespace krepl::mill {

/// The places of the plane over which a cutter that is no ball rests higher than a level: a union of convex sets, one
/// for each triangle, as the sum of a triangle and a convex cutter is convex. A line meets each of them in one
/// interval, whose ends are found by closing in on them from both sides: a concave function is above its chords and
/// below its tangents. Not for use by several threads.
class LevelBodies {
 public:
  /// `level`: of the control point, relative to the part's origin; `grain`: gaps and intervals shorter than that count
  /// as none.
  LevelBodies(const LiftedCutter& cutter, double level, double grain);

  /// Whether the cutter is known to rest higher everywhere over a square: on one triangle.
  bool is_covered(Point low, Point high);
  /// Lists the triangles on which it may rest higher somewhere over a rectangle.
  void list(Point low, Point high) { search_.list_rectangle(low, high, level_, parts_); }
  std::size_t size() const { return parts_.size(); }

  /// The parts of a line between a and b over which it does not rest higher on any triangle of the list, in their
  /// order.
  void free_parts(const Line& line, double a, double b, std::vector<Interval>& free);
  bool is_free(const Line& line, double a, double b);
  bool is_covered(const Line& line, double a, double b);

 private:
  Touch touch(std::size_t part, const Line& line, double t) const;
  double end_of(std::size_t part, const Line& line, double inside, double outside) const;
  Interval interval_within(std::size_t part, const Line& line, double a, double b) const;
  bool may_rise_between(std::size_t part, const Line& line, double a, double b) const;

  bool is_covered_by(const drop::Part& part, Point low, Point high) const;

  drop::StretchSearch search_;
  /// What rests on a triangle nearer to its axis covers more: cutters of less radius by half a diagonal of squares, by
  /// their size.
  struct Inner {
    DropCutter drop;
    drop::StretchSearch search;
    explicit Inner(DropCutter smaller) : drop(std::move(smaller)), search(drop) {}
  };
  std::map<double, std::unique_ptr<Inner>> inner_;
  drop::ProfileTool tool_;
  double level_, grain_, closest_;  // level_: of the larger cutter's tip
  std::vector<drop::Part> parts_;
  std::vector<Touch> at_a_, at_b_;  // of the line at hand
  std::vector<Interval> covered_, free_;
};

}  // namespace krepl::mill
