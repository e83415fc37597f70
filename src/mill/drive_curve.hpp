#pragma once

#include <cstdint>
#include <vector>

#include "mill/line_bodies.hpp"

namespace krepl::mill {

/// A point of a vertical plane through a line.
struct CurvePoint {
  double t, z;
};

/// A polyline in the vertical plane of a line, t never descending, with vertical segments where the cutter drops down
/// or climbs up a wall. No body rises above it anywhere, and no point of it is farther than a given distance above the
/// bodies.
using CurveRun = std::vector<CurvePoint>;

struct DriveCurveOptions {
  double floor = 0;     ///< the control point never goes below
  double accuracy = 0;  ///< largest distance between the polyline and the highest body, measured normal to it
  double smallest = 0;  ///< stretches below that count as vertical; far less than the accuracy
  double grain = 0;     ///< runs start and end at multiples of it
};

/// The drive curve of passes: what the control point must stay above along a line. One for each thread.
class DriveCurve {
 public:
  DriveCurve(LineBodies& bodies, const DriveCurveOptions& options) : bodies_(bodies), options_(options) {}

  /// Appends the runs between t = from and t = to, multiples of the grain, where the cutter touches something, or with
  /// `over_air` one run over everything. Expected time proportional to the number of pieces that the curve consists of.
  void trace(const Line& line, double from, double to, bool over_air, std::vector<CurveRun>& runs);
  /// The highest point of the curve between from and to, at most the accuracy above it.
  double highest(const Line& line, double from, double to);
  /// The most by which the curve is above a line that is `slope` t high at t, at most the accuracy more; where the curve
  /// is at the floor, by which that is.
  double highest_above(const Line& line, double from, double to, double slope);

  std::uint64_t touches() const { return touches_; }

 private:
  /// A body over the part [low, high] of an interval that it reaches over: its heights at both ends, and the point
  /// where the tangents there meet.
  struct Candidate {
    std::size_t body;
    double low, high;
    Touch at_low, at_high;
    CurvePoint apex;
  };
  static constexpr std::size_t nobody = ~std::size_t{0};

  void trace_stretch(double from, double to);
  void add_candidate(std::size_t body, double low, double high, Touch at_low, Touch at_high);
  Touch touch(std::size_t body, double t);
  void subdivide(double a, double b, std::size_t first, int depth);
  void prune(double a, double b, std::size_t first);
  void emit(CurvePoint a, CurvePoint b, std::size_t first);
  void split(double a, double m, double b, std::size_t first, int depth);
  void append(CurvePoint p);

  struct Ends;
  Ends find_ends(double a, double b, std::size_t first) const;
  bool is_close(double a, double b, const Ends& ends, std::size_t first) const;
  double split_place(double a, double b, const Ends& ends, std::size_t first) const;

  LineBodies& bodies_;
  DriveCurveOptions options_;
  std::vector<Interval> domains_;      // of the bodies, a little longer than they are
  std::vector<Candidate> candidates_;  // a stack: those of the interval at hand are last
  std::vector<CurvePoint> hull_;
  CurveRun* out_ = nullptr;
  std::uint64_t touches_ = 0;
};

}  // namespace krepl::mill
