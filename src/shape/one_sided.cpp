// One-sided zones out of the Voronoi diagram: the union of the faces of the wanted sides, each as far as the radius or the join.
#include "shape/one_sided.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"
#include "shape/face_links.hpp"
#include "shape/join_choice.hpp"
#include "voronoi/bisector.hpp"
#include "voronoi/diagram.hpp"
#include "voronoi/site_boxes.hpp"
#include "zone/assembly.hpp"
#include "zone/precision.hpp"
#include "zone/shaped_rings.hpp"

namespace krepl::shape {
namespace {

using voronoi::Diagram;
using zone::Index;
using zone::none;

using vectors::distance;

/// Which elements (sides of segments, and vertices) are on the wanted side of their lines.
std::vector<bool> wanted_elements(const Network& network, const zone::Instance& in, Side side) {
  std::vector<bool> wanted(in.element_count(), false);
  for (Index s = 0; s < network.segments().size(); ++s) {
    // Where several lines run along a segment the first one counts.
    const auto source = network.segment_source(s);
    const bool forward = network.part(source.part)[source.vertex] == network.segments()[s].a;
    // 2s is on the right of the segment from a to b.
    wanted[2 * s + (forward == (side == Side::left) ? 1 : 0)] = true;
  }
  for (Index v = 0; v < network.vertices().size(); ++v) {
    const auto sector = in.sector(v);
    if (sector.before == none || !in.is_side(sector.before)) continue;
    if (!wanted[sector.before] || !wanted[sector.after]) continue;
    const auto before = in.ends(sector.before), after = in.ends(sector.after);
    const auto d = in.difference<double>(before.to, before.from), e = in.difference<double>(after.to, after.from);
    const double turn = std::atan2(d.x * e.y - d.y * e.x, d.x * e.x + d.y * e.y);
    wanted[in.circle(v)] = std::abs(turn) < M_PI - least_bend;  // else all segments leave in one direction: an end
  }
  return wanted;
}

/// What the zone holds of a wanted face: the site itself, pieces of links, and the site's own offset or join between
/// them, counter-clockwise.
struct Item {
  enum class Kind : std::uint8_t { base, link, level };
  Kind kind;
  Index face;
  Index link, piece;  // links: the link, and which piece of all
  Point start, end;   // relative to the network's origin
  Index next;         // around the face
};

class Outline {
 public:
  Outline(const Network& network, const Diagram& diagram, const zone::Instance& instance,
          const ShapeOptions& options, double max_error)
      : network_(network),
        d_(diagram),
        in_(instance),
        max_error_(max_error),
        wanted_(wanted_elements(network, instance, options.side)),
        links_(diagram, instance, wanted_, options),
        item_of_(links_.pieces().size(), none) {
    for (Index f = 0; f < d_.face_count(); ++f)
      if (wanted_[f]) add_face(f);
  }

  /// Walks along what has no wanted face on its other side.
  Result<zone::ShapedRings> rings() const {
    zone::ShapedRings rings;
    rings.touch = true;  // where lines cross
    std::vector<bool> done(items_.size(), false);
    for (Index first = 0; first < items_.size(); ++first) {
      if (done[first] || is_inside(first)) continue;
      for (Index i = first; !done[i];) {
        done[i] = true;
        append(items_[i], rings.piece);
        i = items_[i].next;
        for (std::size_t turns = 0; is_inside(i); ++turns) {
          if (d_.twin[items_[i].link] == none || turns > items_.size()) return unsound(items_[i].start);
          const Index other = item_of_[links_.twin(items_[i].link, items_[i].piece)];
          if (other == none) return unsound(items_[i].start);
          i = items_[other].next;
        }
      }
      rings.close();
    }
    return rings;
  }

 private:
  Error unsound(Point at) const {
    return {ErrorCode::computation, "the Voronoi diagram is not sound at this radius",
            "near x " + std::to_string(at.x) + ", y " + std::to_string(at.y) + " relative to the data's origin",
            "please report this input"};
  }
  bool is_inside(Index i) const {
    const Item& item = items_[i];
    return item.kind == Item::Kind::link && links_.pieces()[item.piece].held_beyond;
  }
  Point site_start(Index face) const {
    return in_.vertices()[in_.is_side(face) ? in_.ends(face).from : in_.vertex_of(face)];
  }

  /// Segments that cross the site divide its face into parts that meet in the crossings only.
  void add_face(Index f) {
    Index first = d_.begin[f];
    Point start = site_start(f);
    for (Index i = d_.begin[f]; i < d_.begin[f + 1]; ++i) {
      if (d_.clearance[d_.vertex[i]] != 0) continue;
      const bool last = i + 1 == d_.begin[f + 1];
      // The ends of the site are its vertices as they were given.
      const Point end =
          !last ? d_.place[d_.vertex[i]] : in_.vertices()[in_.is_side(f) ? in_.ends(f).to : in_.vertex_of(f)];
      add_part(f, first, i + 1, start, end);
      first = i + 1;
      start = end;
    }
  }

  void add_part(Index f, Index first, Index last, Point start, Point end) {
    const std::size_t begin = items_.size();
    Point at = start;
    bool outside = false;
    for (Index i = first; i < last; ++i) {
      for (Index k = links_.begin(i); k < links_.begin(i + 1); ++k) {
        const auto& piece = links_.pieces()[k];
        if (!piece.held) {
          outside = true;
          continue;
        }
        if (outside) {
          items_.push_back({Item::Kind::level, f, none, none, at, piece.start, none});
          at = piece.start;
          outside = false;
        }
        const Point to = i + 1 == last && k + 1 == links_.begin(i + 1) ? end : piece.end;
        item_of_[k] = Index(items_.size());
        items_.push_back({Item::Kind::link, f, i, k, at, to, none});
        at = to;
      }
    }
    if (in_.is_side(f)) items_.push_back({Item::Kind::base, f, none, none, end, start, none});
    for (std::size_t i = begin; i < items_.size(); ++i) items_[i].next = Index(i + 1 < items_.size() ? i + 1 : begin);
  }

  void append(const Item& item, std::vector<Zone::Piece>& out) const {
    Zone::Piece p{Zone::Kind::segment, item.start, item.end, {}, item.face >> 1, false};
    if (!in_.is_side(item.face)) {
      p.source = in_.vertex_of(item.face);
      p.from_vertex = true;
    }
    if (item.kind == Item::Kind::level) {
      if (const BendRegion* bend = links_.region(item.face)) return append_join(*bend, item, p, out);
      p.reversed = !p.from_vertex && (item.face & 1u) != 0;
      if (p.from_vertex) {
        p.kind = Zone::Kind::arc;
        p.center = in_.vertices()[p.source];
      }
    } else if (item.kind == Item::Kind::base) {
      p.role = Zone::Role::input;
      p.reversed = (item.face & 1u) == 0;  // against its side
    } else {
      return append_link(item, p, out);
    }
    out.push_back(p);
  }

  /// Mitres are made of the offsets of the two sides.
  static void append_join(const BendRegion& bend, const Item& item, Zone::Piece p, std::vector<Zone::Piece>& out) {
    for (const auto& s : bend.stretches(item.start, item.end)) {
      p.start = s.start, p.end = s.end;
      p.role = Zone::Role::bevel;
      if (s.border.side != none) {
        p.role = Zone::Role::offset;
        p.source = s.border.side >> 1;
        p.from_vertex = false;
        p.reversed = (s.border.side & 1u) != 0;
      }
      out.push_back(p);
    }
  }

  void append_link(const Item& item, Zone::Piece p, std::vector<Zone::Piece>& out) const {
    const Index other = d_.label[item.link];
    const bool mixed = in_.is_side(item.face) != in_.is_side(other);
    const Index side = in_.is_side(item.face) ? item.face : other, circle = in_.is_side(item.face) ? other : item.face;
    if (links_.is_perpendicular(item.face, item.link)) {  // across the end of a line
      p.role = Zone::Role::end;
      p.source = in_.vertex_of(circle);
      p.from_vertex = true;
      out.push_back(p);
      return;
    }
    p.role = Zone::Role::between;
    if (!mixed) {
      out.push_back(p);
      return;
    }
    VoronoiDiagram::Edge edge{};
    edge.left = {false, side >> 1, side & 1u};
    edge.right = {true, in_.vertex_of(circle), 0};
    edge.parabolic = true;
    const voronoi::Bisector bisector(network_, edge, item.start, item.end);
    const std::vector<Point> points = bisector.points(max_error_, INFINITY);
    if (points.size() < 2) return out.push_back(p);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      p.start = i == 0 ? item.start : points[i];
      p.end = i + 2 == points.size() ? item.end : points[i + 1];
      out.push_back(p);
    }
  }

  const Network& network_;
  const Diagram& d_;
  const zone::Instance& in_;
  double max_error_;
  std::vector<bool> wanted_;
  FaceLinks links_;
  std::vector<Index> item_of_;  // of pieces of links
  std::vector<Item> items_;
};

/// A mitre goes on along the offset of a side.
bool is_same_offset(const Zone::Piece& a, const Zone::Piece& b) {
  const auto is_offset = [](const Zone::Piece& p) {
    return p.kind == Zone::Kind::segment && p.role == Zone::Role::offset;
  };
  return is_offset(a) && is_offset(b) && a.source == b.source && a.reversed == b.reversed;
}

/// Drops pieces that are too short to be told, then rings that enclose nothing.
zone::ShapedRings cleaned(const zone::ShapedRings& rings, double resolution, double radius, ZoneCounters& counters) {
  zone::ShapedRings out;
  out.touch = rings.touch;
  for (Index r = 0; r < rings.ring_count(); ++r) {
    std::vector<Zone::Piece> kept;
    for (Index e = rings.begin[r]; e < rings.begin[r + 1]; ++e) {
      Zone::Piece p = rings.piece[e];
      if (!kept.empty()) p.start = kept.back().end;
      if (distance(p.start, p.end) <= resolution) {
        ++counters.collapsed_pieces;
        if (!kept.empty()) kept.back().end = p.end;
        continue;
      }
      if (!kept.empty() && is_same_offset(kept.back(), p)) {
        kept.back().end = p.end;
        continue;
      }
      kept.push_back(p);
    }
    if (kept.size() > 2 && is_same_offset(kept.back(), kept.front())) {
      kept.front().start = kept.back().start;
      kept.pop_back();
    }
    if (kept.size() > 1) kept.front().start = kept.back().end;
    double twice = 0, perimeter = 0;
    for (const Zone::Piece& p : kept) {
      const Point o = kept.front().start;
      twice += (p.start.x - o.x) * (p.end.y - o.y) - (p.start.y - o.y) * (p.end.x - o.x);
      perimeter += distance(p.start, p.end);
      if (p.kind != Zone::Kind::arc) continue;
      const Point u{p.start.x - p.center.x, p.start.y - p.center.y}, v{p.end.x - p.center.x, p.end.y - p.center.y};
      const double angle = std::atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y);
      twice += radius * radius * (angle - std::sin(angle));
    }
    if (kept.size() < 2 || std::abs(twice) <= resolution * perimeter) {
      ++counters.dropped_rings;
      continue;
    }
    out.piece.insert(out.piece.end(), kept.begin(), kept.end());
    out.close();
  }
  return out;
}

}  // namespace

Result<Zone> one_sided(std::shared_ptr<const Network> network, const ShapeOptions& options, const Context& context) {
  const double radius = options.distance;
  const auto precision = zone::precision_for(*network, radius);
  if (!precision) return precision.error();
  if (network->segments().empty()) return ZoneAssembly::finish(network, radius, {}, 0, {}, context);
  const double farthest = options.join == Join::mitre ? options.mitre_limit * radius : radius;
  if (farthest >= voronoi::horizon_in_extents * network->extent())
    return Error{ErrorCode::usage, "the zone reaches beyond 2^20 extents of the lines", "",
                 "give a smaller radius or mitre limit"};
  const zone::Instance shape(*network, 0, 0, 1, context);
  const voronoi::Sites sites(shape, context);
  const voronoi::SiteBoxes boxes(shape, context);
  const auto diagram = voronoi::build_diagram(sites, boxes, 0, context);
  if (!diagram) return diagram.error();
  const zone::Instance instance(shape, radius, precision->effective_radius, precision->resolution);
  const double max_error = options.max_error > 0 ? options.max_error : radius * 1e-6;
  const Outline outline(*network, *diagram, instance, options, max_error);
  auto rings = outline.rings();
  if (!rings) return rings.error();
  ZoneCounters counters;
  zone::ShapedRings clean = cleaned(*rings, precision->resolution, radius, counters);
  return ZoneAssembly::finish(std::move(network), radius, std::move(clean), 2 * instance.enlargement(), counters,
                              context);
}

}  // namespace krepl::shape
