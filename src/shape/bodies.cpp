#include "shape/bodies.hpp"

#include <algorithm>
#include <cmath>

#include "shape/join_choice.hpp"

namespace krepl::shape {
namespace {

using Q = Vector<quad>;
using kernel::square_root;

Q operator+(Q a, Q b) { return {a.x + b.x, a.y + b.y}; }
Q operator-(Q a, Q b) { return {a.x - b.x, a.y - b.y}; }
Q operator*(quad s, Q a) { return {s * a.x, s * a.y}; }
quad dot(Q a, Q b) { return a.x * b.x + a.y * b.y; }
quad cross(Q a, Q b) { return a.x * b.y - a.y * b.x; }
Q right_of(Q a) { return {a.y, -a.x}; }

/// A fixed hash (the finaliser of MurmurHash3) as a number in [-1, 1).
double fraction(std::uint64_t h) {
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdULL;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return double(std::int64_t(h ^ (h >> 33))) * 0x1p-63;
}

constexpr Key wall(Index vertex, std::uint8_t which) { return {Key::Kind::end, vertex, which}; }

Border<quad> line(Q p, Q q, Key key) { return {false, p, q, {}, key}; }

}  // namespace

Bodies::Bodies(const Network& network, const zone::Instance& instance, const ShapeOptions& options)
    : in_(instance),
      options_(options),
      radius_(instance.radius()),
      nominal_radius_(instance.nominal_radius()),
      is_end_(network.vertices().size(), false) {
  scale_ = network.extent() + 2 * radius_ * (options.join == Join::mitre ? options.mitre_limit : 1.0);
  const double most = 0x1p-62 * scale_;
  const auto segments = network.segments();
  std::vector<Index> begin(network.vertices().size() + 1, 0);
  for (const auto s : segments) ++begin[s.a + 1], ++begin[s.b + 1];
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) begin[v + 1] += begin[v];
  std::vector<Index> leaving(2 * segments.size());
  {
    std::vector<Index> at(begin.begin(), begin.end() - 1);
    for (Index s = 0; s < segments.size(); ++s) {
      leaving[at[segments[s].a]++] = 2 * s;
      leaving[at[segments[s].b]++] = 2 * s + 1;
    }
  }
  for (Index s = 0; s < segments.size(); ++s)
    specs_.push_back({Kind::rectangle, false, s, none, 0, std::min(most, 0x1p-10 * std::min(length(2 * s), radius_))});
  std::vector<Arm> arms;
  for (Index v = 0; v < network.vertices().size(); ++v) {
    arms.clear();
    for (Index i = begin[v]; i < begin[v + 1]; ++i)
      arms.push_back({leaving[i], direction(leaving[i]), length(leaving[i])});
    add_joins(v, arms);
    if (arms.size() > 1) add_seams(arms);
  }
}

Q Bodies::at(Index vertex) const { return {in_.vertices()[vertex].x, in_.vertices()[vertex].y}; }

Q Bodies::direction(Index side) const {
  const auto e = in_.ends(side);
  const Q d = at(e.to) - at(e.from);
  const quad l = square_root(dot(d, d));
  return {d.x / l, d.y / l};
}

double Bodies::length(Index side) const {
  const auto e = in_.ends(side);
  return std::hypot(in_.vertices()[e.to].x - in_.vertices()[e.from].x,
                    in_.vertices()[e.to].y - in_.vertices()[e.from].y);
}

/// The body in the one gap above 180 degrees.
void Bodies::add_joins(Index v, const std::vector<Arm>& arms) {
  const double most = 0x1p-62 * scale_;
  if (arms.empty()) {
    if (options_.cap == Cap::round) specs_.push_back({Kind::disc, false, v, none, 0, most});
    if (options_.cap == Cap::square) specs_.push_back({Kind::square, false, v, none, 0, most});
    return;
  }
  const auto sector = in_.sector(v);
  if (sector.before == none) return;
  const Q d = direction(sector.before), e = direction(sector.after);
  const double turn = std::atan2(double(cross(d, e)), double(dot(d, e)));
  const double angle = turn < -1 ? M_PI : std::max(turn, 0.0);  // rounding may carry 180 and 0 degrees over
  const bool folded = arms.size() == 1 || angle > M_PI - least_bend;
  const double overlap = std::min({length(sector.before), length(sector.after), radius_}) / 2;
  if (folded) {
    is_end_[v] = true;
    if (options_.cap == Cap::round)
      specs_.push_back({Kind::cap, true, sector.before, sector.after, overlap, std::min(most, 0x1p-10 * overlap)});
    return;
  }
  const Join join = join_of(options_, angle);
  const Kind kind = join == Join::round ? Kind::join : join == Join::bevel ? Kind::bevel : Kind::mitre;
  // Moves must not turn a border by what comes near the angle to its neighbour.
  const double sharpest = std::min(std::max(angle, least_bend), M_PI - angle) / 2;
  const double shortest = kind == Kind::join ? overlap : std::min(overlap, radius_ * std::sin(angle / 2));
  specs_.push_back(
      {kind, false, sector.before, sector.after, overlap, std::min(most, 0x1p-10 * sharpest * sharpest * shortest)});
}

/// Where two segments go straight on, the rectangles' ends overlap by next to nothing on the side where they do.
void Bodies::add_seams(const std::vector<Arm>& arms) {
  for (std::size_t i = 0; i < arms.size(); ++i) {
    for (std::size_t j = 0; j < arms.size(); ++j) {
      if (i == j) continue;
      const quad bend = cross(arms[i].direction, arms[j].direction);  // j left of i: the gap on the left is below 180
      if (dot(arms[i].direction, arms[j].direction) >= 0 || bend < 0 || (bend == 0 && i > j)) continue;
      const double overlap = std::min({arms[i].length, arms[j].length, radius_}) / 4;
      if (double(bend) > 0x1p-24 * std::sqrt(scale_ / overlap)) continue;
      const double move = std::min(0x1p-62 * scale_, 0x1p-10 * overlap);
      specs_.push_back({Kind::seam, false, arms[i].side, arms[j].side, overlap, move});
      if (bend == 0) specs_.push_back({Kind::seam, false, arms[j].side, arms[i].side, overlap, move});
    }
  }
}

void Bodies::build_rectangle(const Spec& spec, quad r, Body<quad>& out) const {
  const Index s = spec.a;
  const auto e = in_.ends(2 * s);
  const Q d = direction(2 * s), n = right_of(d);
  Q a = at(e.from), b = at(e.to);
  if (options_.cap == Cap::square && is_end(e.from)) a = a - r * d;
  if (options_.cap == Cap::square && is_end(e.to)) b = b + r * d;
  out.add(line(a + r * n, b + r * n, {Key::Kind::side, 2 * s}));
  out.add(line(b + r * n, b - r * n, wall(e.to, 0)));
  out.add(line(b - r * n, a - r * n, {Key::Kind::side, 2 * s + 1}));
  out.add(line(a - r * n, a + r * n, wall(e.from, 0)));
}

/// From the side before over the vertex to the side after, and back along the segments' inside.
void Bodies::build_join(const Spec& spec, quad r, Body<quad>& out) const {
  const Index vertex = in_.ends(spec.b).from;
  const Q v = at(vertex), d = direction(spec.a), e = direction(spec.b), n = right_of(d);
  const Q o = spec.folded ? quad(-1) * n : right_of(e);
  const Q back = spec.folded ? quad(-1) * d : e;
  const quad m = spec.overlap;
  const Key before{Key::Kind::side, spec.a}, after{Key::Kind::side, spec.b};
  const Q b1 = v - m * d, b2 = v + m * back;
  const bool round = spec.kind == Kind::join || spec.kind == Kind::cap;
  const quad height = round ? square_root((r - m) * (r + m)) : r;
  const Q q1 = b1 + height * n, q2 = b2 + height * o;
  if (round) {
    out.add({true, q1, q2, v, {Key::Kind::circle, vertex}});
  } else if (spec.kind == Kind::mitre) {
    const Q apex = v + (r / (1 + dot(n, o))) * (n + o);
    out.add(line(q1, apex, before));
    out.add(line(apex, q2, after));
  } else {
    const Q p1 = v + r * n, p2 = v + r * o;
    out.add(line(q1, p1, before));
    out.add(line(p1, p2, {Key::Kind::bevel, vertex}));
    out.add(line(p2, q2, after));
  }
  if (spec.folded) {
    out.add(line(q2, q1, wall(vertex, 1)));
    return;
  }
  out.add(line(q2, b2, wall(vertex, 1)));
  out.add(line(b2, b1, wall(vertex, 2)));
  out.add(line(b1, q1, wall(vertex, 3)));
}

void Bodies::build_point(const Spec& spec, quad r, Body<quad>& out) const {
  const Q v = at(spec.a);
  if (spec.kind == Kind::disc) {
    const Q start{v.x + r, v.y};
    out.add({true, start, start, v, {Key::Kind::circle, spec.a}});
    return;
  }
  const Q corner[] = {{v.x - r, v.y - r}, {v.x + r, v.y - r}, {v.x + r, v.y + r}, {v.x - r, v.y + r}};
  for (std::uint8_t k = 0; k < 4; ++k) out.add(line(corner[k], corner[(k + 1) % 4], wall(spec.a, k)));
}

/// Across the common end of two segments: from below to their left side (the left of `a`, which leaves the vertex), as
/// far as it is certainly inside of both rectangles.
void Bodies::build_seam(const Spec& spec, quad r, Body<quad>& out) const {
  const Index vertex = in_.ends(spec.a).from;
  const Q v = at(vertex), d = direction(spec.a), up = quad(-1) * right_of(d);
  const quad bend = cross(d, direction(spec.b)), m = spec.overlap;
  quad top = r;
  if (bend * r > m) top = m / bend;
  const Q low = v - (r / 2) * up;
  const Q corner[] = {low - m * d, low + m * d, v + m * d + top * up, v - m * d + top * up};
  for (std::uint8_t k = 0; k < 4; ++k)
    out.add(line(corner[k], corner[(k + 1) % 4],
                 k == 2 && top == r ? Key{Key::Kind::side, spec.a ^ 1u} : wall(vertex, std::uint8_t(4 + k))));
}

Body<quad> Bodies::build(Index body, quad radius, bool move) const {
  const Spec& spec = specs_[body];
  Body<quad> out;
  switch (spec.kind) {
    case Kind::rectangle:
      build_rectangle(spec, radius, out);
      break;
    case Kind::disc:
    case Kind::square:
      build_point(spec, radius, out);
      break;
    case Kind::seam:
      build_seam(spec, radius, out);
      break;
    default:
      build_join(spec, radius, out);
  }
  if (!move) return out;
  // Corners move with both their borders; the ends of an arc are found again where its neighbours cut its circle.
  for (int k = 0; k < out.count; ++k) {
    auto& b = out.border[std::size_t(k)];
    auto& before = out.border[std::size_t((k + out.count - 1) % out.count)];
    const std::uint64_t h = (std::uint64_t{body} << 4 | std::uint64_t(k)) * 0x9e3779b97f4a7c15ULL;
    const Q shift{spec.moves * fraction(h + 1), spec.moves * fraction(h + 2)};
    if (b.arc) {
      b.c = b.c + shift;
      b.p = b.p + shift, b.q = b.q + shift;
    } else if (!before.arc) {
      b.p = b.p + shift;
      before.q = b.p;
    } else {
      b.p = b.p + shift;
    }
  }
  const auto cut = [&](const Border<quad>& l, const Border<quad>& circle) {  // nearest to the arc's end as built
    const Q u = l.q - l.p;
    const quad length = square_root(dot(u, u));
    const Q w{u.x / length, u.y / length};
    const quad along = dot(circle.c - l.p, w), off = cross(w, circle.c - l.p);
    const quad half = square_root((radius - off) * (radius + off));
    return std::pair<Q, Q>{l.p + (along - half) * w, l.p + (along + half) * w};
  };
  for (int k = 0; k < out.count && out.count > 1; ++k) {
    auto& b = out.border[std::size_t(k)];
    if (!b.arc) continue;
    auto& before = out.border[std::size_t((k + out.count - 1) % out.count)];
    auto& after = out.border[std::size_t((k + 1) % out.count)];
    b.p = cut(before, b).second;  // a straight border leaves the circle at its end
    b.q = cut(after, b).first;    // and enters it at its start
    if (&before == &after) {
      before.q = b.p, before.p = b.q;
    } else {
      before.q = b.p, after.p = b.q;
    }
  }
  return out;
}

}  // namespace krepl::shape
