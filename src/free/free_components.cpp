#include "krepl/free_components.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "free/tolerance.hpp"
#include "kernel/box_tree.hpp"
#include "kernel/packed_tree.hpp"

namespace krepl {

using kernel::Box;

namespace {

constexpr std::size_t chunk = 8;  // consecutive pieces under one box

struct Vec {
  double x, y;
};
Vec operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
double cross(Vec a, Vec b) { return a.x * b.y - a.y * b.x; }
double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

double to_segment(Point p, Point a, Point b) {
  const Vec d = b - a, e = p - a;
  const double whole = d.x * d.x + d.y * d.y, t = e.x * d.x + e.y * d.y;
  if (!(t > 0)) return distance(p, a);
  return t >= whole ? distance(p, b) : std::abs(cross(d, e)) / std::sqrt(whole);
}

/// Counter-clockwise from start to end; a full circle if they are equal.
double to_arc(Point p, const Zone::Piece& arc) {
  const Vec u = arc.start - arc.center, v = arc.end - arc.center, d = p - arc.center;
  const bool small = cross(u, v) > 0 || (cross(u, v) == 0 && u.x * v.x + u.y * v.y > 0);
  const bool beside = arc.start == arc.end || (small ? cross(u, d) >= 0 && cross(d, v) >= 0
                                                     : !(cross(v, d) > 0 && cross(d, u) > 0));
  if (beside) return std::abs(std::hypot(d.x, d.y) - arc.radius);
  return std::min(distance(p, arc.start), distance(p, arc.end));
}

/// As far from a box as from its nearest point.
double to_box(Point p, const Box& b) {
  return std::hypot(p.x - std::clamp(p.x, b.min_x, b.max_x), p.y - std::clamp(p.y, b.min_y, b.max_y));
}

}  // namespace

struct FreeComponents::State {
  DiskFreeSpace space;
  Zone zone;
  std::vector<std::uint32_t> component_of_face;
  kernel::PackedTree<Box> tree;  // over chunks of the zone's pieces

  State(DiskFreeSpace s, Zone z) : space(std::move(s)), zone(std::move(z)), tree(boxes(zone)) {
    component_of_face.assign(zone.subdivision().face_count(), none);
    component_of_face[0] = 0;
    std::uint32_t next = 1;
    for (std::uint32_t ring = 0; ring < zone.ring_count(); ++ring)
      if (zone.ring_is_hole(ring)) component_of_face[zone.subdivision().face[free_side(zone.ring_begin(ring))]] = next++;
  }

  /// The half-edge of a piece that has free space on its left.
  static std::uint32_t free_side(std::uint32_t piece) { return 2 * piece + 1; }

  static std::vector<Box> boxes(const Zone& zone) {
    std::vector<Box> boxes((zone.piece_count() + chunk - 1) / chunk);
    for (std::uint32_t e = 0; e < zone.piece_count(); ++e) {
      const Zone::Piece piece = zone.piece(e);
      Box& box = boxes[e / chunk];
      box.add(piece.start), box.add(piece.end);
      if (piece.kind == Zone::Kind::segment) continue;
      // All of the circle is more than the arc needs, and what bounds distances from below.
      box.add(Point{piece.center.x - piece.radius, piece.center.y - piece.radius});
      box.add(Point{piece.center.x + piece.radius, piece.center.y + piece.radius});
    }
    return boxes;
  }

  /// The straight way from a free place to the nearest point of the zone meets nothing: so that point borders the face.
  std::uint32_t at(Point place) const {
    if (!std::isfinite(place.x) || !std::isfinite(place.y) || !space.is_free(place)) return none;
    std::uint32_t nearest = none;
    double limit = std::numeric_limits<double>::infinity();
    tree.nearest(
        limit, [&](const Box& b) { return to_box(place, b); },
        [&](std::size_t c) {
          for (std::uint32_t e = std::uint32_t(c * chunk); e < std::min(zone.piece_count(), (c + 1) * chunk); ++e) {
            const Zone::Piece piece = zone.piece(e);
            const double d =
                piece.kind == Zone::Kind::segment ? to_segment(place, piece.start, piece.end) : to_arc(place, piece);
            if (d < limit) limit = d, nearest = e;
          }
        });
    return nearest == none ? 0 : component_of_face[zone.subdivision().face[free_side(nearest)]];
  }
};

Result<FreeComponents> FreeComponents::build(std::shared_ptr<const Network> network, double radius, const Context& context) {
  Result<DiskFreeSpace> space = DiskFreeSpace::build(network, radius, context);
  if (!space) return space.error();
  // Closed free space: the same as compute_route has.
  const double slack = std::max(0x1p-44 * std::max(network->extent(), radius), 16 * network->resolution());
  if (radius < 4 * slack)
    return Error{ErrorCode::usage, "the radius is finer than the resolution of the coordinates", "", "use a larger radius"};
  Result<Zone> zone = compute_zone(std::move(network), {radius - slack}, context);
  if (!zone) return zone.error();
  return FreeComponents(std::make_shared<const State>(std::move(*space), std::move(*zone)));
}

std::size_t FreeComponents::count() const { return 1 + state_->zone.hole_count(); }
std::uint32_t FreeComponents::at(Point place) const { return state_->at(place); }
const DiskFreeSpace& FreeComponents::space() const { return state_->space; }
const Zone& FreeComponents::zone() const { return state_->zone; }

Status FreeComponents::at(std::span<const Point> places, std::span<std::uint32_t> components, const Context& context) const {
  return free::for_each_place(places.size(), components.size(), context,
                              [&](std::size_t i) { components[i] = state_->at(places[i]); });
}

}  // namespace krepl
