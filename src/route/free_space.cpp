#include "route/free_space.hpp"

namespace krepl::route {
namespace {

/// Whether the ray from p towards smaller x crosses a piece an odd number of times. Both halves of an arc are functions
/// of y, and ends count if they are the lower one.
struct LeftRay {
  Point p;
  bool odd = false;

  void cross_segment(Point a, Point b) {
    if ((a.y > p.y) == (b.y > p.y)) return;
    if ((b.y > a.y) == (cross(b - a, p - a) < 0)) odd = !odd;
  }

  /// A half of a circle between two heights; `eastern`: the half with larger x.
  void cross_half(Point center, double radius, double y0, double y1, bool eastern) {
    if ((y0 > p.y) == (y1 > p.y)) return;
    const double away = distance(p, center);
    const bool beyond = eastern ? p.x > center.x && away > radius : p.x > center.x || away < radius;
    if (beyond) odd = !odd;
  }

  /// Counter-clockwise: the eastern half rises, the western one falls.
  void cross_arc(Point start, Point end, Point center, double radius) {
    const double from = positive_angle(std::atan2(start.y - center.y, start.x - center.x) + turn / 4);
    double span = positive_angle(positive_angle(std::atan2(end.y - center.y, end.x - center.x) + turn / 4) - from);
    if (start == end) span = turn;
    double y = start.y;
    const double until = from + span;
    // From the south point, angles below half a turn are east.
    for (int half = int(from / (turn / 2));; ++half) {
      const double next = (half + 1) * (turn / 2);
      const bool eastern = half % 2 == 0;
      const double y_next = next >= until ? end.y : center.y + (eastern ? radius : -radius);
      cross_half(center, radius, y, y_next, eastern);
      if (next >= until) return;
      y = y_next;
    }
  }
};

}  // namespace

Slack slack_for(const Network& network, double radius) {
  const double scale = std::max(network.extent(), radius);
  const double shrink = std::max(0x1p-44 * scale, 16 * network.resolution());
  return {shrink, 4 * shrink};
}

Result<FreeSpace> FreeSpace::build(std::shared_ptr<const Network> network, double radius, const Context& context) {
  const double shrink = slack_for(*network, radius).shrink;
  if (radius < 4 * shrink)
    return Error{ErrorCode::usage, "the radius is finer than the resolution of the coordinates", "",
                 "use a larger radius"};
  Result<Zone> zone = compute_zone(std::move(network), {radius - shrink}, context);
  if (!zone) return zone.error();
  FreeSpace space(std::move(*zone));
  space.collect_arcs();
  return space;
}

void FreeSpace::collect_arcs() {
  const Point origin = zone_.network().origin();
  for (std::uint32_t e = 0; e < zone_.piece_count(); ++e) {
    const Zone::Piece piece = zone_.piece(e);
    if (piece.kind != Zone::Kind::arc) continue;
    const Point center = zone_.network().vertices()[piece.source];
    const Point start = piece.start - origin - center, end = piece.end - origin - center;
    const double from = std::atan2(start.y, start.x);
    const bool full = piece.start == piece.end;
    arcs_.push_back({center, from, full ? turn : positive_angle(std::atan2(end.y, end.x) - from), full, piece.source});
  }
}

std::optional<std::uint32_t> FreeSpace::pocket(Point local) const {
  const Point origin = zone_.network().origin(), p = local + origin;
  std::optional<std::uint32_t> found;
  double smallest = 0;
  for (std::uint32_t ring = 0; ring < zone_.ring_count(); ++ring) {
    if (!zone_.ring_is_hole(ring)) continue;
    LeftRay ray{p};
    Box box;
    for (std::uint32_t e = zone_.ring_begin(ring); e < zone_.ring_begin(ring + 1); ++e) {
      const Zone::Piece piece = zone_.piece(e);
      box.add(piece.start), box.add(piece.end);
      if (piece.kind == Zone::Kind::segment)
        ray.cross_segment(piece.start, piece.end);
      else
        ray.cross_arc(piece.start, piece.end, piece.center, zone_.radius());
    }
    // Holes around one place lie in one another: the smallest one is the innermost.
    const double size = (box.max_x - box.min_x) + (box.max_y - box.min_y);
    if (ray.odd && (!found || size < smallest)) found = ring, smallest = size;
  }
  return found;
}

}  // namespace krepl::route
