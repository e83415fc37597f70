#pragma once

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
#include "krepl/owners.hpp"
#include "krepl/point.hpp"
#include "krepl/zone.hpp"

namespace krepl {

/// How a diagram came about. Printed by `krepl --verbose`.
struct VoronoiCounters {
  std::uint64_t faces = 0;           ///< sides of segments, and vertices with a face of their own
  std::uint64_t candidates = 0;      ///< sites looked at closely for them
  std::uint64_t faces_in_pairs = 0;  ///< computed again, in pairs of doubles: neighbours disagreed in double precision
  std::uint64_t faces_in_quadruple = 0;     ///< of them, once more, because they still disagreed
  std::uint64_t vertices_in_quadruple = 0;  ///< evaluated again because the faces around them disagreed on the place
  std::uint64_t faces_in_320_bits = 0;      ///< of them, once more, because they still disagreed
  std::uint64_t links_reconciled = 0;       ///< below 2^-36 of the extent, seen from one side only
  std::uint64_t rounds = 0;                 ///< of computing faces again until all neighbours agreed
};

struct VoronoiOptions {
  /// A diagram for which more sites than this are looked at (and more than 2^20) is given up with ErrorCode::computation; 0:
  /// never. Ordinary are 5 to 10 for each face; as many as there are sites where all faces meet in the centre of a finely
  /// digitised circle. Threads do not change what is given up.
  std::uint64_t most_candidates = 0;
};

/// The segment Voronoi diagram of a network: for every place of the plane, which site is nearest. Sites are the two
/// sides of each open segment and the vertices. A vertex has a face of its own only within the gap above 180 degrees
/// that its segments leave (thesis 3.4 with its erratum: faces of end points and reflex vertices are there); everywhere
/// else around it a side is nearer. Lines may cross, overlap, branch and repeat: segments that cross share the crossing
/// as a place of clearance 0.
///
/// The diagram answers for every radius: the zone's boundary within a face is the site's own boundary at distance R.
class VoronoiDiagram {
 public:
  /// A site: side `side` of a segment (0: right of it as it runs from a to b, 1: left), or a vertex.
  struct Site {
    bool is_vertex = false;
    std::uint32_t index = 0;  ///< of the segment or vertex in network()
    std::uint32_t side = 0;   ///< segments only
    friend bool operator==(const Site&, const Site&) = default;
  };

  /// The stretch of the diagram between two faces: a straight piece (two vertices, two sides, or a side and its own
  /// end) or a piece of a parabola (a side and another vertex). Coordinates are absolute.
  struct Edge {
    Site left, right;  ///< the sites whose faces lie on the left and on the right, from start to end
    Point start, end;  ///< an unbounded edge ends at the horizon
    double start_clearance, end_clearance;  ///< distance from the sites
    double minimum;                         ///< least distance from the sites along the edge
    bool parabolic;
    /// True for a perpendicular between a side and its own end, which touches the network: part of the Voronoi diagram,
    /// not of the medial axis.
    bool touches_site;
  };

  /// Computes the diagram: expected O(n log n), about 500 bytes per segment; polygons count as their rings. Decisions
  /// are those of one instance whose vertices are within 2^-72 S (docs/voronoi.md). Errors: cancelled; a diagram that
  /// does not certify.
  static Result<VoronoiDiagram> build(std::shared_ptr<const Network> network, const Context& context = {},
                                      const VoronoiOptions& options = {});

  /// The zone of the network at one radius: the same rings as compute_zone gives. O(n), with a small constant. Errors
  /// as compute_zone; and ErrorCode::usage for a radius beyond horizon().
  Result<Zone> zone(const ZoneOptions& options, const Context& context = {}) const;
  /// The zones at several radii, in the order given, side by side on all threads.
  Result<std::vector<Zone>> zones(std::span<const double> radii, const Context& context = {}) const;
  /// The zone at one radius, shared out among owners: each place of it goes to the owner of the nearest part (straight
  /// and parabolic borders, along the medial axis between owners); places as near to several, to the lowest of them;
  /// inside polygons, to the lowest owner of a polygon around. part_owner[p] owns network().part(p). Owners in ascending
  /// order, without those that have no share; areas add up to the zone's. Chords of parabolas deviate by max_error at
  /// most. Segments of different owners that overlap without having both ends in common: decided for either. Errors as
  /// zone(); not one owner for each part; max_error not positive.
  Result<std::vector<OwnerZone>> owner_zones(double radius, std::span<const std::uint32_t> part_owner, double max_error,
                                             const Context& context = {}) const;
  /// Faces are cut off at this distance from their site: 2^20 extents of the network (infinite if it has a single
  /// vertex).
  double horizon() const;

  const Network& network() const;
  const VoronoiCounters& counters() const;
  std::size_t face_count() const;
  std::size_t edge_count() const;
  std::size_t vertex_count() const;

  /// All edges, each once, in a fixed order.
  std::vector<Edge> edges() const;
  /// Points along an edge from start to end, ends included; chords deviate from a parabola by max_error at most, where
  /// coordinates can hold that. Only what is no farther than max_clearance from the sites: none if that is nothing.
  /// Precondition: the edge is one of edges(); max_error > 0; its clearance falls and rises again at most once, so one
  /// stretch at either end is left out.
  std::vector<Point> points(const Edge& edge, double max_error, double max_clearance) const;

  /// The control point that makes the same stretch of a parabolic edge a quadratic Bezier curve, without any deviation:
  /// where the tangents at its ends meet. Nothing for straight edges, and where the stretch is nothing.
  std::optional<Point> control_point(const Edge& edge, double max_clearance) const;

  /// Edges are the same seen from both sides, borders of faces are closed, what has no neighbour lies at the horizon.
  /// Returns what is wrong and where, or nothing.
  std::optional<std::string> validate() const;

 private:
  struct Parts;
  explicit VoronoiDiagram(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}
  std::shared_ptr<const Parts> parts_;
};

/// Whether one diagram for all radii is the quicker way to their zones, against compute_zone once for each. A diagram costs
/// about as much as a dozen zones without one (docs/voronoi.md, "Cost"), and ends at its horizon.
bool diagram_pays(const Network& network, std::span<const double> radii);

/// VoronoiOptions::most_candidates beyond which a diagram for that many radii takes longer than a zone by the sweep for each.
std::uint64_t diagram_budget(const Network& network, std::size_t radii);

}  // namespace krepl
