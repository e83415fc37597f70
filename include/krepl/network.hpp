#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl {

class CurveNetwork;

/// What building a Network changed or dropped; every number is a count of occurrences in the input.
struct CleaningReport {
  std::size_t input_vertices = 0;      ///< vertices as given
  std::size_t coinciding_vertices = 0; ///< vertices welded to another one with exactly equal coordinates
  std::size_t repeated_vertices = 0;   ///< consecutive equal vertices in one line (zero-length segments dropped)
  std::size_t duplicate_segments = 0;  ///< segments dropped because another one has the same two ends
};

/// A validated, immutable set of line segments and isolated points: rivers, roads, coasts, outlines.
/// Lines may cross, overlap, branch and repeat. Vertices with equal coordinates are one vertex, segments with the same
/// ends are one segment; nothing else is changed, no vertex is moved.
///
/// Vertices are stored along a Hilbert curve and segments by their lower vertex, so neighbours in the plane are
/// neighbours in memory; `segment_source` and `vertex_source` lead back to the input.
class Network {
 public:
  struct Segment {
    std::uint32_t a, b;  ///< vertex indices, a < b
    friend bool operator==(const Segment&, const Segment&) = default;
  };

  /// Where something came from: the feature's number as the caller gave it, the part's running number over the whole
  /// input (one per added line, ring or point), and the vertex's number inside that part (a segment's first vertex).
  struct Source {
    std::int64_t feature = -1;
    std::uint32_t part = 0;
    std::uint32_t vertex = 0;
  };

  class Builder {
   public:
    /// An open or closed polyline. One vertex makes an isolated point; none is ignored.
    void add_line(std::span<const Point> vertices, std::int64_t feature = -1);
    /// A polygon ring (closed by the caller or not). Rings of one feature count by the even-odd rule; the inside of a
    /// polygon belongs to its zone.
    void add_ring(std::span<const Point> vertices, std::int64_t feature = -1);
    void add_point(Point p, std::int64_t feature = -1);
    /// Number of vertices given so far.
    std::size_t vertex_count() const { return points_.size(); }
    /// Validates and indexes. Errors: no vertex at all; a coordinate that is NaN or infinite (named by feature and
    /// vertex); more than 2^28 (268 million) vertices. O(n) but for the sort along the Hilbert curve.
    Result<Network> build(const Context& context = {}) &&;

   private:
    friend class Network;
    friend class CurveNetwork;
    void add_part(std::span<const Point> vertices, std::int64_t feature, bool ring);
    std::vector<Point> points_;
    std::vector<std::uint32_t> part_begin_;
    std::vector<std::int64_t> part_feature_;
    std::vector<bool> part_is_ring_;
    std::vector<std::uint32_t> gaps_;  // vertices from which no segment leads to the next, ascending
  };

  /// The middle of the input's bounding box, rounded so that taking it off is exact for ordinary data; `vertices()` and
  /// everything computed from them are relative to it.
  Point origin() const { return origin_; }
  /// Distinct vertices, relative to origin().
  std::span<const Point> vertices() const { return vertices_; }
  /// Distinct segments of positive length.
  std::span<const Segment> segments() const { return segments_; }
  /// Largest absolute coordinate relative to origin(): the extent that S of the accuracy contract starts from.
  double extent() const { return extent_; }
  /// Distance between neighbouring doubles at the input's largest absolute coordinate: no output can be finer.
  double resolution() const { return resolution_; }
  /// True if any part was added with add_ring.
  bool has_polygons() const { return has_polygons_; }

  Source segment_source(std::uint32_t segment) const;
  Source vertex_source(std::uint32_t vertex) const;
  /// True if the segment is a side of a polygon ring.
  bool segment_is_ring(std::uint32_t segment) const;
  const CleaningReport& report() const { return report_; }

  /// Number of parts and, per part, the vertices in input order (indices into vertices()), for readers that need the
  /// lines as they were: vertices of part p are chain()[part_begin(p) .. part_begin(p+1)).
  std::size_t part_count() const { return part_begin_.size() - 1; }
  std::span<const std::uint32_t> part(std::uint32_t p) const;
  std::int64_t part_feature(std::uint32_t p) const { return part_feature_[p]; }
  bool part_is_ring(std::uint32_t p) const { return part_is_ring_[p]; }

 private:
  friend class Builder;
  friend class CurveNetwork;
  Source source_of(std::uint32_t position) const;
  void index_segments(const std::vector<std::uint32_t>& gaps);
  Point origin_;
  double extent_ = 0;
  double resolution_ = 0;
  bool has_polygons_ = false;
  std::vector<Point> vertices_;
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> chain_;            // vertex index per input vertex, input order
  std::vector<std::uint32_t> segment_position_; // per segment: position in chain_ of its first end
  std::vector<std::uint32_t> vertex_position_;  // per vertex: the first position in chain_ where it stands
  std::vector<std::uint32_t> part_begin_;
  std::vector<std::int64_t> part_feature_;
  std::vector<bool> part_is_ring_;
  CleaningReport report_;
};

}  // namespace krepl
