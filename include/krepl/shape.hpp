#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"
#include "krepl/zone.hpp"

namespace krepl {

/// How a zone ends where a line ends: at a vertex that all segments leave in one direction (within 2^-20).
enum class Cap : std::uint8_t {
  round,  ///< by a half circle about the end
  flat,   ///< straight across through the end; a point has no zone
  square  ///< straight across at one radius beyond the end; a point has an upright square
};

/// How a zone goes round the outer side of a bend: in the one gap above 180 degrees that the segments at a vertex leave.
enum class Join : std::uint8_t {
  round,  ///< by an arc about the vertex
  mitre,  ///< the two sides go on until they meet; bevelled where that is too far away
  bevel   ///< straight from the end of one side to the start of the next
};

enum class Side : std::uint8_t { both, left, right };

struct ShapeOptions {
  /// In the input's unit, not zero. Negative: polygons are shrunk, to what is at least that far inside their borders.
  double distance = 0;
  Cap cap = Cap::round;
  Join join = Join::round;
  /// Mitres reach at most this many radii from their vertex, at least 1; corners that would reach farther are bevelled.
  double mitre_limit = 5;
  /// Left or right: of lines, the part of the zone whose nearest place of the network is seen from there on that side.
  Side side = Side::both;
  /// Polygons are taken out of their own zone. With a negative distance: what shrinking takes off.
  bool ring = false;
  /// Where a one-sided zone ends on a parabola, between a line's side and a place that belongs to the other: largest
  /// deviation of its chords; 0: a millionth of the distance.
  double max_error = 0;
};

/// A zone in one of the shapes that GIS users know (docs/shape.md). With the defaults and a positive distance the same as
/// compute_zone, bit for bit. The boundary consists of true segments and arcs; Piece::role tells what each is.
///
/// The zone of lines is the union of: for each segment the rectangle of all places straight beside it within R; for each
/// bend its join; for each end its cap. With round caps and joins that is all within R. Segments of one network that share
/// a vertex are joined there, whichever features they belong to.
///
/// Shrunk polygons: what of each feature's polygon (rings of a feature by the even-odd rule) is farther than R from its
/// border. Nothing may be left: a zone without rings. Features that overlap are cut by each other's borders.
///
/// One-sided zones end straight across at the ends of lines. In a network each place belongs to what is nearest to it, so
/// facing sides of different kinds meet half-way, and mitres end where something else is nearer than their vertex. They go with
/// joins and no other option.
///
/// Errors: usage for options out of range or that do not go together, lines or points to be shrunk (with the feature),
/// `ring` without polygons; those of compute_zone.
Result<Zone> compute_shape(std::shared_ptr<const Network> network, const ShapeOptions& options,
                           const Context& context = {});

/// What keeps the rings of a feature from being those of valid polygons by the OGC's rules [ogc_sfa, 6.1.11].
struct RingFault {
  enum class Kind : std::uint8_t {
    crossing,   ///< two sides cross
    touching,   ///< a ring comes back to a place where it has been
    overlapping,  ///< two sides run along each other
    direction,  ///< an outer ring and a hole run the same way round
    collapsed   ///< a ring encloses nothing
  };
  Kind kind;
  std::int64_t feature;
  Point where;  ///< the first such place, in absolute coordinates
  std::size_t count;  ///< how many of the kind the feature has
};

/// The faults of all polygons of a network, feature by feature; at most one of each kind a feature. Places nearer to each
/// other than 2^-50 of the extent count as one. O((n + k) log n) for k crossings. Errors: cancelled.
Result<std::vector<RingFault>> check_rings(const Network& network, const Context& context = {});

}  // namespace krepl
