#include "voronoi/owner_nesting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kernel/box_tree.hpp"
#include "kernel/vectors.hpp"

namespace krepl::voronoi {
namespace {

using Curve = OwnerZone::Curve;
using Kind = OwnerZone::Kind;

using vectors::cross;
using vectors::distance;

/// Counter-clockwise angle of an arc, in (0, 2 pi].
double sweep(const Curve& arc) {
  const Point c = arc.center, p = arc.points.front(), q = arc.points.back();
  if (p == q) return 2 * M_PI;
  const double ux = p.x - c.x, uy = p.y - c.y, vx = q.x - c.x, vy = q.y - c.y;
  const double angle = std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
  return angle > 0 ? angle : angle + 2 * M_PI;
}

Point middle(const Curve& curve) {
  if (curve.kind != Kind::arc) {
    const std::size_t k = curve.points.size() / 2;
    const Point p = curve.points[k - 1], q = curve.points[k];
    return {(p.x + q.x) / 2, (p.y + q.y) / 2};
  }
  const double half = sweep(curve) / 2, c = std::cos(half), s = std::sin(half);
  const double x = curve.points.front().x - curve.center.x, y = curve.points.front().y - curve.center.y;
  return {curve.center.x + c * x - s * y, curve.center.y + s * x + c * y};
}

double length(const Curve& curve) {
  if (curve.kind == Kind::arc) return sweep(curve) * distance(curve.points.front(), curve.center);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) sum += distance(curve.points[i], curve.points[i + 1]);
  return sum;
}

/// Whether the ray from p to the left crosses the chord p q: the standard parity test.
bool crosses(Point a, Point b, Point p) {
  if ((a.y <= p.y) == (b.y <= p.y)) return false;
  return (cross(a, b, p) < 0) == (a.y < b.y);
}

/// Even-odd by the ring's chords, corrected where p lies between an arc and its chord.
bool is_inside(const OwnerZone::Ring& ring, Point p) {
  bool inside = false;
  for (const Curve& curve : ring.curves) {
    const auto& v = curve.points;
    for (std::size_t i = 0; i + 1 < v.size(); ++i) inside ^= crosses(v[i], v[i + 1], p);
    if (curve.kind != Kind::arc) continue;
    const bool in_circle = distance(p, curve.center) < distance(v.front(), curve.center);
    if (in_circle && (v.front() == v.back() || cross(v.front(), v.back(), p) < 0)) inside = !inside;
  }
  return inside;
}

kernel::Box box_of(const OwnerZone::Ring& ring) {
  kernel::Box box;
  for (const Curve& curve : ring.curves) {
    for (const Point p : curve.points) box.add(p);
    if (curve.kind != Kind::arc) continue;
    const double r = distance(curve.points.front(), curve.center);
    box.add(Point{curve.center.x - r, curve.center.y - r});
    box.add(Point{curve.center.x + r, curve.center.y + r});
  }
  return box;
}

void shift(OwnerZone::Ring& ring, Point by) {
  for (Curve& curve : ring.curves) {
    for (Point& p : curve.points) p = {p.x + by.x, p.y + by.y};
    curve.center = {curve.center.x + by.x, curve.center.y + by.y};
  }
  // What absolute coordinates cannot tell from a point.
  std::erase_if(ring.curves, [](const Curve& curve) {
    return curve.kind == Kind::segment && curve.points.front() == curve.points.back();
  });
}

}  // namespace

std::vector<OwnerZone::Ring> split_at_pinches(std::vector<OwnerZone::Curve> curves) {
  std::vector<OwnerZone::Ring> rings;
  std::vector<Curve> open;
  std::map<std::pair<double, double>, std::size_t> begun;  // where a curve of the open chain starts, and which
  for (Curve& curve : curves) {
    const Point p = curve.points.front();
    const auto [at, is_new] = begun.emplace(std::pair(p.x, p.y), open.size());
    if (!is_new) {
      OwnerZone::Ring& ring = rings.emplace_back();
      for (std::size_t k = at->second; k < open.size(); ++k) {
        const Point q = open[k].points.front();
        if (k > at->second) begun.erase({q.x, q.y});
        ring.curves.push_back(std::move(open[k]));
      }
      open.resize(at->second);
    }
    open.push_back(std::move(curve));
  }
  if (!open.empty()) rings.push_back({std::move(open), 0, 0});
  return rings;
}

void measure(OwnerZone::Ring& ring, double radius) {
  double twice = 0;
  ring.length = 0;
  if (ring.curves.empty()) return;
  const Point base = ring.curves.front().points.front();
  for (const Curve& curve : ring.curves) {
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) twice += cross(base, curve.points[i], curve.points[i + 1]);
    if (curve.kind == Kind::arc) {
      const double angle = sweep(curve);
      twice += radius * radius * (angle - std::sin(angle));
    }
    ring.length += length(curve);
  }
  ring.area = twice / 2;
}

Status nest_rings(std::vector<OwnerZone::Ring> rings, Point origin, std::vector<OwnerZone::Polygon>& polygons) {
  std::vector<std::size_t> outer, holes;
  for (std::size_t r = 0; r < rings.size(); ++r) (rings[r].area > 0 ? outer : holes).push_back(r);
  std::vector<kernel::Box> boxes;
  for (const std::size_t r : outer) boxes.push_back(box_of(rings[r]));
  const kernel::BoxTree tree(boxes);
  std::vector<std::size_t> parent(rings.size(), rings.size());
  for (const std::size_t h : holes) {
    const auto longest = std::max_element(rings[h].curves.begin(), rings[h].curves.end(),
                                          [](const Curve& a, const Curve& b) { return length(a) < length(b); });
    const Point p = middle(*longest);
    kernel::Box at;
    at.add(p);
    double least = std::numeric_limits<double>::infinity();
    tree.visit_meeting(at, [&](std::size_t k) {
      const OwnerZone::Ring& ring = rings[outer[k]];
      if (ring.area < least && ring.area > -rings[h].area && is_inside(ring, p)) least = ring.area, parent[h] = outer[k];
    });
    if (parent[h] == rings.size()) {
      return Error{ErrorCode::computation, "the rings of an owner could not be nested: a hole lies in no ring",
                   "near x " + std::to_string(p.x + origin.x) + ", y " + std::to_string(p.y + origin.y),
                   "please report this input"};
    }
  }
  std::vector<std::size_t> polygon(rings.size());
  for (OwnerZone::Ring& ring : rings) shift(ring, origin);
  for (const std::size_t r : outer) {
    polygon[r] = polygons.size();
    polygons.push_back({std::move(rings[r]), {}});
  }
  for (const std::size_t h : holes) polygons[polygon[parent[h]]].holes.push_back(std::move(rings[h]));
  return std::monostate{};
}

}  // namespace krepl::voronoi
