#include "verify/shape_oracle.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace krepl::verify {

namespace {

constexpr Real pi = 3.141592653589793238462643383279502884L;

using Coordinates = std::pair<double, double>;
Coordinates coordinates(Point p) { return {p.x + 0.0, p.y + 0.0}; }
Vec vec(Coordinates c) { return {c.first, c.second}; }
Vec unit(Vec v) { return (1 / length(v)) * v; }
Real angle_from(Vec u, Vec v) {  // counter-clockwise, in [0, 2 pi)
  const Real a = std::atan2(cross(u, v), dot(u, v));
  return a < 0 ? a + 2 * pi : a;
}

/// A segment or arc as it runs in the input.
struct Element {
  const InputPart& part;
  Point a, b;
  std::shared_ptr<const CircularArc> arc;

  /// Of elements with the same ends: the same for those that coincide.
  using Key = std::tuple<Coordinates, Coordinates, Coordinates>;
  Key key(double grain) const {
    Coordinates middle{HUGE_VAL, HUGE_VAL};
    if (arc) {
      const Vec m = arc->at(0.5L);
      middle = {double(std::round(m.x / grain)), double(std::round(m.y / grain))};
    }
    return {std::min(coordinates(a), coordinates(b)), std::max(coordinates(a), coordinates(b)), middle};
  }
  /// The direction in which it leaves its first or last place.
  Vec direction(bool first) const {
    if (!arc) return unit(first ? vec(coordinates(b)) - vec(coordinates(a)) : vec(coordinates(a)) - vec(coordinates(b)));
    const Vec from_centre = (first ? Vec(0, 0) : arc->b - arc->a) - arc->to_centre;
    return unit((arc->left == first ? Real(1) : Real(-1)) * left_of(from_centre));
  }
};

void append_elements(const InputPart& part, std::vector<Element>& out) {
  const auto& v = part.vertices;
  auto middle = part.middles.begin();
  for (std::size_t i = 0; i + 1 < v.size(); ++i) {
    if (middle != part.middles.end() && *middle == i + 1) {
      ++middle;
      if (const auto arc = CircularArc::through(v[i], v[i + 1], v[i + 2])) {
        out.push_back({part, v[i], v[i + 2], std::make_shared<const CircularArc>(*arc)});
        ++i;
        continue;
      }
    }
    out.push_back({part, v[i], v[i + 1], {}});
  }
  if (part.ring && v.size() > 1 && !(v.front() == v.back())) out.push_back({part, v.back(), v.front(), {}});
}

}  // namespace

/// What lines meet at each place. Of a polygon's sides that lie on each other only an odd one is a border.
ShapeOracle::Picture ShapeOracle::picture_of(const std::vector<InputPart>& parts, bool border_only) {
  std::vector<Element> elements;
  Box around;
  for (const InputPart& part : parts) {
    append_elements(part, elements);
    for (const Point p : part.vertices) around.add(vec(coordinates(p)));
  }
  // Arcs are one if their middles are, but for rounding of the places that tell them: far from the origin these are coarser.
  const Real extent = std::max(around.x1 - around.x0, around.y1 - around.y0);
  const Real largest = std::max(std::max(-around.x0, around.x1), std::max(-around.y0, around.y1));
  const double grain = std::max({1e-10 * double(extent), 0x1p-50 * double(largest), 1e-300});
  std::map<std::pair<std::int64_t, Element::Key>, int> count;
  if (border_only)
    for (const Element& e : elements) ++count[{e.part.feature, e.key(grain)}];

  struct Arm {
    Vec direction;
    bool out, in;
  };
  std::map<Coordinates, std::vector<Arm>> arms;
  std::map<Element::Key, std::size_t> known;
  Picture picture;
  if (!border_only)
    for (const InputPart& part : parts)
      if (part.vertices.size() == 1) arms[coordinates(part.vertices[0])];
  for (const Element& e : elements) {
    if (coordinates(e.a) == coordinates(e.b) && !e.arc) {
      if (!border_only) arms[coordinates(e.a)];
      continue;
    }
    if (border_only && count[{e.part.feature, e.key(grain)}] % 2 == 0) continue;
    // Of lines that run along each other the first counts.
    if (!known.emplace(e.key(grain), picture.sides.size()).second) continue;
    Side side{vec(coordinates(e.a)), vec(coordinates(e.b)), e.arc};
    side.forward = true;
    picture.sides.push_back(side);
    arms[coordinates(e.a)].push_back({e.direction(true), true, false});
    arms[coordinates(e.b)].push_back({e.direction(false), false, true});
  }
  std::map<Coordinates, bool> is_end;
  for (auto& [at, leaving] : arms) {
    Corner c;
    c.at = vec(at);
    std::vector<std::pair<Real, Arm>> order;
    for (const Arm& arm : leaving) order.emplace_back(angle_from(Vec(1, 0), arm.direction), arm);
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [angle, arm] : order) {
      c.arms.push_back(arm.direction);
      c.out.push_back(arm.out);
      c.in.push_back(arm.in);
    }
    for (std::size_t i = 0; i < order.size(); ++i)
      c.gap.push_back(i + 1 < order.size() ? order[i + 1].first - order[i].first
                                           : 2 * pi - (order.back().first - order.front().first));
    c.end = std::any_of(c.gap.begin(), c.gap.end(), [](Real gap) { return gap > 2 * pi - 0x1p-20L; });
    is_end[at] = c.end;
    picture.corners.push_back(std::move(c));
  }
  for (Side& s : picture.sides) {
    s.end_a = is_end[{double(s.a.x), double(s.a.y)}];
    s.end_b = is_end[{double(s.b.x), double(s.b.y)}];
  }
  return picture;
}

ShapeOracle::ShapeOracle(const std::vector<InputPart>& parts, const Obstacle& obstacle, const ShapeQuestion& question)
    : ShapeOracle(picture_of(parts, question.distance < 0), obstacle, question) {}

ShapeOracle::ShapeOracle(Picture picture, const Obstacle& obstacle, const ShapeQuestion& question)
    : obstacle_(obstacle),
      question_(question),
      radius_(std::abs(Real(question.distance))),
      reach_(radius_ *
             (question.join == ShapeQuestion::Join::mitre ? std::max(Real(question.mitre_limit), 1.5L) : 1.5L)),
      corners_(std::move(picture.corners)),
      sides_(std::move(picture.sides)) {}

/// Straight beside a segment.
ShapeOracle::Depth ShapeOracle::in_rectangle(const Side& s, Vec p) const {
  const Vec d = unit(s.b - s.a);
  const Real l = verify::distance(s.a, s.b), u = dot(p - s.a, d), across = std::abs(cross(d, p - s.a));
  Depth depth{radius_ - across, HUGE_VALL};
  const auto bound = [&](Real inwards, bool end) {
    // Behind a cap that is not flat, and behind a vertex, the zone goes on.
    const bool outer = end && question_.cap == ShapeQuestion::Cap::flat;
    (outer ? depth.outer : depth.walls) = std::min(outer ? depth.outer : depth.walls, inwards);
  };
  bound(u, s.end_a);
  bound(l - u, s.end_b);
  return depth;
}

/// Straight beside an arc: on the ray from the centre through one of its places, within R of that. Where R is more than
/// the arc's radius, also beyond the centre.
void ShapeOracle::in_arc(const Side& s, Vec p, std::vector<Depth>& out) const {
  const CircularArc& arc = *s.arc;
  if (arc.spans(p)) out.push_back({radius_ - std::abs(arc.off_circle(p)), 0});
  if (arc.r >= radius_) return;
  const Vec from_centre = p - arc.a - arc.to_centre;
  if (arc.spans(arc.a + arc.to_centre - from_centre)) out.push_back({radius_ - arc.r - length(from_centre), 0});
}

void ShapeOracle::in_corner(const Corner& c, Vec p, std::vector<Depth>& out) const {
  using Cap = ShapeQuestion::Cap;
  using Join = ShapeQuestion::Join;
  const Vec v = p - c.at;
  if (c.arms.empty()) {
    if (question_.cap == Cap::round) out.push_back({radius_ - length(v), HUGE_VALL});
    if (question_.cap == Cap::square) out.push_back({radius_ - std::max(std::abs(v.x), std::abs(v.y)), HUGE_VALL});
    return;
  }
  if (c.end) {
    const Real beyond = -dot(v, c.arms[0]);
    if (question_.cap == Cap::round) out.push_back({radius_ - length(v), beyond});
    if (question_.cap == Cap::square)
      for (const Vec& arm : c.arms)
        out.push_back({radius_ - std::max(-dot(v, arm), std::abs(cross(arm, v))), -dot(v, arm)});
    return;
  }
  for (std::size_t i = 0; i < c.arms.size(); ++i) {
    const Vec d = c.arms[i], e = c.arms[(i + 1) % c.arms.size()];
    const Real gap = c.gap[i];
    if (gap <= pi) continue;
    // The outer normals: left of the arm before the gap, right of the one behind it.
    const Vec n = left_of(d), o = Real(-1) * left_of(e);
    const Real walls = std::min(-dot(v, d), -dot(v, e));
    const Real half_cosine = std::cos((gap - pi) / 2);
    if (question_.join == Join::round) {
      out.push_back({radius_ - length(v), walls});
    } else if (question_.join == Join::mitre && 1 <= Real(question_.mitre_limit) * half_cosine) {
      out.push_back({std::min(radius_ - dot(v, n), radius_ - dot(v, o)), walls});
    } else {
      const Vec middle = length(n + o) > 1e-9L ? unit(n + o) : Real(-1) * d;
      out.push_back({radius_ * half_cosine - dot(v, middle), walls});
    }
  }
}

bool ShapeOracle::zone_holds(Vec p) const {
  bool found = false;
  std::vector<Depth> depths;
  Box around;
  around.add(p);
  around = around.grown(reach_);
  // Bodies share walls, so that a place on one must not fall between them.
  const Real slack = -1e-17L * reach_;
  const auto look = [&] {
    for (const Depth& d : depths) found = found || (d.outer >= 0 && d.walls >= slack);
    depths.clear();
  };
  sides_.for_each_in(around, [&](std::uint32_t i) {
    if (found) return;
    const Side& s = sides_.items()[i];
    if (s.arc)
      in_arc(s, p, depths);
    else
      depths.push_back(in_rectangle(s, p));
    look();
  });
  corners_.for_each_in(around, [&](std::uint32_t i) {
    if (!found) in_corner(corners_.items()[i], p, depths), look();
  });
  return found;
}

bool ShapeOracle::holds(Vec p) const {
  if (question_.side != ShapeQuestion::Side::both) return side_holds(p);
  if (!obstacle_.has_polygons()) return zone_holds(p);
  const bool in = obstacle_.in_polygon(p);
  if (question_.distance > 0) return question_.ring ? !in && zone_holds(p) : in || zone_holds(p);
  return in && zone_holds(p) == question_.ring;
}

ShapeOracle::Answer ShapeOracle::around(Vec p, Real distance) const {
  constexpr int directions = 16;
  const bool first = holds(p);
  for (int k = 0; k < directions; ++k) {
    const Real angle = 2 * pi * (k + 0.17L) / directions;  // not along what is upright
    if (holds(p + distance * Vec(std::cos(angle), std::sin(angle))) != first) return Answer::unclear;
  }
  return first ? Answer::inside : Answer::outside;
}

/// The left of an arm that leaves a corner is the line's left if the line leaves with it, its right if it comes in.
bool ShapeOracle::on_side(const Corner& c, Vec direction) const {
  const bool left = question_.side == ShapeQuestion::Side::left;
  for (std::size_t i = 0; i < c.arms.size(); ++i) {
    const std::size_t j = (i + 1) % c.arms.size();
    if (angle_from(c.arms[i], direction) > c.gap[i]) continue;
    if (c.end) return false;
    // The gap is on the left of arm i as it leaves, on the right of arm j.
    const bool first = left ? c.out[i] : c.in[i], second = left ? c.in[j] : c.out[j];
    return first && second;
  }
  return false;
}

bool ShapeOracle::side_holds(Vec p) const {
  const auto hit = sides_.nearest(p);
  if (!(hit.distance <= reach_)) return false;
  const auto vertex = corners_.nearest(p);
  if (corners_.items()[vertex.item].arms.empty() && vertex.distance < hit.distance) return false;
  const Side& s = sides_.items()[hit.item];
  const Vec u = unit(s.b - s.a);
  const Real along = dot(p - s.a, u);
  if (along <= 0 || along >= verify::distance(s.a, s.b)) {  // a vertex is what is nearest
    const Corner& c = corners_.items()[vertex.item];
    if (!on_side(c, p - c.at)) return false;
    // Only the join in the gap above 180 degrees holds places that are nearest to the vertex.
    std::vector<Depth> joins;
    in_corner(c, p, joins);
    const Real slack = -1e-17L * reach_;
    return std::any_of(joins.begin(), joins.end(), [&](const Depth& d) { return d.outer >= 0 && d.walls >= slack; });
  }
  if (!(hit.distance <= radius_)) return false;
  // On the left of a b: on the left of lines that run from a to b.
  const bool left = cross(u, p - s.a) > 0;
  return left == (question_.side == ShapeQuestion::Side::left) ? s.forward : s.backward;
}

}  // namespace krepl::verify
