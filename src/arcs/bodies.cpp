#include "arcs/bodies.hpp"

#include <algorithm>

#include "model/arc_circle.hpp"

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

Border<quad> line(Q p, Q q, Key key) { return {false, false, key, p, q, {}, 0}; }

}  // namespace

Bodies::Bodies(const CurveNetwork& network, double nominal_radius, double effective_radius, double resolution,
               std::uint64_t seed)
    : network_(network),
      nominal_radius_(nominal_radius),
      effective_radius_(effective_radius),
      resolution_(resolution),
      scale_(network.extent() + 2 * effective_radius),
      vast_(0x1p6 * scale_),
      move_(0x1p-9 * (effective_radius - nominal_radius)),
      excess_(0x1p-6 * (effective_radius - nominal_radius)),
      seed_(seed) {
  for (const auto& arc : network.arcs()) courses_.push_back(course_of(arc));
  list_bodies();
}

Q Bodies::at(Index vertex) const {
  const Point p = network_.straight().vertices()[vertex];
  return {p.x, p.y};
}

Course Bodies::course_of(const CurveNetwork::Arc& arc) const {
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
bool Bodies::ends_cover(const Course& c) const {
  if (c.angle > M_PI) return false;
  const double r = double(c.radius), s = std::sin(c.angle / 4), height = 2 * r * s * s;
  return height * (r + effective_radius_) <= excess_ / 2 * effective_radius_;
}

bool Bodies::ends_cover(Index segment) const {
  const auto s = network_.straight().segments()[segment];
  const Q d = at(s.b) - at(s.a);
  return double(dot(d, d)) <= 4 * excess_ * effective_radius_;
}

/// In the order of their lower vertices, which follow the plane.
void Bodies::list_bodies() {
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
      } else if (!ends_cover(c)) {
        const auto parts = std::uint8_t(std::clamp(std::ceil(c.angle / (M_PI / 2)), 1.0, 4.0));
        for (std::uint8_t k = 0; k < parts; ++k) specs_.push_back({Kind::sector, k, parts, Index(a)});
      }
    }
  }
}

void Bodies::build_strip(Index a, Index b, Key key, quad width, Q shift, Body<quad>& out) const {
  const Q p = at(a) + shift, q = at(b) + shift, n = width * right_of(unit(at(b) - at(a)));
  out.add(line(p + n, q + n, key));
  out.add(line(q + n, q - n, {Key::Kind::end, b}));
  out.add(line(q - n, p - n, {key.kind, key.index + 1}));
  out.add(line(p - n, p + n, {Key::Kind::end, a}));
}

void Bodies::build_sector(const Spec& spec, quad outer, quad inner, Q shift, Body<quad>& out) const {
  const Course& c = courses_[spec.index];
  // Sectors of one arc reach over each other.
  const double each = c.angle / spec.parts, over = each / 8;
  const Q u = spec.part == 0 ? c.first : turned(c.first, spec.part * each - over);
  const Q v = spec.part + 1 == spec.parts ? c.last : turned(c.first, (spec.part + 1) * each + over);
  const Q centre = c.centre + shift;
  const Key wall{Key::Kind::wall, spec.index};
  out.add({true, false, {Key::Kind::outer, spec.index}, centre + outer * u, centre + outer * v, centre, outer});
  if (!(inner > 0)) {
    out.add(line(centre + outer * v, centre, wall));
    out.add(line(centre, centre + outer * u, wall));
    return;
  }
  out.add(line(centre + outer * v, centre + inner * v, wall));
  out.add({true, true, {Key::Kind::inner, spec.index}, centre + inner * v, centre + inner * u, centre, inner});
  out.add(line(centre + inner * u, centre + outer * u, wall));
}

Body<quad> Bodies::build(Index body, quad radius, bool move) const {
  const Spec& spec = specs_[body];
  const std::uint64_t h = (seed_ << 40 | std::uint64_t{body} << 3) * 0x9e3779b97f4a7c15ULL;
  const double scale = move ? move_ : 0;
  const Q shift{scale * fraction(h + 1), scale * fraction(h + 2)};
  const quad more = scale * fraction(h + 3), less = scale * fraction(h + 4);
  Body<quad> out;
  switch (spec.kind) {
    case Kind::disk: {
      const quad r = radius + (move ? excess_ : 0) + more;
      const Q centre = at(spec.index) + shift, start{centre.x + r, centre.y};
      out.add({true, false, {Key::Kind::circle, spec.index}, start, start, centre, r});
      break;
    }
    case Kind::strip: {
      const auto s = network_.straight().segments()[spec.index];
      build_strip(s.a, s.b, {Key::Kind::side, 2 * spec.index}, radius + more, shift, out);
      break;
    }
    case Kind::chord: {
      const auto& c = courses_[spec.index];
      build_strip(c.from, c.to, {Key::Kind::chord, 2 * spec.index}, radius + more, shift, out);
      break;
    }
    case Kind::sector: {
      const quad r = courses_[spec.index].radius;
      // A hole that is hardly one is filled; the same in both instances.
      const bool hole = r - effective_radius_ > resolution_ / 4;
      build_sector(spec, r + radius + more, hole ? r - radius + less : 0, shift, out);
      break;
    }
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
    } else {  // a sector is between the chords and the height of its outer arc above them
      const Vector<quad> chord = border.q - border.p;
      const double half = double(length(chord)) / 2, r = double(border.radius);
      more += half * half / (r + std::sqrt(std::max(0.0, (r - half) * (r + half))));
    }
  }
  return {box.min_x - more, box.min_y - more, box.max_x + more, box.max_y + more};
}

std::array<Index, 2> Bodies::ends(const Key& key) const {
  switch (key.kind) {
    case Key::Kind::circle:
      return {key.index, key.index};
    case Key::Kind::side: {
      const auto s = network_.straight().segments()[key.index >> 1];
      return {s.a, s.b};
    }
    case Key::Kind::chord:
      return {courses_[key.index >> 1].from, courses_[key.index >> 1].to};
    case Key::Kind::outer:
    case Key::Kind::inner:
      return {courses_[key.index].from, courses_[key.index].to};
    case Key::Kind::wall:
    case Key::Kind::end:
      break;
  }
  return {none, none};
}

}  // namespace krepl::arcs
