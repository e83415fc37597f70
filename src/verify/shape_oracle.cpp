#include "verify/shape_oracle.hpp"

#include <algorithm>
#include <set>
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

}  // namespace

/// What lines meet at each place. Of a polygon's sides that lie on each other only an odd one is a border.
std::vector<ShapeOracle::Corner> ShapeOracle::corners_of(const std::vector<InputPart>& parts, bool border_only) {
  std::map<std::pair<std::int64_t, std::pair<Coordinates, Coordinates>>, int> count;
  const auto for_each_side = [&](auto&& f) {
    for (const InputPart& part : parts) {
      const auto& v = part.vertices;
      for (std::size_t i = 0; i + 1 < v.size(); ++i) f(part, v[i], v[i + 1]);
      if (part.ring && v.size() > 1 && !(v.front() == v.back())) f(part, v.back(), v.front());
    }
  };
  const auto key = [&](const InputPart& part, Point a, Point b) {
    return std::pair{part.feature,
                     std::pair{std::min(coordinates(a), coordinates(b)), std::max(coordinates(a), coordinates(b))}};
  };
  if (border_only) for_each_side([&](const InputPart& part, Point a, Point b) { ++count[key(part, a, b)]; });
  std::map<Coordinates, std::map<Coordinates, std::pair<bool, bool>>> arms;  // with senses: out, in
  for (const InputPart& part : parts)
    if (part.vertices.size() == 1 && !border_only) arms[coordinates(part.vertices[0])];
  for_each_side([&](const InputPart& part, Point a, Point b) {
    if (coordinates(a) == coordinates(b)) {
      if (!border_only) arms[coordinates(a)];
      return;
    }
    if (border_only && count[key(part, a, b)] % 2 == 0) return;
    if (arms[coordinates(a)].contains(coordinates(b))) return;  // of lines that run along each other the first counts
    arms[coordinates(a)][coordinates(b)].first = true;
    arms[coordinates(b)][coordinates(a)].second = true;
  });
  std::vector<Corner> corners;
  for (const auto& [at, neighbours] : arms) {
    Corner c;
    c.at = vec(at);
    std::vector<std::pair<Real, Coordinates>> order;
    for (const auto& [to, sense] : neighbours) order.emplace_back(angle_from(Vec(1, 0), vec(to) - c.at), to);
    std::sort(order.begin(), order.end());
    for (const auto& [angle, to] : order) {
      c.arms.push_back(vec(to));
      c.out.push_back(neighbours.at(to).first);
      c.in.push_back(neighbours.at(to).second);
    }
    Real rest = 2 * pi;  // the last gap: arms may lie on each other
    for (std::size_t i = 0; i + 1 < c.arms.size(); ++i) {
      c.gap.push_back(angle_from(c.arms[i] - c.at, c.arms[i + 1] - c.at));
      rest -= c.gap.back();
    }
    if (!c.arms.empty()) c.gap.push_back(rest);
    c.end = std::any_of(c.gap.begin(), c.gap.end(), [](Real gap) { return gap > 2 * pi - 0x1p-20L; });
    corners.push_back(std::move(c));
  }
  return corners;
}

std::vector<ShapeOracle::Side> ShapeOracle::sides_of(const std::vector<Corner>& corners) {
  std::map<std::pair<Real, Real>, bool> is_end;
  for (const Corner& c : corners) is_end[{c.at.x, c.at.y}] = c.end;
  std::vector<Side> sides;
  for (const Corner& c : corners)
    for (std::size_t i = 0; i < c.arms.size(); ++i) {
      const Vec o = c.arms[i];
      if (std::pair{o.x, o.y} < std::pair{c.at.x, c.at.y}) continue;
      sides.push_back({c.at, o, c.end, is_end[{o.x, o.y}], c.out[i], c.in[i]});
    }
  return sides;
}

ShapeOracle::ShapeOracle(const std::vector<InputPart>& parts, const Obstacle& obstacle, const ShapeQuestion& question)
    : obstacle_(obstacle),
      question_(question),
      radius_(std::abs(Real(question.distance))),
      reach_(radius_ *
             (question.join == ShapeQuestion::Join::mitre ? std::max(Real(question.mitre_limit), 1.5L) : 1.5L)),
      corners_(corners_of(parts, question.distance < 0)),
      sides_(sides_of(corners_.items())) {}

ShapeOracle::Depth ShapeOracle::in_rectangle(const Side& s, Vec p) const {
  const Vec d = unit(s.b - s.a);
  const Real l = verify::distance(s.a, s.b), u = dot(p - s.a, d), across = std::abs(cross(d, p - s.a));
  const bool square = question_.cap == ShapeQuestion::Cap::square, round = question_.cap == ShapeQuestion::Cap::round;
  Depth depth{radius_ - across, HUGE_VALL};
  const auto bound = [&](Real inwards, bool end) {
    if (end && square) inwards += radius_;
    // Behind a round cap and behind a vertex the zone goes on.
    (end && !round ? depth.outer : depth.walls) = std::min(end && !round ? depth.outer : depth.walls, inwards);
  };
  bound(u, s.end_a);
  bound(l - u, s.end_b);
  return depth;
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
    if (question_.cap == Cap::round) out.push_back({radius_ - length(v), dot(v, unit(c.at - c.arms[0]))});
    return;
  }
  for (std::size_t i = 0; i < c.arms.size(); ++i) {
    const Vec d = unit(c.arms[i] - c.at), e = unit(c.arms[(i + 1) % c.arms.size()] - c.at);
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
    if (!found) depths.push_back(in_rectangle(sides_.items()[i], p)), look();
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
    const Vec d = c.arms[i] - c.at;
    if (angle_from(d, direction) > c.gap[i]) continue;
    if (c.end) return false;
    // The gap is on the left of arm i as it leaves, on the right of arm j.
    const bool first = left ? c.out[i] : c.in[i], second = left ? c.in[j] : c.out[j];
    return first && second;
  }
  return false;
}

bool ShapeOracle::side_holds(Vec p) const {
  const auto hit = sides_.nearest(p);
  if (!(hit.distance <= radius_)) return false;
  const auto vertex = corners_.nearest(p);
  if (corners_.items()[vertex.item].arms.empty() && vertex.distance < hit.distance) return false;
  const Side& s = sides_.items()[hit.item];
  const Vec u = unit(s.b - s.a);
  const Real along = dot(p - s.a, u);
  if (along <= 0 || along >= verify::distance(s.a, s.b)) {  // a vertex is what is nearest
    const Corner& c = corners_.items()[vertex.item];
    return on_side(c, p - c.at);
  }
  // On the left of a b: on the left of lines that run from a to b.
  const bool left = cross(u, p - s.a) > 0;
  return left == (question_.side == ShapeQuestion::Side::left) ? s.forward : s.backward;
}

}  // namespace krepl::verify
