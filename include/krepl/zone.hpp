#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"
#include "krepl/subdivision.hpp"

namespace krepl {

namespace zone {
struct VariedSites;
}

/// How often each rung of the ladder of predicates decided, and what the search cost. Printed by `krepl --verbose`.
struct ZoneCounters {
  std::uint64_t elements = 0;          ///< offset sides and vertex arcs examined
  std::uint64_t covered_at_once = 0;   ///< of them, covered by a recently successful segment
  std::uint64_t candidates = 0;        ///< cigars intersected with elements in double precision
  std::uint64_t elements_in_double = 0;     ///< decided in double precision within its error bound
  std::uint64_t elements_in_quadruple = 0;  ///< decided in quadruple precision
  std::uint64_t ties_by_perturbation = 0;   ///< of those, decided only by the symbolic-size perturbation of vertices
  std::uint64_t collapsed_pieces = 0;  ///< pieces dropped because no double lies between their ends
  std::uint64_t dropped_rings = 0;     ///< rings dropped because they are thinner than the coordinate resolution
};

/// The zone (buffer) of a network: its Minkowski sum with a disk, bounded by true segments and circular arcs.
///
/// The boundary is a set of rings; ring r consists of the pieces ring_begin(r) .. ring_begin(r+1), in order, with the zone
/// on the left: outer rings run counter-clockwise, holes clockwise. Piece e is edge e of subdivision(): half-edge 2e runs
/// with the piece (zone on its left), 2e+1 against it. The piece starts at vertex e.
class Zone {
 public:
  enum class Kind : std::uint8_t { segment, arc };
  /// What a piece is to the input. Zones of compute_zone have offsets only; the others come from krepl/shape.hpp.
  enum class Role : std::uint8_t {
    offset,  ///< parallel to a segment, or an arc about a vertex, at the zone's radius
    input,   ///< along a segment of the input
    end,     ///< across the end of a line: a flat or square cap, or the end of a one-sided zone
    bevel,   ///< cuts a corner off
    between  ///< as far from one site as from another, where a one-sided zone meets what belongs to the other side
  };

  /// One true piece of the boundary, in absolute coordinates. An arc runs counter-clockwise from start to end about
  /// center (start == end: the full circle), unless it is `clockwise`.
  struct Piece {
    Kind kind;
    Point start, end;
    Point center;          ///< arcs only
    std::uint32_t source;  ///< the segment or vertex (`from_vertex`) of network() that causes it, or arc (`from_arc`)
    bool reversed;         ///< segments only: the piece runs from the source segment's b to its a
    double radius = 0;     ///< of the disk that the source is widened by; of arcs `from_arc`: their own
    bool clockwise = false;    ///< arcs only: where a polygon shrinks, and inside an arc, they run round their centre the other way
    bool from_vertex = false;  ///< source is a vertex: all arcs about one, ends and bevels
    Role role = Role::offset;
    /// Source is an arc of curves(). Of an arc far wider than all coordinates the centre is rounded as they are: the ends
    /// and the radius tell more.
    bool from_arc = false;
  };

  /// A connected part of the zone: one outer ring and its holes.
  struct Polygon {
    std::uint32_t outer;
    std::span<const std::uint32_t> holes;
  };

  /// Of the disk; the largest where the parts of the network have radii of their own.
  double radius() const { return radius_; }
  /// The radius with a sign: negative where polygons were shrunk.
  double signed_radius() const { return inward_ ? -radius_ : radius_; }
  /// The smallest.
  double least_radius() const { return least_radius_; }
  /// Of a band (zone_band): what is no farther than this from the network is left out. 0: a whole zone.
  double inner_radius() const { return inner_radius_; }
  /// Largest of radius and extent: the S of the accuracy contract.
  double scale() const;
  const Network& network() const { return *network_; }
  /// The lines with arcs that this is the zone of, whose straight part network() is; null where there are none.
  const CurveNetwork* curves() const { return curves_.get(); }
  const Subdivision& subdivision() const { return subdivision_; }
  const ZoneCounters& counters() const { return counters_; }

  std::size_t piece_count() const { return vertex_.size(); }
  Piece piece(std::uint32_t e) const;
  /// True along a band's inner border: the piece lies at inner_radius() from the network.
  bool is_inner(std::uint32_t e) const { return e >= outer_pieces_; }
  std::size_t ring_count() const { return ring_begin_.size() - 1; }
  std::uint32_t ring_begin(std::uint32_t r) const { return ring_begin_[r]; }
  bool ring_is_hole(std::uint32_t r) const { return ring_is_hole_[r]; }
  std::size_t hole_count() const;
  std::size_t polygon_count() const { return polygon_outer_.size(); }
  Polygon polygon(std::uint32_t p) const;

  /// Area and length of the boundary, exact up to rounding. O(pieces).
  double area() const;
  double perimeter() const;

  /// Topology by Subdivision::validate(), and geometry: pieces join, arcs have the radius, rings have the right sense.
  std::optional<std::string> validate() const;

 private:
  friend class ZoneAssembly;
  /// As piece(), relative to the network's origin.
  Piece local_piece(std::uint32_t e) const;
  double ring_area(std::uint32_t r) const;

  double radius_ = 0, least_radius_ = 0, inner_radius_ = 0;
  std::uint32_t outer_pieces_ = ~std::uint32_t{0};  // a band's inner border begins there
  bool inward_ = false;
  std::shared_ptr<const Network> network_;
  std::shared_ptr<const CurveNetwork> curves_;
  std::shared_ptr<const zone::VariedSites> varied_;  // none where there is one radius, or pieces tell theirs
  std::vector<Point> vertex_;           // relative to the network's origin; vertex e starts piece e
  std::vector<std::uint32_t> element_;  // per piece: the boundary element it lies on; or, of other shapes,
  std::vector<Piece> shaped_;           // the pieces themselves, relative to the network's origin
  std::vector<std::uint32_t> ring_begin_;
  std::vector<bool> ring_is_hole_;
  std::vector<std::uint32_t> polygon_outer_, polygon_hole_begin_, polygon_hole_;
  Subdivision subdivision_;
  ZoneCounters counters_;
};

struct ZoneOptions {
  /// Radius of the disk in the input's unit: finite and positive.
  double radius = 0;
  /// Where elements meet more cigars than this in the mean (and 2^20 in all), the computation is given up with
  /// ErrorCode::computation; 0: never. Ordinary are 1 to 6; thousands on a finely digitised circle of nearly the radius, where the
  /// search is quadratic. Threads do not change what is given up.
  std::uint64_t most_candidates = 0;
};

/// The zone of a network by the covered-intervals engine (thesis section 3.3 in a robust form; docs/zone.md).
///
/// The topology is exactly that of an instance whose vertices are within 2^-72 S and whose radius is 2^-48 S (or 4 units
/// in the last place of the coordinates) above the given one, so zones that touch merge and degenerate input needs no care.
/// Polygons of the network are filled. Errors: radius not finite and positive, or finer than the coordinates' resolution;
/// cancelled; a result that does not certify. Expected O(n log n); memory about 300 bytes per segment at most.
Result<Zone> compute_zone(std::shared_ptr<const Network> network, const ZoneOptions& options,
                          const Context& context = {});

/// The same with a radius for each part of the network (part_radii[p] for network->part(p)): the union of the parts'
/// own zones, with true arcs of their radii. Where parts share a segment, the largest of their radii counts for it. All
/// radii equal: the same zone, to the last bit, as with that one. Rings of one feature should have one radius, for a
/// polygon is filled whole. Errors also: not one radius for each part.
Result<Zone> compute_zone(std::shared_ptr<const Network> network, std::span<const double> part_radii,
                          const Context& context = {});

/// The band between two zones of one network: what of the outer one the inner one leaves. Its boundary consists of theirs,
/// bit for bit; the inner one's pieces stand behind the outer one's, run the other way round, and their arcs clockwise.
/// Errors: usage for zones of different networks, with radii of parts, shrunk, one-sided, with other caps than round, or
/// with radii closer than 2^-36 S. O(pieces + rings log pieces).
Result<Zone> zone_band(const Zone& inner, const Zone& outer, const Context& context = {});

}  // namespace krepl
