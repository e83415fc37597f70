#include "krepl/zone.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"
#include "krepl/curve_network.hpp"
#include "zone/arc_turn.hpp"
#include "zone/varied_sites.hpp"

namespace krepl {
namespace {

using vectors::distance;

/// Counter-clockwise angle from p to q about c, in (0, 2 pi]; equal points mean the full circle.
double sweep_angle(Point c, Point p, Point q) {
  const double ux = p.x - c.x, uy = p.y - c.y, vx = q.x - c.x, vy = q.y - c.y;
  const double angle = std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
  return angle > 0 ? angle : angle + 2 * M_PI;
}

/// The angle that an arc spans, positive if it runs counter-clockwise.
double signed_angle(const Zone::Piece& arc) {
  if (arc.from_arc) return (arc.clockwise ? -1 : 1) * zone::arc_turn(arc);
  return arc.clockwise ? -sweep_angle(arc.center, arc.end, arc.start) : sweep_angle(arc.center, arc.start, arc.end);
}

}  // namespace

double Zone::scale() const { return std::max(radius_, curves_ ? curves_->extent() : network_->extent()); }

Zone::Piece Zone::local_piece(std::uint32_t e) const {
  if (!shaped_.empty()) return shaped_[e];
  const auto ring = std::upper_bound(ring_begin_.begin(), ring_begin_.end(), e);
  const std::uint32_t next = e + 1 < *ring ? e + 1 : *(ring - 1);
  Piece p{Kind::segment, vertex_[e], vertex_[next], {}, 0, false, radius_};
  const std::size_t sides = 2 * network_->segments().size();
  if (element_[e] < sides) {
    p.source = element_[e] / 2;
    p.reversed = element_[e] % 2 != 0;
    if (varied_) p.radius = varied_->radius[varied_->segments[p.source].a];
  } else {
    p.kind = Kind::arc;
    p.source = std::uint32_t(element_[e] - sides);
    p.from_vertex = true;
    if (varied_) {
      p.radius = varied_->radius[p.source];
      p.source = varied_->vertex[p.source];
    }
    p.center = network_->vertices()[p.source];
  }
  return p;
}

Zone::Piece Zone::piece(std::uint32_t e) const {
  Piece p = local_piece(e);
  const Point o = network_->origin();
  for (Point* q : {&p.start, &p.end, &p.center}) *q = {q->x + o.x, q->y + o.y};
  if (p.kind == Kind::segment) p.center = {};
  return p;
}

std::size_t Zone::hole_count() const {
  return std::size_t(std::count(ring_is_hole_.begin(), ring_is_hole_.end(), true));
}

Zone::Polygon Zone::polygon(std::uint32_t p) const {
  return {polygon_outer_[p],
          {polygon_hole_.data() + polygon_hole_begin_[p], polygon_hole_begin_[p + 1] - polygon_hole_begin_[p]}};
}

double Zone::ring_area(std::uint32_t r) const {
  const std::uint32_t first = ring_begin_[r], last = ring_begin_[r + 1];
  const Point o = vertex_[first];
  double twice = 0;
  for (std::uint32_t e = first; e < last; ++e) {
    const Piece p = local_piece(e);
    twice += (p.start.x - o.x) * (p.end.y - o.y) - (p.start.y - o.y) * (p.end.x - o.x);
    if (p.kind == Kind::arc) {
      if (p.from_arc) {
        twice += zone::twice_bulge(p);
        continue;
      }
      const double angle = signed_angle(p);
      twice += p.radius * p.radius * (angle - std::sin(angle));
    }
  }
  return twice / 2;
}

double Zone::area() const {
  double sum = 0;
  for (std::uint32_t r = 0; r < ring_count(); ++r) sum += ring_area(r);
  return sum;
}

double Zone::perimeter() const {
  double sum = 0;
  for (std::uint32_t e = 0; e < piece_count(); ++e) {
    const Piece p = local_piece(e);
    sum += p.kind == Kind::arc ? p.radius * std::abs(signed_angle(p)) : distance(p.start, p.end);
  }
  return sum;
}

std::optional<std::string> Zone::validate() const {
  if (auto wrong = subdivision_.validate()) return wrong;
  // Where the coordinates themselves are coarser than the contract, they set the measure.
  const double tolerance = std::max(1e-9 * scale(), 16 * network_->resolution());
  for (std::uint32_t e = 0; e < piece_count(); ++e) {
    const Piece p = local_piece(e);
    const auto complain = [&](const char* what) {
      return std::string(what) + " at piece " + std::to_string(e) + ", near x " +
             std::to_string(p.start.x + network_->origin().x) + ", y " +
             std::to_string(p.start.y + network_->origin().y);
    };
    if (!std::isfinite(p.start.x) || !std::isfinite(p.start.y)) return complain("a vertex is not finite");
    if (p.kind == Kind::arc) {
      const double rounding = p.from_arc ? 0x1p-50 * p.radius : 0;  // of a centre far away
      for (const Point q : {p.start, p.end}) {
        if (!(std::abs(distance(q, p.center) - p.radius) <= tolerance + rounding)) return complain("an arc misses its radius");
      }
      continue;
    }
    if (p.role != Role::offset || p.from_vertex || p.from_arc) continue;
    // Both ends of a segment are on the offset line of its source, and it runs with it.
    const auto s = network_->segments()[p.source];
    Point a = network_->vertices()[s.a], b = network_->vertices()[s.b];
    if (p.reversed) std::swap(a, b);
    const double length = distance(a, b), ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
    for (const Point q : {p.start, p.end}) {
      const double off = (q.x - a.x) * uy - (q.y - a.y) * ux;
      // Where a polygon was shrunk, and along the inner border of a band, the zone is on the other side.
      const double out = inward_ ? std::abs(off) : is_inner(e) ? -off : off;
      if (!(std::abs(out - p.radius) <= tolerance)) return complain("a segment is off its offset line");
    }
    if ((p.end.x - p.start.x) * ux + (p.end.y - p.start.y) * uy < -tolerance) return complain("a segment runs backwards");
  }
  for (std::uint32_t r = 0; r < ring_count(); ++r) {
    if ((ring_area(r) < 0) != ring_is_hole_[r]) return "ring " + std::to_string(r) + " runs the wrong way round";
  }
  return std::nullopt;
}

}  // namespace krepl
