#include "incremental/curve.hpp"

#include <algorithm>

namespace krepl::incremental {

using FeatureKind = Terrain::FeatureKind;
using Shape = Curve::Shape;
using Role = Curve::Role;

namespace {

/// Directions that differ by less are parallel or coplanar.
constexpr Real parallel = 1e-13L;

/// What rises above a plane or overlaps another ball or cylinder by less only touches it: where exactly they would cross,
/// rounding decides, and it is far off.
Real flush(const Parts& parts) { return 0x1p-54L * parts.scale(); }

/// The half of the unit circle with positive sine from turn -1, where the cosine is 1, to turn 1: rational, since
/// trigonometric functions take most of the time otherwise.
struct Direction {
  Real cosine, sine;
};
Direction half_circle(Real turn) {
  const Real scale = 1 / (1 + turn * turn);
  return {-2 * turn * scale, (1 - turn) * (1 + turn) * scale};
}
/// All of it: the other half from turn 1 to 3.
Direction whole_circle(Real turn) {
  if (turn <= 1) return half_circle(turn);
  const Direction d = half_circle(turn - 2);
  return {-d.cosine, -d.sine};
}

Vector on_cylinder(const Curve& c, Real turn) {
  const Direction d = half_circle(turn);
  return c.at + c.radius * (d.cosine * c.aside + d.sine * c.up);
}

void set_cylinder(Curve& c, const EdgePart& e, Real radius) {
  c.at = e.at, c.direction = e.direction, c.aside = e.aside, c.up = e.up, c.radius = radius;
}

/// Of the equation A s^2 + 2 B s + C = 0 for points q + s direction of the cylinder on the other surface: A and B.
struct Linear {
  Real a, b;
};
Linear linear_terms(const Curve& c, Vector on) {
  const Vector q = on - c.other;
  if (dot(c.axis, c.axis) == 0) return {1, dot(c.direction, q)};
  const Vector e = cross(c.axis, c.direction);
  return {dot(e, e), dot(e, cross(c.axis, q))};
}

using Quartic = std::array<Real, 5>;

Real value(const Quartic& p, Real u) { return p[0] + u * (p[1] + u * (p[2] + u * (p[3] + u * p[4]))); }

/// (B^2 - A C) (1 + u^2)^2 as a polynomial in the turn u.
Quartic discriminant(const Curve& c) {
  const Vector w = c.at - c.other, r = c.radius * c.up;
  const Vector q[3] = {w + r, Real(-2) * c.radius * c.aside, w - r};  // q (1 + u^2)
  const bool sphere = dot(c.axis, c.axis) == 0;
  const Vector e = sphere ? c.direction : cross(c.axis, c.direction);
  const Real a = sphere ? 1 : dot(e, e);
  Quartic p{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector f = sphere ? q[i] : cross(c.axis, q[i]), g = sphere ? q[j] : cross(c.axis, q[j]);
      p[i + j] += dot(e, f) * dot(e, g) - a * dot(f, g);
    }
  }
  const Real square = a * c.radius * c.radius;
  p[0] += square, p[2] += 2 * square, p[4] += square;
  return p;
}

/// p / (u - root).
Quartic divided(const Quartic& p, Real root) {
  Quartic q{};
  Real carry = 0;
  for (std::size_t i = 4; i > 0; --i) q[i - 1] = carry = p[i] + root * carry;
  return q;
}

}  // namespace

Vector Curve::point(Real t) const {
  switch (shape) {
    case Shape::line:
      return base + t * first;
    case Shape::circle: {
      const Direction d = whole_circle(t);
      return base + size * (d.cosine * first + d.sine * second);
    }
    case Shape::section: {
      const Vector q = on_cylinder(*this, t);
      return q + ((size - dot(first, q)) / dot(first, direction)) * direction;
    }
    case Shape::pair:
      break;
  }
  // Slow at both ends, where branches fold like square roots: what is under the root there is a square times what is
  // left.
  const Real width = to_turn - from_turn;
  const Real after = width * t * t * (3 - 2 * t), before = width * (1 - t) * (1 - t) * (1 + 2 * t);
  const Real turn = t < 0.5L ? from_turn + after : to_turn - before;
  Real root = std::sqrt(std::fabs(value(discriminant, turn)));
  if (fold[0]) root *= t * std::sqrt(width * (3 - 2 * t));
  if (fold[1]) root *= (1 - t) * std::sqrt(width * (1 + 2 * t));
  const Vector on = on_cylinder(*this, turn);
  const Linear terms = linear_terms(*this, on);
  return on + ((-terms.b + sign * root / (1 + turn * turn)) / terms.a) * direction;
}

namespace {

Curve line(Role role, Index first, Index second, Vector from, Vector to) {
  Curve c{};
  c.shape = Shape::line, c.role = role, c.own = {first, second};
  c.base = from, c.first = to - from, c.begin = 0, c.end = 1;
  return c;
}

/// All of it: between the parts of it that hang over, a ball does not come from above.
Curve circle(Role role, Index first, Index second, Vector center, Vector normal, Real size) {
  Curve c{};
  c.shape = Shape::circle, c.role = role, c.own = {first, second};
  c.base = center, c.size = size, c.begin = -1, c.end = 3;
  const Vector across = std::fabs(normal.x) < std::fabs(normal.y) ? Vector{1, 0, 0} : Vector{0, 1, 0};
  c.first = unit(cross(normal, across));
  c.second = cross(unit(normal), c.first);
  return c;
}

Curve section(const Parts& parts, Role role, Index edge, Index second, Vector normal, Real size) {
  Curve c{};
  c.shape = Shape::section, c.role = role, c.own = {edge, second};
  set_cylinder(c, parts.edge_of(edge), parts.radius());
  c.first = normal, c.size = size, c.begin = -1, c.end = 1;
  return c;
}

/// Lines on a cylinder where n . r(angle) R = value.
void add_lines(const Parts& parts, Index edge, Index second, Vector n, Real value, std::vector<Curve>& curves) {
  const EdgePart& e = parts.edge_of(edge);
  const Real x = parts.radius() * dot(n, e.aside), y = parts.radius() * dot(n, e.up), size = std::sqrt(x * x + y * y);
  if (!(size > 0) || std::fabs(value) > size) return;
  const Real middle = std::atan2(y, x), half = std::acos(value / size);
  for (const Real angle : {middle + half, middle - half}) {
    const Vector r = parts.radius() * (std::cos(angle) * e.aside + std::sin(angle) * e.up);
    curves.push_back(line(Role::meeting, edge, second, e.at + r, e.end + r));
    if (half == 0) break;
  }
}

void face_with_face(const Parts& parts, Index f, Index g, std::vector<Curve>& curves) {
  const TrianglePart &s = parts.triangle_of(f), &t = parts.triangle_of(g);
  const Vector d = cross(s.normal, t.normal);
  const Real square = dot(d, d);
  if (square < parallel * parallel) return;
  // The point of both planes next to g's patch.
  const Vector near = (Real(1) / 3) * (t.corner[0] + t.corner[1] + t.corner[2]) + parts.radius() * t.normal;
  const Real off = parts.radius() - dot(near - s.corner[0], s.normal);
  const Vector base = near + (off / square) * cross(t.normal, d);
  const Vector along = unit(d);
  Real low = std::numeric_limits<Real>::infinity(), high = -low;
  for (const Vector c : t.corner) {
    const Real at = dot(c + parts.radius() * t.normal - base, along);
    low = std::min(low, at), high = std::max(high, at);
  }
  curves.push_back(line(Role::meeting, f, g, base + low * along, base + high * along));
}

void face_with_edge(const Parts& parts, Index face, Index edge, std::vector<Curve>& curves) {
  const TrianglePart& t = parts.triangle_of(face);
  const EdgePart& e = parts.edge_of(edge);
  if (std::find(t.edge.begin(), t.edge.end(), parts[edge].item) != t.edge.end()) return;
  const Real size = dot(t.normal, t.corner[0]) + parts.radius();
  if (std::fabs(dot(t.normal, e.direction)) < parallel) {
    const Real value = size - dot(t.normal, e.at);
    if (parts.radius() - std::fabs(value) > flush(parts)) add_lines(parts, edge, face, t.normal, value, curves);
    return;
  }
  curves.push_back(section(parts, Role::meeting, edge, face, t.normal, size));
}

void face_with_vertex(const Parts& parts, Index face, Index vertex, std::vector<Curve>& curves) {
  const TrianglePart& t = parts.triangle_of(face);
  if (std::find(t.vertex.begin(), t.vertex.end(), parts[vertex].item) != t.vertex.end()) return;
  const Vector v = parts.vertex_of(vertex).at;
  const Real rise = parts.radius() - dot(t.normal, v - t.corner[0]);
  const Real square = (parts.radius() - rise) * (parts.radius() + rise);
  if (parts.radius() - std::fabs(rise) > flush(parts))
    curves.push_back(circle(Role::meeting, face, vertex, v + rise * t.normal, t.normal, std::sqrt(square)));
}

void vertex_with_vertex(const Parts& parts, Index first, Index second, std::vector<Curve>& curves) {
  const Vector v = parts.vertex_of(first).at, w = parts.vertex_of(second).at, between = w - v;
  const Real apart = length(between) / 2;
  const Real square = (parts.radius() - apart) * (parts.radius() + apart);
  if (parts.radius() - apart > flush(parts))
    curves.push_back(circle(Role::meeting, first, second, Real(0.5) * (v + w), unit(between), std::sqrt(square)));
}

/// Turns in [-1, 1] between which the discriminant is not negative.
struct Stretch {
  Real from, to;
  bool fold[2];
};
std::vector<Stretch> stretches(const Quartic& p) {
  constexpr int samples = 64;
  std::vector<Real> at, of;
  for (int i = 0; i <= samples; ++i) at.push_back(2 * Real(i) / samples - 1), of.push_back(value(p, at.back()));
  // A maximum or minimum between samples may have another sign.
  for (int i = 1; i < int(at.size()) - 1; ++i) {
    const bool top = of[i] >= of[i - 1] && of[i] >= of[i + 1] && of[i] < 0;
    const bool bottom = of[i] <= of[i - 1] && of[i] <= of[i + 1] && of[i] > 0;
    if (!top && !bottom) continue;
    Real low = at[i - 1], high = at[i + 1];
    for (int k = 0; k < 90; ++k) {
      const Real third = (high - low) / 3, left_third = low + third, right_third = high - third;
      const bool left =
          top ? value(p, left_third) > value(p, right_third) : value(p, left_third) < value(p, right_third);
      (left ? high : low) = left ? right_third : left_third;
    }
    const Real middle = (low + high) / 2, extreme = value(p, middle);
    if (top == (extreme > 0) && middle != at[i]) {
      const int place = middle > at[i] ? i + 1 : i;
      at.insert(at.begin() + place, middle);
      of.insert(of.begin() + place, extreme);
      ++i;
    }
  }
  std::vector<Stretch> found;
  const auto root = [&](Real negative, Real positive) {
    for (int k = 0; k < 80; ++k) {
      const Real middle = (negative + positive) / 2;
      (value(p, middle) < 0 ? negative : positive) = middle;
    }
    return positive;
  };
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (of[i] < 0) continue;
    Stretch s{at[i], at[i], {false, false}};
    if (i > 0) s.from = root(at[i - 1], at[i]), s.fold[0] = true;
    while (i + 1 < at.size() && of[i + 1] >= 0) ++i;
    s.to = at[i];
    if (i + 1 < at.size()) s.to = root(at[i + 1], at[i]), s.fold[1] = true;
    // Surfaces that touch at a point: shorter curves rise above both by no more than rounding.
    if (s.to - s.from > 0x1p-24L) found.push_back(s);
  }
  return found;
}

void add_pair(const Parts& parts, Index edge, Index second, Vector other, Vector axis, std::vector<Curve>& curves) {
  Curve c{};
  c.shape = Shape::pair, c.role = Role::meeting, c.own = {edge, second};
  c.begin = 0, c.end = 1;
  set_cylinder(c, parts.edge_of(edge), parts.radius());
  c.other = other, c.axis = axis;
  const Quartic whole = discriminant(c);
  for (const Stretch& s : stretches(whole)) {
    c.from_turn = s.from, c.to_turn = s.to;
    c.fold[0] = s.fold[0], c.fold[1] = s.fold[1];
    c.discriminant = whole;
    if (s.fold[0]) c.discriminant = divided(c.discriminant, s.from);
    if (s.fold[1]) c.discriminant = divided(c.discriminant, s.to);
    for (const Real sign : {Real(1), Real(-1)}) {
      c.sign = sign;
      curves.push_back(c);
    }
  }
}

void edge_with_vertex(const Parts& parts, Index edge, Index vertex, std::vector<Curve>& curves) {
  const EdgePart& e = parts.edge_of(edge);
  const Vector v = parts.vertex_of(vertex).at, w = v - e.at;
  const Vector off = w - dot(w, e.direction) * e.direction;
  const Real distance = length(off);
  if (e.a == parts[vertex].item || e.b == parts[vertex].item || distance <= parallel * length(w)) return;
  add_pair(parts, edge, vertex, v, {}, curves);
}

void edge_with_edge(const Parts& parts, Index first, Index second, std::vector<Curve>& curves) {
  const EdgePart &e = parts.edge_of(first), &f = parts.edge_of(second);
  const Vector normal = cross(e.direction, f.direction);
  const Real sine = length(normal);
  const Vector between = f.at - e.at;
  if (sine < parallel) {
    // In a plane across both, two circles of equal size.
    const Vector off = between - dot(between, e.direction) * e.direction;
    const Real square = dot(off, off);
    if (square <= parallel * parallel * dot(between, between)) return;
    if (parts.radius() - std::sqrt(square) / 2 <= flush(parts)) return;
    return add_lines(parts, first, second, off, square / 2, curves);
  }
  const Index shared = e.a == f.a || e.a == f.b ? e.a : e.b == f.a || e.b == f.b ? e.b : none;
  if (shared != none) {
    const Vector v = parts.vertices()[shared].at;
    const Vector d =
        (e.a == shared ? Real(1) : Real(-1)) * e.direction - (f.a == shared ? Real(1) : Real(-1)) * f.direction;
    curves.push_back(section(parts, Role::meeting, first, second, d, dot(d, v)));
    return;
  }
  const Real apart = dot(between, normal);
  if (std::fabs(apart) <= parallel * sine * (length(between) + e.length + f.length)) {
    // Axes that cross: two ellipses, which cross over the same point.
    const Vector crossing = e.at + (dot(cross(between, f.direction), normal) / (sine * sine)) * e.direction;
    const Vector upright = ((dot(normal, e.up) < 0 ? -1 : 1) / sine) * normal;
    const Real top = -dot(upright, e.aside) / (1 + dot(upright, e.up));
    for (const Real sign : {Real(1), Real(-1)}) {
      const Vector d = e.direction + sign * f.direction;
      Curve c = section(parts, Role::meeting, first, second, d, dot(d, crossing));
      c.end = top;
      curves.push_back(c);
      c.begin = top, c.end = 1;
      curves.push_back(c);
    }
    return;
  }
  add_pair(parts, first, second, f.at, f.direction, curves);
}

}  // namespace

std::vector<Curve> outline(const Parts& parts, Index part) {
  const Real radius = parts.radius();
  std::vector<Curve> curves;
  if (parts[part].kind == FeatureKind::vertex) {
    curves.push_back(circle(Role::rim, part, none, parts.vertex_of(part).at, {0, 0, 1}, radius));
    return curves;
  }
  if (parts[part].kind == FeatureKind::face) {
    const TrianglePart& t = parts.triangle_of(part);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector moved = radius * t.normal;
      curves.push_back(
          line(Role::side, part, parts.edges()[t.edge[k]].part, t.corner[k] + moved, t.corner[(k + 1) % 3] + moved));
    }
    return curves;
  }
  const EdgePart& e = parts.edge_of(part);
  for (const Real side : {radius, -radius}) {
    curves.push_back(line(Role::rim, part, none, e.at + side * e.aside, e.end + side * e.aside));
  }
  for (const Index v : {e.a, e.b}) {
    const Vector at = parts.vertices()[v].at;
    curves.push_back(section(parts, Role::side, part, parts.vertices()[v].part, e.direction, dot(e.direction, at)));
  }
  return curves;
}

std::vector<Curve> meetings(const Parts& parts, Index first, Index second) {
  if (parts[first].kind < parts[second].kind) std::swap(first, second);  // face, edge, vertex
  const FeatureKind a = parts[first].kind, b = parts[second].kind;
  std::vector<Curve> curves;
  if (a == FeatureKind::face) {
    if (b == FeatureKind::face) face_with_face(parts, first, second, curves);
    if (b == FeatureKind::edge) face_with_edge(parts, first, second, curves);
    if (b == FeatureKind::vertex) face_with_vertex(parts, first, second, curves);
  } else if (a == FeatureKind::edge) {
    if (b == FeatureKind::edge) edge_with_edge(parts, first, second, curves);
    if (b == FeatureKind::vertex) edge_with_vertex(parts, first, second, curves);
  } else {
    vertex_with_vertex(parts, first, second, curves);
  }
  return curves;
}

}  // namespace krepl::incremental
