// Parallel curves: the boundary of a line's zone without its caps, told apart by the side of the line.
#include "krepl/offset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "kernel/box_tree.hpp"
#include "kernel/orientation.hpp"
#include "kernel/vectors.hpp"
#include "krepl/zone.hpp"

namespace krepl {
namespace {

using Index = std::uint32_t;

enum Sides : unsigned { neither = 0, left = 1, right = 2 };

using namespace vectors;

double angle_of(const OffsetCurve::Piece& arc) {
  const Point u = arc.start - arc.center, v = arc.end - arc.center;
  const double angle = arc.clockwise ? std::atan2(cross(v, u), dot(u, v)) : std::atan2(cross(u, v), dot(u, v));
  if (arc.start == arc.end) return 2 * std::numbers::pi;
  return angle < -1 ? angle + 2 * std::numbers::pi : std::max(angle, 0.0);  // a tiny arc may seem to run backwards
}

double length_of(const OffsetCurve::Piece& piece, double radius) {
  return piece.arc ? radius * angle_of(piece) : std::hypot(piece.end.x - piece.start.x, piece.end.y - piece.start.y);
}

/// The zone's pieces first, first + 1, ... of a ring, `count` of them, as one curve; against their order if
/// `backwards`.
OffsetCurve make_curve(const Zone& zone, Index ring, Index first, Index count, bool backwards) {
  const Index begin = zone.ring_begin(ring), size = zone.ring_begin(ring + 1) - begin;
  OffsetCurve curve{};
  for (Index i = 0; i < count; ++i) {
    const Zone::Piece p = zone.piece(begin + (first + i) % size);
    const bool arc = p.kind == Zone::Kind::arc;
    curve.pieces.push_back(backwards ? OffsetCurve::Piece{arc, true, p.end, p.start, p.center}
                                     : OffsetCurve::Piece{arc, false, p.start, p.end, p.center});
    curve.length += length_of(curve.pieces.back(), zone.radius());
  }
  if (backwards) std::reverse(curve.pieces.begin(), curve.pieces.end());
  curve.closed = count == size;
  return curve;
}

/// On which side of a line the pieces of its zone's boundary are.
class LineSides {
 public:
  /// The network has the line as its only part.
  explicit LineSides(const Network& line)
      : line_(line),
        forward_(line.segments().size(), false),
        backward_(line.segments().size(), false),
        begin_(line.vertices().size() + 1, 0) {
    const auto chain = line.part(0);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      if (chain[i - 1] == chain[i]) continue;
      (chain[i - 1] < chain[i] ? forward_ : backward_)[segment(chain[i - 1], chain[i])] = true;
    }
    for (const Network::Segment& s : line.segments()) ++begin_[s.a + 1], ++begin_[s.b + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    neighbour_.resize(begin_.back());
    std::vector<Index> at(begin_.begin(), begin_.end() - 1);
    for (const Network::Segment& s : line.segments()) neighbour_[at[s.a]++] = s.b, neighbour_[at[s.b]++] = s.a;
  }

  unsigned sides(const Zone::Piece& piece) const {
    if (piece.kind == Zone::Kind::segment) {
      const Network::Segment s = line_.segments()[piece.source];
      return piece.reversed ? right_of(s.b, s.a) : right_of(s.a, s.b);
    }
    return arc_sides(piece);
  }

 private:
  Index segment(Index u, Index v) const {
    const Network::Segment wanted{std::min(u, v), std::max(u, v)};
    const auto before = [](Network::Segment s, Network::Segment t) { return s.a != t.a ? s.a < t.a : s.b < t.b; };
    const auto all = line_.segments();
    return Index(std::lower_bound(all.begin(), all.end(), wanted, before) - all.begin());
  }

  /// What is on the right of the segment as it runs from u to v: the line's right if it runs that way, its left if the
  /// other.
  unsigned right_of(Index u, Index v) const {
    const Index s = segment(u, v);
    const bool with = u < v ? forward_[s] : backward_[s], against = u < v ? backward_[s] : forward_[s];
    return (with ? right : neither) | (against ? left : neither);
  }

  /// The arc is in a gap between two segments at its vertex, of more than half a turn: what it is to both of them. At a
  /// free end these are the two sides of one segment, so a cap is to neither side.
  unsigned arc_sides(const Zone::Piece& arc) const {
    const Point u = arc.start - arc.center, v = arc.end - arc.center, chord = arc.end - arc.start;
    Point middle{u.x + v.x, u.y + v.y};
    if (dot(u, v) <= 0) middle = {chord.y, -chord.x};  // up to half a turn; the sum may vanish
    const Point at = line_.vertices()[arc.source];
    Index next = arc.source, previous = arc.source;  // counter-clockwise from the middle, and clockwise
    double least = 0, most = 0;
    for (Index i = begin_[arc.source]; i < begin_[arc.source + 1]; ++i) {
      const Point w = line_.vertices()[neighbour_[i]] - at;
      double turn = std::atan2(cross(middle, w), dot(middle, w));
      if (turn < 0) turn += 2 * std::numbers::pi;
      if (next == arc.source || turn < least) next = neighbour_[i], least = turn;
      if (previous == arc.source || turn > most) previous = neighbour_[i], most = turn;
    }
    if (next == arc.source) return neither;
    return right_of(arc.source, next) & right_of(previous, arc.source);
  }

  const Network& line_;
  std::vector<bool> forward_, backward_;  // per segment: the line runs from a to b, from b to a
  std::vector<Index> begin_, neighbour_;
};

/// Even-odd, of all rings of a polygon.
class Inside {
 public:
  explicit Inside(const std::vector<std::vector<Point>>& rings) : tree_(boxes(rings)) {}

  bool operator()(Point p) const {
    bool inside = false;
    tree_.visit_left_of(
        p, [] { return -std::numeric_limits<double>::infinity(); },
        [&](std::size_t i) {
          const auto [low, high] = edges_[i];
          if (low.y <= p.y && p.y < high.y && kernel::orientation(low, high, p) < 0) inside = !inside;
        });
    return inside;
  }

 private:
  std::vector<kernel::Box> boxes(const std::vector<std::vector<Point>>& rings) {
    std::vector<kernel::Box> result;
    for (const auto& ring : rings) {
      for (std::size_t i = 1; i < ring.size(); ++i) {
        const bool up = ring[i - 1].y <= ring[i].y;
        edges_.emplace_back(up ? ring[i - 1] : ring[i], up ? ring[i] : ring[i - 1]);
        result.emplace_back();
        result.back().add(ring[i - 1]);
        result.back().add(ring[i]);
      }
    }
    return result;
  }

  std::vector<std::pair<Point, Point>> edges_;  // the lower end first
  kernel::BoxTree tree_;
};

class Offsetting {
 public:
  Offsetting(const Network& network, double distance, const Context& context)
      : network_(network), distance_(distance), context_(context) {
    quiet_ = context;
    quiet_.progress = nullptr;
  }

  Result<std::vector<OffsetCurve>> run() {
    const Index count = Index(network_.part_count());
    for (Index first = 0, last; first < count; first = last) {
      if (context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
      if (context_.progress) context_.progress(double(first) / count);
      last = first + 1;
      if (network_.part_is_ring(first)) {
        while (last < count && network_.part_is_ring(last) &&
               network_.part_feature(last) == network_.part_feature(first))
          ++last;
      }
      const Status added = network_.part_is_ring(first) ? add_polygon(first, last) : add_line(first);
      if (!added) return added.error();
    }
    return std::move(curves_);
  }

 private:
  std::vector<Point> points(Index part) const {
    std::vector<Point> result;
    const Point o = network_.origin();
    for (Index v : network_.part(part))
      result.push_back({o.x + network_.vertices()[v].x, o.y + network_.vertices()[v].y});
    if (network_.part_is_ring(part) && result.back() != result.front()) result.push_back(result.front());
    return result;
  }

  Result<Zone> zone_of(const std::vector<std::vector<Point>>& lines, Index part) const {
    Network::Builder builder;
    for (const auto& line : lines) builder.add_line(line);
    Result<Network> network = std::move(builder).build(quiet_);
    if (!network) return network.error();
    Result<Zone> zone =
        compute_zone(std::make_shared<const Network>(std::move(*network)), {std::abs(distance_)}, quiet_);
    if (zone) return zone;
    Error error = zone.error();
    if (error.where.empty()) error.where = "feature " + std::to_string(network_.part_feature(part));
    return error;
  }

  void add(OffsetCurve curve, Index part) {
    curve.feature = network_.part_feature(part);
    curve.part = part;
    curves_.push_back(std::move(curve));
  }

  Status add_line(Index part) {
    const std::vector<Point> line = points(part);
    if (std::all_of(line.begin(), line.end(), [&](Point p) { return p == line.front(); })) return std::monostate{};
    Result<Zone> zone = zone_of({line}, part);
    if (!zone) return zone.error();
    const LineSides sides(zone->network());
    const unsigned wanted = distance_ > 0 ? left : right;
    for (Index ring = 0; ring < zone->ring_count(); ++ring) {
      const Index begin = zone->ring_begin(ring), size = zone->ring_begin(ring + 1) - begin;
      std::vector<bool> keep(size);
      for (Index i = 0; i < size; ++i) keep[i] = (sides.sides(zone->piece(begin + i)) & wanted) != 0;
      if (std::find(keep.begin(), keep.end(), false) == keep.end()) {
        add(make_curve(*zone, ring, 0, size, distance_ > 0), part);
        continue;
      }
      for (Index i = 0; i < size; ++i) {
        if (!keep[i] || keep[(i + size - 1) % size]) continue;
        Index count = 1;
        while (keep[(i + count) % size]) ++count;
        add(make_curve(*zone, ring, i, count, distance_ > 0), part);
      }
    }
    return std::monostate{};
  }

  /// No ring of the zone of a polygon's rings crosses the polygon's border, so one point tells whether it is inside.
  Status add_polygon(Index first, Index last) {
    std::vector<std::vector<Point>> rings;
    for (Index part = first; part < last; ++part) rings.push_back(points(part));
    const Point corner = rings.front().front();
    const auto is_corner = [&](Point p) { return p == corner; };
    if (std::all_of(rings.begin(), rings.end(),
                    [&](const auto& r) { return std::all_of(r.begin(), r.end(), is_corner); })) {
      return std::monostate{};
    }
    Result<Zone> zone = zone_of(rings, first);
    if (!zone) return zone.error();
    const Inside inside(rings);
    for (Index ring = 0; ring < zone->ring_count(); ++ring) {
      const Index begin = zone->ring_begin(ring);
      if (inside(zone->piece(begin).start) != (distance_ < 0)) continue;
      add(make_curve(*zone, ring, 0, zone->ring_begin(ring + 1) - begin, distance_ < 0), first);
    }
    return std::monostate{};
  }

  const Network& network_;
  const double distance_;
  const Context& context_;
  Context quiet_;
  std::vector<OffsetCurve> curves_;
};

}  // namespace

Result<std::vector<OffsetCurve>> offset_curves(const Network& network, double distance, const Context& context) {
  if (!std::isfinite(distance) || distance == 0) {
    return Error{ErrorCode::usage, "the distance is zero or not finite", "", "give a number above or below zero"};
  }
  return Offsetting(network, distance, context).run();
}

}  // namespace krepl
