#include "arcs/bodies.hpp"

#include <algorithm>

#include "model/arc_circle.hpp"
#include "shape/join_choice.hpp"

namespace krepl::arcs {
namespace {

using Q = Vector<quad>;

/// A fixed hash (the finaliser of MurmurHash3) as a number in [-1, 1).
double fraction(std::uint64_t h) {
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdULL;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return double(std::int64_t(h ^ (h >> 33))) * 0x1p-63;
}

Q right_of(Q a) { return {a.y, -a.x}; }
Q unit(Q a) {
  const quad l = length(a);
  return {a.x / l, a.y / l};
}

/// The unit vector turned counter-clockwise by about `angle`, a unit vector to all digits again.
Q turned(Q a, double angle) {
  const quad c = std::cos(angle), s = std::sin(angle);
  return unit({a.x * c - a.y * s, a.x * s + a.y * c});
}

Q left_of(Q a) { return {-a.y, a.x}; }

Border<quad> line(Q p, Q q, Key key) { return {false, false, key, p, q, {}, 0}; }
Border<quad> arc(Q p, Q q, Q centre, quad radius, Key key) { return {true, false, key, p, q, centre, radius}; }

constexpr Key inside{Key::Kind::inside, none};

bool is_round(const ShapeOptions& o) { return o.cap == Cap::round && o.join == Join::round; }

}  // namespace

Bodies::Bodies(const CurveNetwork& network, const ShapeOptions& options, const Radii& radii, double enlargement,
               double resolution, std::uint64_t seed)
    : options_(options),
      network_(network),
      radii_(radii),
      enlargement_(enlargement),
      resolution_(resolution),
      scale_(network.extent() + 2 * effective(radii.most()) * (options.join == Join::mitre ? options.mitre_limit : 1.0)),
      vast_(0x1p6 * scale_),
      move_(0x1p-9 * enlargement),
      excess_(0x1p-6 * enlargement),
      seed_(seed) {
  for (Index a = 0; a < network.arcs().size(); ++a)
    courses_.push_back(course_of(network.arcs()[a], effective(radii.of_arc(a))));
  if (is_round(options))
    list_round();
  else
    list_shaped();
}

Q Bodies::at(Index vertex) const {
  const Point p = network_.straight().vertices()[vertex];
  return {p.x, p.y};
}

Course Bodies::course_of(const CurveNetwork::Arc& arc, double radius) const {
  const auto vertices = network_.straight().vertices();
  const Point s = vertices[arc.start], m = vertices[arc.middle], e = vertices[arc.end];
  const auto circle = model::arc_circle<quad>(s, m, e);
  Course c{};
  c.from = arc.start, c.to = arc.end;
  // Half the arc is what the angle at the middle lacks to 180 degrees (inscribed angles).
  const Q u{quad(m.x) - s.x, quad(m.y) - s.y}, v{quad(e.x) - m.x, quad(e.y) - m.y};
  const quad turn = cross(u, v);
  c.angle = arc.start == arc.end ? 2 * M_PI : 2 * std::atan2(std::abs(double(turn)), double(dot(u, v)));
  if (arc.start != arc.end && c.angle < 1) {
    const double chord = std::hypot(e.x - s.x, e.y - s.y);
    c.flat = chord / 2 * std::tan(c.angle / 4) <= 16 * enlargement();
    // Caps and joins look at directions, too.
    if (!is_round(options_)) c.flat = c.flat && c.angle * radius <= excess_ / 4;
  }
  if (arc.start != arc.end && turn == 0) c.flat = true;
  if (c.flat) return c;
  c.radius = circle.radius;
  const Q to{circle.to_center_x, circle.to_center_y};
  c.centre = at(arc.start) + to;
  c.first = {-to.x / c.radius, -to.y / c.radius};
  c.last = arc.start == arc.end ? c.first : unit(at(arc.end) - at(arc.start) - to);
  if (circle.left) return c;
  std::swap(c.from, c.to);
  std::swap(c.first, c.last);
  return c;
}

/// The disks about both ends cover all that is within R: nothing of an arc so low shows.
bool Bodies::ends_cover(const Course& c, double radius) const {
  if (c.angle > M_PI) return false;
  const double r = double(c.radius), s = std::sin(c.angle / 4), height = 2 * r * s * s;
  return height * (r + radius) <= excess_ / 2 * radius;
}

bool Bodies::ends_cover(Index segment) const {
  const auto s = network_.straight().segments()[segment];
  const Q d = at(s.b) - at(s.a);
  return double(dot(d, d)) <= 4 * excess_ * effective(radii_.of_segment(segment));
}

std::uint8_t Bodies::parts_of(const Course& c) const {
  return std::uint8_t(std::clamp(std::ceil(c.angle / (M_PI / 2)), 1.0, 4.0));
}

/// In the order of their lower vertices, which follow the plane.
void Bodies::list_round() {
  const Network& straight = network_.straight();
  std::size_t s = 0, a = 0;
  const auto arcs = network_.arcs();
  for (Index v = 0; v < straight.vertices().size(); ++v) {
    if (network_.is_joint()[v]) specs_.push_back({Kind::disk, 0, 1, v});
    for (; s < straight.segments().size() && straight.segments()[s].a == v; ++s)
      if (!ends_cover(Index(s))) specs_.push_back({Kind::strip, 0, 1, Index(s)});
    for (; a < arcs.size() && arcs[a].start == v; ++a) {
      const Course& c = courses_[a];
      if (c.flat) {
        specs_.push_back({Kind::chord, 0, 1, Index(a)});
      } else if (!ends_cover(c, effective(radii_.of_arc(Index(a))))) {
        const auto parts = parts_of(c);
        for (std::uint8_t k = 0; k < parts; ++k) specs_.push_back({Kind::sector, k, parts, Index(a)});
      }
    }
  }
}

void Bodies::list_shaped() {
  const Network& straight = network_.straight();
  auto leaving = arms();
  std::size_t s = 0, a = 0;
  const auto arcs = network_.arcs();
  for (Index v = 0; v < leaving.size(); ++v) {
    if (network_.is_joint()[v]) add_bend(v, leaving[v]);
    for (; s < straight.segments().size() && straight.segments()[s].a == v; ++s)
      specs_.push_back({Kind::strip, 0, 1, Index(s)});
    for (; a < arcs.size() && arcs[a].start == v; ++a) {
      const Course& c = courses_[a];
      if (c.flat) {
        specs_.push_back({Kind::chord, 0, 1, Index(a)});
        continue;
      }
      const auto parts = parts_of(c);
      const bool goes_beyond = effective(radii_.of_arc(Index(a))) - c.radius > resolution_ / 4;
      for (std::uint8_t k = 0; k < parts; ++k) {
        specs_.push_back({Kind::sector, k, parts, Index(a)});
        if (goes_beyond) specs_.push_back({Kind::beyond, k, parts, Index(a)});
      }
    }
  }
}

/// Per vertex what leaves it.
std::vector<std::vector<Bodies::Arm>> Bodies::arms() const {
  const auto segments = network_.straight().segments();
  std::vector<std::vector<Arm>> result(network_.straight().vertices().size());
  const auto add = [&](Index from, Index to, Key::Kind kind, Index index) {
    const Q d = unit(at(to) - at(from));
    const Key right{kind, 2 * index}, left{kind, 2 * index + 1};
    result[from].push_back({left, right, d});
    result[to].push_back({right, left, quad(-1) * d});
  };
  for (Index s = 0; s < segments.size(); ++s) add(segments[s].a, segments[s].b, Key::Kind::side, s);
  for (Index a = 0; a < courses_.size(); ++a) {
    const Course& c = courses_[a];
    if (c.flat) {
      add(c.from, c.to, Key::Kind::chord, a);
      continue;
    }
    const auto tangent = [&](Index place) { return Key{Key::Kind::tangent, 4 * a + place}; };
    result[c.from].push_back({tangent(0), tangent(1), left_of(c.first)});
    result[c.to].push_back({tangent(2), tangent(3), right_of(c.last)});
  }
  return result;
}

/// The body in the one gap above 180 degrees; at an end one for each square cap.
void Bodies::add_bend(Index v, std::vector<Arm>& arms) {
  const auto body = [&](Kind kind) { specs_.push_back({kind, 0, 1, Index(bends_.size() - 1)}); };
  if (arms.empty()) {
    bends_.push_back({v, {}, {}, inside, inside});
    if (options_.cap == Cap::round) specs_.push_back({Kind::disk, 0, 1, v});
    if (options_.cap == Cap::square) body(Kind::upright);
    return;
  }
  const auto lower = [](Q d) { return d.y < 0 || (d.y == 0 && d.x < 0); };
  std::sort(arms.begin(), arms.end(), [&](const Arm& a, const Arm& b) {
    if (lower(a.direction) != lower(b.direction)) return lower(b.direction);
    return cross(a.direction, b.direction) > 0;
  });
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const Arm &first = arms[i], &second = arms[(i + 1) % arms.size()];
    const Q d = quad(-1) * first.direction, e = second.direction;  // the gap is on the right of this way
    const quad turn = cross(d, e);
    const bool around = i + 1 == arms.size() && turn == 0 && dot(d, e) < 0;  // all in exactly one direction
    if (!(turn > 0) && !around) continue;
    const double angle = around ? M_PI : std::atan2(double(turn), double(dot(d, e)));
    bends_.push_back({v, d, e, first.left, second.right});
    if (angle > M_PI - shape::least_bend) {
      if (options_.cap == Cap::round) body(Kind::cap);
      if (options_.cap == Cap::square) add_squares(v, arms);
    } else {
      const Join join = shape::join_of(options_, angle);
      body(join == Join::round ? Kind::join : join == Join::bevel ? Kind::bevel : Kind::mitre);
    }
    return;
  }
}

void Bodies::add_squares(Index v, const std::vector<Arm>& arms) {
  bends_.pop_back();
  for (const Arm& arm : arms) {
    const auto bend = Index(bends_.size());
    const Q in = quad(-1) * arm.direction;
    // The sides of segments go straight on.
    const bool is_arc = arm.left.kind == Key::Kind::tangent;
    bends_.push_back({v, in, arm.direction, is_arc ? Key{Key::Kind::square, 4 * bend} : arm.left,
                      is_arc ? Key{Key::Kind::square, 4 * bend + 2} : arm.right});
    specs_.push_back({Kind::square, 0, 1, bend});
  }
}

/// How far walls at vertices are farther out than there, so that what is joined overlaps, and what touches merges.
quad Bodies::reach(bool move) const { return move && !is_round(options_) ? excess_ : 0; }

void Bodies::build_strip(Index a, Index b, Key key, Key end, quad width, Q shift, bool move, Body<quad>& out) const {
  const Q d = unit(at(b) - at(a)), n = width * right_of(d);
  const Q p = at(a) + shift - reach(move) * d, q = at(b) + shift + reach(move) * d;
  out.add(line(p + n, q + n, key));
  out.add(line(q + n, q - n, {end.kind, end.index + 1}));
  out.add(line(q - n, p - n, {key.kind, key.index + 1}));
  out.add(line(p - n, p + n, end));
}

void Bodies::build_sector(const Spec& spec, quad outer, quad inner, Q shift, bool move, Body<quad>& out) const {
  const Course& c = courses_[spec.index];
  const bool beyond = spec.kind == Kind::beyond;
  // Sectors of one arc reach over each other.
  const double each = c.angle / spec.parts, over = each / 8;
  const bool first = spec.part == 0, last = spec.part + 1 == spec.parts;
  const quad sign = beyond ? -1 : 1;
  const Q u = sign * (first ? c.first : turned(c.first, spec.part * each - over));
  const Q v = sign * (last ? c.last : turned(c.first, (spec.part + 1) * each + over));
  const Key start = first ? Key{Key::Kind::wall, 2 * spec.index} : inside;
  const Key end = last ? Key{Key::Kind::wall, 2 * spec.index + 1} : inside;
  // The walls are lines along u and v, or farther out by as much as bodies reach into each other.
  // A sector between others has both walls farther out if one is: its corner by the centre would else be no convex one.
  const quad out_by = first || last ? reach(true) : 0, back = move ? out_by : 0;
  const Q centre = c.centre + shift;
  const auto on_start = [&](quad r) {
    return centre + kernel::square_root((r - back) * (r + back)) * u + back * right_of(u);
  };
  const auto on_end = [&](quad r) {
    return centre + kernel::square_root((r - back) * (r + back)) * v + back * left_of(v);
  };
  const Key::Kind circle = beyond ? Key::Kind::beyond : Key::Kind::outer;
  out.add(arc(on_start(outer), on_end(outer), centre, outer, {circle, spec.index}));
  if (inner > 0) {
    out.add(line(on_end(outer), on_end(inner), end));
    out.add({true, true, {Key::Kind::inner, spec.index}, on_end(inner), on_start(inner), centre, inner});
    out.add(line(on_start(inner), on_start(outer), start));
    return;
  }
  // Walls farther out do not meet in the centre. Not moved, only the direction of the line across it counts.
  const quad wide = move ? 1 : outer / excess_;
  const Q from = centre + wide * out_by * left_of(v), to = centre + wide * out_by * right_of(u);
  out.add(line(on_end(outer), move ? from : centre, end));
  if (out_by > 0) out.add(line(from, to, inside));
  out.add(line(move ? to : centre, on_start(outer), start));
}

/// From the side before around the outside to the side after, and back just behind the vertex.
void Bodies::build_bend(const Spec& spec, quad r, Q shift, bool move, Body<quad>& out) const {
  const Bend& b = bends_[spec.index];
  const Q v = at(b.vertex) + shift, d = b.in, e = b.out, n = right_of(d), o = right_of(e);
  // Walls are this much farther back; sides begin there. Not moved, only lines and circles count.
  const quad back = move ? excess_ : 0, side = move ? excess_ : r;
  const quad height = spec.kind == Kind::join ? kernel::square_root((r - back) * (r + back)) : r;
  const Q q1 = v + height * n - back * d, q2 = v + height * o + back * e;
  if (spec.kind == Kind::join) {
    out.add(arc(q1, q2, v, r, {Key::Kind::circle, b.vertex}));
  } else if (spec.kind == Kind::mitre) {
    const Q apex = v + (r / (1 + dot(n, o))) * (n + o);
    out.add(line(v + r * n - side * d, apex, b.before));
    out.add(line(apex, v + r * o + side * e, b.after));
  } else {
    out.add(line(v + r * n - side * d, v + r * n, b.before));
    out.add(line(v + r * n, v + r * o, {Key::Kind::bevel, b.vertex}));
    out.add(line(v + r * o, v + r * o + side * e, b.after));
  }
  // The base is so deep that it cuts both walls, however sharp the bend.
  const Q t = unit(d + e), across = unit(n + o);
  const quad c = dot(t, d), s = dot(across, d), deep = back * (1 - c / 2), wide = move ? (back - s * deep) / c : r;
  const Q b1 = v - wide * t - deep * across, b2 = v + wide * t - deep * across;
  out.add(line(q2, move ? b2 : v, inside));
  out.add(line(b2, b1, inside));
  out.add(line(move ? b1 : v, q1, inside));
}

void Bodies::build_end(const Spec& spec, quad r, Q shift, bool move, Body<quad>& out) const {
  const auto corner = [&](Index k) { return Key{Key::Kind::square, 4 * spec.index + k}; };
  const Bend& b = bends_[spec.index];
  if (spec.kind == Kind::upright) {
    const Q v = at(b.vertex) + shift;
    const Q p[] = {v + Q{-r, -r}, v + Q{r, -r}, v + Q{r, r}, v + Q{-r, r}};
    for (Index k = 0; k < 4; ++k) out.add(line(p[k], p[(k + 1) % 4], corner(k)));
    return;
  }
  const Q v = at(b.vertex) + shift, d = b.in, n = right_of(d);
  const quad back = move ? excess_ : 0, side = move ? excess_ : r;
  if (spec.kind == Kind::cap) {
    const quad height = kernel::square_root((r - back) * (r + back));
    const Q p = v + height * n - back * d, q = v - height * n - back * d;
    out.add(arc(p, q, v, r, {Key::Kind::circle, b.vertex}));
    out.add(line(q, p, inside));
    return;
  }
  const quad far = r + back;
  const Q p = v + far * d + r * n, q = v + far * d - r * n;
  out.add(line(v + r * n - side * d, p, b.before));
  out.add(line(p, q, corner(1)));
  out.add(line(q, v - r * n - side * d, b.after));
  out.add(line(v - r * n - back * d, v + r * n - back * d, inside));
}

double Bodies::radius_of(const Spec& spec) const {
  switch (spec.kind) {
    case Kind::disk:
      return radii_.of_vertex(spec.index);
    case Kind::strip:
      return radii_.of_segment(spec.index);
    case Kind::chord:
    case Kind::sector:
    case Kind::beyond:
      return radii_.of_arc(spec.index);
    default:
      return radii_.most();
  }
}

double Bodies::radius_of(const Key& key) const {
  switch (key.kind) {
    case Key::Kind::side:
      return radii_.of_segment(key.index >> 1);
    case Key::Kind::chord:
      return radii_.of_arc(key.index >> 1);
    case Key::Kind::circle:
      return radii_.of_vertex(key.index);
    case Key::Kind::outer:
    case Key::Kind::inner:
    case Key::Kind::beyond:
      return radii_.of_arc(key.index);
    default:
      return radii_.most();
  }
}

/// In quadruple precision.
Body<quad> Bodies::build(Index body, bool move) const {
  const Spec& spec = specs_[body];
  const double given = radius_of(spec);
  const quad radius = move ? effective(given) : given;
  const std::uint64_t h = (seed_ << 40 | std::uint64_t{body} << 3) * 0x9e3779b97f4a7c15ULL;
  const double scale = move ? move_ : 0;
  const Q shift{scale * fraction(h + 1), scale * fraction(h + 2)};
  const quad more = scale * fraction(h + 3), less = scale * fraction(h + 4);
  Body<quad> out;
  switch (spec.kind) {
    case Kind::disk: {
      const quad r = radius + (move ? excess_ : 0) + more;
      const Q centre = at(spec.index) + shift, start{centre.x + r, centre.y};
      out.add(arc(start, start, centre, r, {Key::Kind::circle, spec.index}));
      break;
    }
    case Kind::strip: {
      const auto s = network_.straight().segments()[spec.index];
      const Key side{Key::Kind::side, 2 * spec.index}, end{Key::Kind::end, 2 * spec.index};
      build_strip(s.a, s.b, side, end, radius + more, shift, move, out);
      break;
    }
    case Kind::chord: {
      const auto& c = courses_[spec.index];
      const Key side{Key::Kind::chord, 2 * spec.index}, end{Key::Kind::flat_end, 2 * spec.index};
      build_strip(c.from, c.to, side, end, radius + more, shift, move, out);
      break;
    }
    case Kind::sector: {
      const quad r = courses_[spec.index].radius;
      // A hole that is hardly one is filled; the same in both instances.
      const bool hole = r - effective(given) > resolution_ / 4;
      build_sector(spec, r + radius + more, hole ? r - radius + less : 0, shift, move, out);
      break;
    }
    case Kind::beyond:
      build_sector(spec, radius - courses_[spec.index].radius + more, 0, shift, move, out);
      break;
    case Kind::join:
    case Kind::bevel:
    case Kind::mitre:
      build_bend(spec, radius + more, shift, move, out);
      break;
    case Kind::cap:
    case Kind::square:
    case Kind::upright:
      build_end(spec, radius + more, shift, move, out);
      break;
  }
  return out;
}

kernel::Box Bodies::box(Index body) const {
  const Body<quad> b = moved(body);
  kernel::Box box;
  double more = 0x1p-44 * scale_;
  for (int k = 0; k < b.count; ++k) {
    const auto& border = b.border[std::size_t(k)];
    box.add(Point{double(border.p.x), double(border.p.y)});
    if (!border.arc || border.clockwise) continue;
    if (b.count == 1) {
      box.add(Point{double(border.c.x - border.radius), double(border.c.y - border.radius)});
      box.add(Point{double(border.c.x + border.radius), double(border.c.y + border.radius)});
    } else if (specs_[body].kind == Kind::cap) {  // a little more than half a turn
      more += double(border.radius) + excess_;
    } else {  // a sector is between the chords and the height of its outer arc above them
      const Vector<quad> chord = border.q - border.p;
      const double half = double(length(chord)) / 2, r = double(border.radius);
      more += half * half / (r + std::sqrt(std::max(0.0, (r - half) * (r + half))));
    }
  }
  return {box.min_x - more, box.min_y - more, box.max_x + more, box.max_y + more};
}

std::array<Index, 2> Bodies::ends(const Key& key) const {
  const auto one = [](Index vertex) { return std::array{vertex, vertex}; };
  const auto end_of = [&](const Course& c, bool last) { return one(last ? c.to : c.from); };
  switch (key.kind) {
    case Key::Kind::circle:
    case Key::Kind::bevel:
      return one(key.index);
    case Key::Kind::square:
      return one(bends_[key.index >> 2].vertex);
    case Key::Kind::side: {
      const auto s = network_.straight().segments()[key.index >> 1];
      return {s.a, s.b};
    }
    case Key::Kind::end: {
      const auto s = network_.straight().segments()[key.index >> 1];
      return one((key.index & 1u) != 0 ? s.b : s.a);
    }
    case Key::Kind::chord:
      return {courses_[key.index >> 1].from, courses_[key.index >> 1].to};
    case Key::Kind::flat_end:
    case Key::Kind::wall:
      return end_of(courses_[key.index >> 1], (key.index & 1u) != 0);
    case Key::Kind::tangent:
      return end_of(courses_[key.index >> 2], (key.index & 2u) != 0);
    case Key::Kind::outer:
    case Key::Kind::inner:
    case Key::Kind::beyond:
      return {courses_[key.index].from, courses_[key.index].to};
    case Key::Kind::inside:
      break;
  }
  return {none, none};
}

}  // namespace krepl::arcs
