#include "voronoi/owner_zones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kernel/parallel.hpp"
#include "voronoi/bisector.hpp"
#include "voronoi/owner_nesting.hpp"
#include "zone/crossing.hpp"

namespace krepl::voronoi {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Walks along the borders of shares: borders of lobes between two owners, and stretches of the zone's boundary, which
/// are numbered behind them. The share is on the left.
class Walk {
 public:
  Walk(const Diagram& d, const Instance& in, const OwnerLobes& lobes, std::vector<Entry> entries)
      : d_(d), in_(in), lobes_(lobes), entries_(std::move(entries)), arc_of_link_(d.link_count(), none) {
    for (Index k = 0; k < entries_.size(); ++k) {
      if (entries_[k].link != none) arc_of_link_[entries_[k].link] = k;
    }
  }

  Index step_count() const { return lobes_.border_count() + Index(entries_.size()); }
  bool is_arc(Index step) const { return step >= lobes_.border_count(); }
  const Entry& entry(Index step) const { return entries_[step - lobes_.border_count()]; }
  Index lobe(Index step) const {
    if (!is_arc(step)) return lobes_.lobe(step);
    return entry(step).link == none ? lobes_.only_lobe(entry(step).face) : lobes_.lobe(entry(step).link);
  }

  bool is_bounded(Index lobe) const { return !lobes_.in_polygon(lobe); }
  /// True for what is border of a share.
  bool counts(Index step) const {
    if (is_arc(step)) return is_bounded(lobe(step));
    if (!lobes_.parts_owners(step)) return false;
    return lobes_.is_base(step) || !is_bounded(lobe(step)) || d_.minimum[step] <= in_.radius();
  }
  bool ends_outside(Index link) const {
    return is_bounded(lobes_.lobe(link)) && d_.clearance[d_.vertex[link]] > in_.radius();
  }
  bool starts_outside(Index link) const {
    return is_bounded(lobes_.lobe(link)) && d_.clearance[d_.vertex[d_.twin[link]]] > in_.radius();
  }

  /// The step that continues the border of the same share; none if there is none.
  Index following(Index step) const {
    if (is_arc(step)) {
      const Index exit = entry(step).exit;
      if (entry(step).link == none) return step;
      if (exit == none || d_.twin[exit] == none) return none;
      return lobes_.parts_owners(exit) ? exit : arc_at(d_.twin[exit]);
    }
    if (!lobes_.is_base(step) && ends_outside(step)) return arc_at(step);
    Index s = lobes_.next(step);
    for (Index turns = 0; !lobes_.parts_owners(s); ++turns) {
      if (lobes_.twin(s) == none || turns > d_.link_count()) return none;
      s = lobes_.next(lobes_.twin(s));
    }
    return s;
  }

 private:
  Index arc_at(Index link) const {
    return arc_of_link_[link] == none ? none : lobes_.border_count() + arc_of_link_[link];
  }

  const Diagram& d_;
  const Instance& in_;
  const OwnerLobes& lobes_;
  std::vector<Entry> entries_;
  std::vector<Index> arc_of_link_;
};

/// Steps as curves with coordinates.
class Drawing {
 public:
  Drawing(const Network& network, const Diagram& d, const Instance& in, const OwnerLobes& lobes, const Walk& walk,
          double max_error)
      : network_(network), d_(d), in_(in), lobes_(lobes), walk_(walk), max_error_(max_error) {}

  /// Relative to the network's origin. `deviation` grows to that of the chords.
  OwnerZone::Curve curve(Index step, double& deviation) const {
    if (walk_.is_arc(step)) return arc(walk_.entry(step));
    if (!lobes_.is_base(step)) return link(step, deviation);
    const Index l = lobes_.lobe(step);
    return {OwnerZone::Kind::segment, {d_.place[d_.vertex[lobes_.last(l)]], d_.place[d_.vertex[d_.twin[lobes_.first(l)]]]}, {}};
  }

 private:
  OwnerZone::Curve arc(const Entry& e) const {
    const Index from = e.link == none ? e.face : d_.label[e.link], to = e.link == none ? e.face : d_.label[e.exit];
    const Point start = zone::crossing(in_, from, e.face), end = zone::crossing(in_, e.face, to);
    if (in_.is_side(e.face)) return {OwnerZone::Kind::segment, {start, end}, {}};
    const Point c = in_.vertices()[in_.vertex_of(e.face)];
    if (e.link == none) return {OwnerZone::Kind::arc, {start, start}, c};
    // Ends that are nearly the same point: as good as straight (1e-12 R, and coordinates may not tell them apart), or,
    // only about an isolated vertex, nearly all of the circle.
    const double turn = (start.x - c.x) * (end.y - c.y) - (start.y - c.y) * (end.x - c.x);
    const bool near = std::abs(start.x - end.x) + std::abs(start.y - end.y) < 2e-6 * in_.radius();
    if (!near) return {OwnerZone::Kind::arc, {start, end}, c};
    const bool is_long = in_.sector(in_.vertex_of(e.face)).before == e.face && zone::is_long_arc(in_, from, e.face, to);
    if (is_long) return {OwnerZone::Kind::arc, {start, turn < 0 ? end : start}, c};
    return {OwnerZone::Kind::segment, {start, end}, {}};
  }

  VoronoiDiagram::Site site(Index element) const {
    if (in_.is_side(element)) return {false, element >> 1, element & 1u};
    return {true, in_.vertex_of(element), 0};
  }

  /// Both sides draw the link in the sense of the lower face, so that they have the same points.
  OwnerZone::Curve link(Index i, double& deviation) const {
    const Index f = lobes_.face(lobes_.lobe(i)), other = d_.label[i];
    const Index low = std::min(f, other), high = std::max(f, other);
    Point start = walk_.starts_outside(i) ? zone::crossing(in_, f, other) : d_.place[d_.vertex[d_.twin[i]]];
    Point end = walk_.ends_outside(i) ? zone::crossing(in_, other, f) : d_.place[d_.vertex[i]];
    const bool turned = f != low;
    if (turned) std::swap(start, end);
    bool own = false;
    const bool mixed = in_.is_side(low) != in_.is_side(high);
    if (mixed) {
      const auto e = in_.ends(low);  // sides have the lower numbers
      own = e.from == in_.vertex_of(high) || e.to == in_.vertex_of(high);
    }
    OwnerZone::Curve curve{OwnerZone::Kind::segment, {start, end}, {}};
    if (mixed && !own && !(start == end)) {
      VoronoiDiagram::Edge edge{site(low), site(high), start, end, 0, 0, 0, true, false};
      const Bisector bisector(network_, edge, start, end);
      std::vector<Point> points = bisector.points(max_error_, infinity);
      if (points.size() > 2) curve.kind = OwnerZone::Kind::bisector, curve.points = std::move(points);
      deviation = std::max(deviation, bisector.chord_error(curve.points.size() - 1));
    }
    if (turned) std::reverse(curve.points.begin(), curve.points.end());
    return curve;
  }

  const Network& network_;
  const Diagram& d_;
  const Instance& in_;
  const OwnerLobes& lobes_;
  const Walk& walk_;
  double max_error_;
};

Error broken(const Diagram& d, const OwnerLobes& lobes, const Walk& walk, Index step) {
  Point p{};
  if (!walk.is_arc(step) && lobes.last(lobes.lobe(step)) != none) p = d.place[d.vertex[lobes.last(lobes.lobe(step))]];
  return {ErrorCode::computation, "the border between two owners does not close",
          "near x " + std::to_string(p.x) + ", y " + std::to_string(p.y) + " relative to the data's origin",
          "please report this input"};
}

/// Steps ring by ring: those of ring r are begin[r] .. begin[r+1).
struct Tour {
  std::vector<Index> steps, begin{0};
};

Result<Tour> walk_all(const Diagram& d, const OwnerLobes& lobes, const Walk& walk) {
  Tour tour;
  std::vector<bool> done(walk.step_count(), false);
  for (Index first = 0; first < walk.step_count(); ++first) {
    if (done[first] || !walk.counts(first)) continue;
    for (Index s = first; !done[s];) {
      done[s] = true;
      tour.steps.push_back(s);
      const Index n = walk.following(s);
      if (n == none || !walk.counts(n) || (done[n] && n != first)) return broken(d, lobes, walk, s);
      s = n;
    }
    tour.begin.push_back(Index(tour.steps.size()));
  }
  return tour;
}

}  // namespace

Result<std::vector<OwnerZone>> owner_zones(const Network& network, const Diagram& d, const Instance& in,
                                           const OwnerLobes& lobes, const OwnerRequest& request, const Context& context) {
  const Walk walk(d, in, lobes, find_entries(d, in, context));
  auto tour = walk_all(d, lobes, walk);
  if (!tour) return tour.error();
  const Drawing drawing(network, d, in, lobes, walk, request.max_error);
  const std::size_t count = tour->begin.size() - 1;
  struct Drawn {
    std::vector<OwnerZone::Ring> rings;
    double deviation = 0;
  };
  std::vector<Drawn> drawn(count);
  Context quiet;
  quiet.threads = context.threads, quiet.cancel = context.cancel;
  kernel::parallel_blocks(quiet, count, 16, [&](std::size_t from, std::size_t to) {
    for (std::size_t r = from; r < to; ++r) {
      std::vector<OwnerZone::Curve> curves;
      for (Index k = tour->begin[r]; k < tour->begin[r + 1]; ++k) {
        curves.push_back(drawing.curve(tour->steps[k], drawn[r].deviation));
        const auto& points = curves.back().points;
        const bool nothing = points.size() == 2 && points[0] == points[1];
        if (nothing && curves.back().kind != OwnerZone::Kind::arc) curves.pop_back();
      }
      drawn[r].rings = split_at_pinches(std::move(curves));
      for (OwnerZone::Ring& ring : drawn[r].rings) measure(ring, in.nominal_radius());
    }
  });
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};

  std::map<Index, OwnerZone> zones;
  std::map<Index, std::vector<OwnerZone::Ring>> rings;
  for (std::size_t r = 0; r < count; ++r) {
    const Index owner = lobes.owner(walk.lobe(tour->steps[tour->begin[r]]));
    for (OwnerZone::Ring& ring : drawn[r].rings) {
      if (ring.curves.empty() || std::abs(ring.area) <= request.resolution * ring.length) continue;
      OwnerZone& zone = zones[owner];
      zone.owner = owner;
      zone.area += ring.area, zone.perimeter += ring.length;
      zone.deviation = std::max(zone.deviation, drawn[r].deviation);
      rings[owner].push_back(std::move(ring));
    }
  }
  std::vector<OwnerZone> all;
  for (auto& [owner, zone] : zones) {
    if (Status nested = nest_rings(std::move(rings[owner]), network.origin(), zone.polygons); !nested) return nested.error();
    all.push_back(std::move(zone));
  }
  return all;
}

}  // namespace krepl::voronoi
