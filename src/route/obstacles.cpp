#include "route/obstacles.hpp"

#include <map>
#include <queue>
#include <tuple>

#include "model/isolated_vertices.hpp"

namespace krepl::route {
namespace {

/// Lower bound of the distance between a box and segment ab: by bounding boxes, and along the segment's normal.
struct SegmentBound {
  Point a, b, normal;
  double offset;
  Box box;

  SegmentBound(Point a_, Point b_) : a(a_), b(b_) {
    const double size = length(b - a);
    normal = size > 0 ? (1 / size) * right(b - a) : Point{0, 0};
    offset = dot(normal, a);
    box.add(a), box.add(b);
  }
  double operator()(const Box& o) const {
    const double x = std::max({o.min_x - box.max_x, box.min_x - o.max_x, 0.0});
    const double y = std::max({o.min_y - box.max_y, box.min_y - o.max_y, 0.0});
    const Point middle{(o.min_x + o.max_x) / 2, (o.min_y + o.max_y) / 2};
    const double half = std::abs(normal.x) * (o.max_x - o.min_x) / 2 + std::abs(normal.y) * (o.max_y - o.min_y) / 2;
    return std::max(std::hypot(x, y), std::abs(dot(normal, middle) - offset) - half);
  }
};

bool on_arc(const ArcShape& arc, Point direction) {
  return positive_angle(std::atan2(direction.y, direction.x) - arc.from) <= arc.span;
}
Point place(const ArcShape& arc, double angle) {
  return arc.center + Point{arc.radius * std::cos(angle), arc.radius * std::sin(angle)};
}

/// The least is at an end of the arc, where the circle comes nearest to an end of the segment, where both are parallel,
/// or where they cross.
double arc_distance(const ArcShape& arc, Point a, Point b) {
  double least = std::min(distance_to_segment(place(arc, arc.from), a, b),
                          distance_to_segment(place(arc, arc.from + arc.span), a, b));
  for (Point e : {a, b})
    if (on_arc(arc, e - arc.center)) least = std::min(least, std::abs(distance(e, arc.center) - arc.radius));
  const Point d = b - a;
  const double size = length(d);
  if (!(size > 0)) return least;
  const Point along = (1 / size) * d, normal = right(along);
  const double across = dot(normal, arc.center - a), foot = dot(along, arc.center - a);
  for (double side : {1.0, -1.0})
    if (foot >= 0 && foot <= size && on_arc(arc, side * normal))
      least = std::min(least, std::abs(across + side * arc.radius));
  const double square = arc.radius * arc.radius - across * across;
  for (double side : {1.0, -1.0}) {
    if (square < 0) break;
    const double t = foot + side * std::sqrt(square);
    if (t >= 0 && t <= size && on_arc(arc, a + t * along - arc.center)) return 0;
  }
  return least;
}

}  // namespace

std::vector<Box> Obstacles::boxes() const {
  std::vector<Box> boxes(network_.segments().size() + isolated_.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Ends e = ends(i);
    boxes[i].add(e.a), boxes[i].add(e.b);
  }
  return boxes;
}

Obstacles::Obstacles(const Network& network)
    : network_(network), isolated_(model::isolated_vertices(network)), tree_(boxes()) {}

Obstacles::Ends Obstacles::ends(std::size_t item) const {
  const auto vertices = network_.vertices();
  const auto segments = network_.segments();
  if (item < segments.size()) return {vertices[segments[item].a], vertices[segments[item].b]};
  const Point p = vertices[isolated_[item - segments.size()]];
  return {p, p};
}

Network::Source Obstacles::source(std::uint32_t item) const {
  const std::size_t segments = network_.segments().size();
  return item < segments ? network_.segment_source(item) : network_.vertex_source(isolated_[item - segments]);
}

Obstacles::Nearest Obstacles::nearest(Point p) const {
  Nearest found;
  tree_.nearest(
      found.distance, [&](const Box& b) { return distance(p, b); },
      [&](std::size_t i) {
        const Ends e = ends(i);
        const Point at = nearest_on_segment(p, e.a, e.b);
        const double d = distance(p, at);
        if (d < found.distance) found = {d, at, std::uint32_t(i)};
      });
  return found;
}

double Obstacles::nearest_to_segment(Point a, Point b, double limit) const {
  tree_.nearest(limit, SegmentBound(a, b), [&](std::size_t i) {
    const Ends e = ends(i);
    limit = std::min(limit, segment_distance(a, b, e.a, e.b));
  });
  return limit;
}

bool Obstacles::any_within(Point a, Point b, double clearance) const {
  double limit = clearance;
  tree_.nearest(limit, SegmentBound(a, b), [&](std::size_t i) {
    const Ends e = ends(i);
    if (segment_distance(a, b, e.a, e.b) < clearance) limit = -1;  // nothing more is visited
  });
  return limit < 0;
}

void Obstacles::each_by_distance(Point p, const std::function<bool(double, Point, Point)>& visit,
                                 const std::function<bool(double, const Box&)>& is_near) const {
  struct Waiting {
    double distance;
    std::size_t level, index;
    bool operator<(const Waiting& o) const {
      return std::tie(distance, level, index) > std::tie(o.distance, o.level, o.index);
    }
  };
  if (tree_.empty()) return;
  std::priority_queue<Waiting> queue;
  queue.push({0, tree_.top(), 0});
  while (!queue.empty()) {
    const Waiting w = queue.top();
    queue.pop();
    if (w.level == 0) {
      const Ends e = ends(w.index);
      if (!visit(w.distance, e.a, e.b)) return;
      continue;
    }
    const auto [first, last] = tree_.children(w.level, w.index);
    for (std::size_t i = first; i < last; ++i) {
      const Box& box = tree_.box(w.level - 1, i);
      const double away = distance(p, box);
      if (is_near(away, box)) queue.push({away, w.level - 1, i});
    }
  }
}

double Obstacles::nearest_to_arc(const ArcShape& arc, double limit) const {
  tree_.nearest(
      limit,
      [&](const Box& b) {  // boxes inside the circle too are away from it
        const double x = std::max(arc.center.x - b.min_x, b.max_x - arc.center.x);
        const double y = std::max(arc.center.y - b.min_y, b.max_y - arc.center.y);
        return std::max(distance(arc.center, b) - arc.radius, arc.radius - std::hypot(x, y));
      },
      [&](std::size_t i) {
        const Ends e = ends(i);
        limit = std::min(limit, arc_distance(arc, e.a, e.b));
      });
  return limit;
}

std::optional<std::int64_t> Obstacles::polygon_around(Point p) const {
  std::map<std::int64_t, bool> odd;
  const auto vertices = network_.vertices();
  for (std::uint32_t part = 0; part < network_.part_count(); ++part) {
    if (!network_.part_is_ring(part)) continue;
    const auto chain = network_.part(part);
    bool crossings = false;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const Point a = vertices[chain[i]], b = vertices[chain[(i + 1) % chain.size()]];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      const double side = cross(b - a, p - a);
      if ((b.y > a.y) == (side > 0)) crossings = !crossings;
    }
    if (crossings) odd[network_.part_feature(part)] ^= true;
  }
  for (const auto& [feature, inside] : odd)
    if (inside) return feature;
  return std::nullopt;
}

}  // namespace krepl::route
