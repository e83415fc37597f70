#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "krepl/terrain.hpp"
#include "terrain/drop_cutter_bound.hpp"
#include "terrain/drop_cutter_touch.hpp"

namespace krepl::drop {

using Index = Terrain::Index;

/// How coordinates become the single precision of the bounds: divided by a power of two near the extent, so that squares
/// neither overflow nor underflow.
struct Scale {
  double extent;  // largest absolute coordinate of the terrain
  double tallest;  // largest absolute height
  double inverse_unit;
  explicit Scale(const Terrain& terrain)
      : extent(terrain.extent()),
        tallest(std::max(std::abs(terrain.lowest().z), std::abs(terrain.highest().z))),
        inverse_unit(std::ldexp(1.0, -std::ilogb(extent))) {}
};

/// A cutter over a place: the highest touch found so far, and what is still worth looking at.
///
/// Heights of equal value in double precision go to the feature of lowest dimension, then of lowest number, and bounds
/// are kept only if they fall short of the best height by more than rounding. So the result is a function of the place, not
/// of the order in which parts are visited.
class Search {
 public:
  /// `moved`: what rounding to single precision may have moved a coordinate by.
  Search(const Scale& scale, Point place, double radius, double moved)
      : ball{place, radius, radius * radius}, bounds(radius * scale.inverse_unit), inverse_unit_(scale.inverse_unit) {
    // Heights in single precision; evaluations in double precision; planes over coordinates that are off by `moved`.
    blur = float(moved * inverse_unit_);
    slack_ = float((0x1p-18 * scale.tallest + 0x1p-44 * (radius + scale.extent) + 2 * steepest * moved) * inverse_unit_);
  }

  const Ball ball;
  const BallBound bounds;
  float blur;                   ///< in the unit of the bounds
  Index skip = Terrain::none;   ///< a part that has been looked at already

  double height() const { return best_; }
  Index feature() const { return feature_; }
  Terrain::FeatureKind kind() const { return kind_; }
  /// The part of the hierarchy (cell, triangle) to which the best feature belongs.
  Index part() const { return part_; }
  /// Bounds below it are out of the question.
  float threshold() const { return threshold_; }

  /// True if a touch at this height would be the new best one.
  bool wants(double height, Index feature, Terrain::FeatureKind kind) const {
    if (height != best_) return height > best_;
    return height > nothing && (kind != kind_ ? kind < kind_ : feature < feature_);
  }
  void take(double height, Index feature, Terrain::FeatureKind kind, Index part) {
    if (height > best_) best_ = height, raise(height);
    feature_ = feature, kind_ = kind, part_ = part;
  }
  /// The terrain reaches this point, so the result is no lower than a ball that touches it.
  void expect(Point3 point) {
    const double x = point.x - ball.place.x, y = point.y - ball.place.y, s = ball.squared - (x * x + y * y);
    if (s > 0.25 * ball.squared) raise(point.z + std::sqrt(s));
  }

 private:
  void raise(double height) {
    const float relative = float((height - ball.radius) * inverse_unit_);
    threshold_ = std::max(threshold_, relative - 0x1p-22f * std::abs(relative) - slack_);
  }

  double inverse_unit_;
  double best_ = nothing;
  float threshold_ = -std::numeric_limits<float>::max();
  float slack_ = 0;
  Index feature_ = Terrain::none, part_ = Terrain::none;
  Terrain::FeatureKind kind_ = Terrain::FeatureKind::face;
};
static_assert(Terrain::FeatureKind::vertex < Terrain::FeatureKind::edge &&
              Terrain::FeatureKind::edge < Terrain::FeatureKind::face);

/// Parts that may hold the highest touch, with their bounds; the most promising first once sorted.
template <std::size_t capacity>
class Candidates {
 public:
  struct Entry {
    float bound;
    Index column, row;
  };
  void add(float bound, Index column, Index row = 0) {
    std::size_t i = count_++;
    for (; i > 0 && entries_[i - 1].bound < bound; --i) entries_[i] = entries_[i - 1];
    entries_[i] = {bound, column, row};
  }
  const Entry* begin() const { return entries_.data(); }
  const Entry* end() const { return entries_.data() + count_; }

 private:
  std::array<Entry, capacity> entries_;
  std::size_t count_ = 0;
};

}  // namespace krepl::drop
