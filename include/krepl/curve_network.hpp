#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"

namespace krepl {

/// A validated, immutable set of lines and rings made of segments and circular arcs, and of isolated points: roads,
/// tool paths, outlines of parts.
///
/// An arc is given as in WKT, by its start, a point in its middle (anywhere strictly between) and its end; start and
/// end equal: the full circle on which the middle is opposite to them. The circle is the one through the three points,
/// however flat. Three points exactly in line, or two of them equal, are the segments that join them.
///
/// A type beside Network and not a Network: what takes lines only cannot be given arcs by mistake.
class CurveNetwork {
 public:
  /// Vertices of straight(). Arcs over the same three points are one arc, in whichever direction they were given.
  struct Arc {
    std::uint32_t start, middle, end;
    friend bool operator==(const Arc&, const Arc&) = default;
  };

  class Builder {
   public:
    /// A line of segments and arcs: where `middles` (ascending) holds i, vertices i-1, i, i+1 are an arc, which may
    /// share its ends with others. The first and the last vertex are no middles.
    void add_line(std::span<const Point> vertices, std::span<const std::uint32_t> middles = {},
                  std::int64_t feature = -1);
    /// A polygon ring (closed by the caller or not), as Network::Builder::add_ring.
    void add_ring(std::span<const Point> vertices, std::span<const std::uint32_t> middles = {},
                  std::int64_t feature = -1);
    void add_point(Point p, std::int64_t feature = -1);
    /// Errors: as Network::Builder::build, and middles that are not as they must be (named by feature). O(n log n).
    Result<CurveNetwork> build(const Context& context = {}) &&;

   private:
    void add_part(std::span<const Point> vertices, std::span<const std::uint32_t> middles, bool ring,
                  std::int64_t feature);
    Network::Builder straight_;
    std::vector<std::uint32_t> middle_;  // positions over all parts, ascending
    std::vector<std::int64_t> faulty_;   // features whose middles are not as they must be
  };

  /// The lines without their arcs: the origin, all vertices (ends and middles of arcs too), the segments, and the parts
  /// as they were given. To algorithms that take a Network, the ends and middles of arcs are points.
  const Network& straight() const { return *straight_; }
  /// The same, to be kept.
  std::shared_ptr<const Network> share_straight() const { return straight_; }

  /// Distinct arcs, by their lower end.
  std::span<const Arc> arcs() const { return arcs_; }
  /// Where an arc came from; `vertex` is its start as it was given.
  Network::Source arc_source(std::uint32_t arc) const;
  /// Per part: the places in straight().part(p) that are the middle of an arc, ascending.
  std::span<const std::uint32_t> part_middles(std::uint32_t p) const {
    return {middle_.data() + middle_begin_[p], middle_begin_[p + 1] - middle_begin_[p]};
  }
  /// Largest absolute coordinate relative to the origin, of the arcs themselves too.
  double extent() const { return extent_; }
  /// Vertices that belong to a segment or end an arc, or are points of the input: what lines start, bend and end at.
  /// The others are middles.
  const std::vector<bool>& is_joint() const { return is_joint_; }

 private:
  void index_arcs(const std::vector<std::uint32_t>& middles);
  std::shared_ptr<Network> straight_;
  std::vector<Arc> arcs_;
  std::vector<std::uint32_t> arc_position_;  // per arc: position of its first end in the input
  std::vector<std::uint32_t> middle_, middle_begin_;
  std::vector<bool> is_joint_;
  double extent_ = 0;
};

}  // namespace krepl
