#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "krepl/terrain.hpp"
#include "terrain/drop_cutter_bound.hpp"
#include "terrain/drop_cutter_profile.hpp"
#include "terrain/drop_cutter_profile_bound.hpp"
#include "terrain/drop_cutter_touch.hpp"

namespace krepl::drop {

using Index = Terrain::Index;

/// How coordinates become the single precision of the bounds: divided by a power of two near the extent, so that squares
/// neither overflow nor underflow.
struct Scale {
  double extent;   // largest absolute coordinate of the terrain
  double tallest;  // largest absolute height
  double inverse_unit;
  explicit Scale(const Terrain& terrain)
      : extent(terrain.extent()),
        tallest(std::max(std::abs(terrain.lowest().z), std::abs(terrain.highest().z))),
        inverse_unit(std::ldexp(1.0, -std::ilogb(extent))) {}
};

/// A triangle with the numbers of its features.
struct Part {
  std::array<Point3, 3> corner;  // counter-clockwise from above unless vertical
  std::array<Index, 3> vertex, edge;  // edge i runs between corners i and (i + 1) % 3
  Index face;
  bool vertical;
};

/// What rounding to single precision may have moved coordinates by, those of blocks and those of triangles.
struct Moved {
  double blocks, triangles;
};

/// A ball or another tool over one place, or a ball over all places of a rectangle, and how high it rests at least:
/// parts with bounds below that are out of the question.
template <class Tool, class Spread>
class Query {
 public:
  Query(const Scale& scale, const Tool& tool_, const Moved& moved, const Spread& spread_ = {})
      : tool(tool_),
        bounds(tool_, scale.inverse_unit, moved.blocks * scale.inverse_unit),
        spread(spread_),
        inverse_unit_(scale.inverse_unit) {
    // Heights in single precision, a few operations; evaluations in double precision; planes over coordinates that have
    // moved.
    const double heights =
        0x1p-20 * scale.tallest + 0x1p-44 * (tool.radius + scale.extent) + Tool::Bound::slack_per_radius * tool.radius;
    slack_of_blocks_ = float((heights + slack_per_move * moved.blocks) * inverse_unit_);
    slack_of_triangles_ = float((heights + slack_per_move * moved.triangles) * inverse_unit_);
  }

  const Tool tool;
  const typename Tool::Bound bounds;
  const Spread spread;

  /// The tool is known to rest no lower than this.
  void raise(double height) {
    const float relative = float(tool.tip(height) * inverse_unit_);
    least_ = std::max(least_, relative - 0x1p-22f * std::abs(relative));
  }
  float threshold_of_blocks() const { return least_ - slack_of_blocks_; }
  float threshold_of_triangles() const { return least_ - slack_of_triangles_; }
  /// Stores the bounds of four blocks or triangles and returns which are worth a look, as bits.
  unsigned worth(const FourBlocks& four, float* store) const { return worth(four, threshold_of_blocks(), store); }
  unsigned worth(const FourTriangles& four, float* store) const { return worth(four, threshold_of_triangles(), store); }

 private:
  template <class Four>
  unsigned worth(const Four& four, float threshold, float* store) const {
    const Float4 b = bound(bounds, four, spread);
    b.store(store);
    return 15u & ~bits(b < Float4(threshold));
  }

  double inverse_unit_;
  float least_ = -std::numeric_limits<float>::max();
  float slack_of_blocks_, slack_of_triangles_;
};

/// The search for the highest touch over one place.
///
/// Heights of equal value in double precision go to the feature of lowest dimension, then of lowest number, and parts
/// are left out only if their bounds fall short of the best height by more than rounding. So the result is a function
/// of the place, not of the order in which parts are visited.
template <class Tool>
class ToolSearch : public Query<Tool, OnePlace> {
 public:
  using Query<Tool, OnePlace>::Query;
  using Query<Tool, OnePlace>::tool;

  double height() const { return best_; }
  Index feature() const { return feature_; }
  Terrain::FeatureKind kind() const { return kind_; }
  /// The triangle by which the best feature was found.
  Index part() const { return part_; }

  Index skip = Terrain::none;  ///< a triangle that has been looked at already

  /// Looks at a triangle: its face, or those sides and corners that the ball may touch instead.
  void touch(const Part& part, Index number);

 private:
  void offer(double height, Index feature, Terrain::FeatureKind kind, Index part) {
    if (!(height >= best_) || height == nothing) return;
    if (height == best_ && (kind != kind_ ? kind > kind_ : feature >= feature_)) return;
    if (height > best_) best_ = height, this->raise(height);
    feature_ = feature, kind_ = kind, part_ = part;
  }

  double best_ = nothing;
  Index feature_ = Terrain::none, part_ = Terrain::none;
  Terrain::FeatureKind kind_ = Terrain::FeatureKind::face;
};
static_assert(Terrain::FeatureKind::vertex < Terrain::FeatureKind::edge &&
              Terrain::FeatureKind::edge < Terrain::FeatureKind::face);

template <class Tool>
void ToolSearch<Tool>::touch(const Part& p, Index number) {
  using Kind = Terrain::FeatureKind;
  FaceTouch face;  // of a vertical triangle: all sides are worth a look
  if (!p.vertical) face = touch_face(p.corner[0], p.corner[1], p.corner[2], tool);
  offer(face.height, p.face, Kind::face, number);
  if (face.beyond == 0) return;
  unsigned corners = 0;
  for (unsigned i = 0; i < 3; ++i) {
    if ((face.beyond & (1u << i)) == 0) continue;
    // From the lower number to the higher, as Terrain::corners() has it.
    const unsigned next = i == 2 ? 0 : i + 1;
    const unsigned a = p.vertex[i] < p.vertex[next] ? i : next, b = a ^ i ^ next;
    const EdgeTouch edge = touch_edge(p.corner[a], p.corner[b], tool);
    offer(edge.height, p.edge[i], Kind::edge, number);
    if (edge.ends & 1) corners |= 1u << a;
    if (edge.ends & 2) corners |= 1u << b;
  }
  for (unsigned i = 0; i < 3; ++i)
    if (corners & (1u << i)) offer(touch_vertex(p.corner[i], tool).height, p.vertex[i], Kind::vertex, number);
}

using Search = ToolSearch<Ball>;
using ProfileSearch = ToolSearch<ProfileTool>;

/// Places of a rectangle together.
template <class Tool>
using ToolSurvey = Query<Tool, ManyPlaces>;
using Survey = ToolSurvey<Ball>;
using ProfileSurvey = ToolSurvey<ProfileTool>;

/// Parts that may hold the highest touch, with their bounds; the most promising first.
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
  bool empty() const { return count_ == 0; }
  const Entry* begin() const { return entries_.data(); }
  const Entry* end() const { return entries_.data() + count_; }

 private:
  std::array<Entry, capacity> entries_;
  std::size_t count_ = 0;
};

}  // namespace krepl::drop
