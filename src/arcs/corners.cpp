#include "arcs/corners.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::arcs {
namespace {

using Q = Vector<quad>;

/// Up to two places, and the sine of the angle at which the borders meet there; below zero: nowhere.
struct Meeting {
  Q place[2] = {};
  double sine = -1;
};

Meeting lines(const Border<quad>& a, const Border<quad>& b) {
  Meeting m;
  const Q d = a.q - a.p, e = b.q - b.p;
  const quad turn = cross(d, e);
  if (turn == 0) return m;
  m.place[0] = m.place[1] = a.p + (cross(b.p - a.p, e) / turn) * d;
  m.sine = std::abs(double(turn / (length(d) * length(e))));
  return m;
}

Meeting line_circle(const Border<quad>& line, const Border<quad>& circle) {
  Meeting m;
  const Q d = line.q - line.p;
  const quad l = length(d), r = circle.radius;
  const Q w{d.x / l, d.y / l}, v = circle.c - line.p;
  const quad along = dot(v, w), off = cross(w, v);
  const quad half = kernel::square_root((r - off) * (r + off));  // zero where they only touch
  m.place[0] = line.p + (along - half) * w;
  m.place[1] = line.p + (along + half) * w;
  m.sine = double(half / r);
  return m;
}

Meeting circles(const Border<quad>& a, const Border<quad>& b) {
  Meeting m;
  const Q v = b.c - a.c;
  const quad l = length(v);
  if (l == 0) return m;
  const quad below = (b.radius - a.radius + l) * (b.radius + a.radius - l),
             above = (a.radius + l - b.radius) * (a.radius + l + b.radius);
  // Half the chord; zero where they only touch.
  const quad half = kernel::square_root(below * above) / (2 * l);
  const quad along = ((a.radius - b.radius) * (a.radius + b.radius) + l * l) / (2 * l);
  const Q w{v.x / l, v.y / l};
  quad scale = 1;
  // Where they miss each other, the place of the first that is nearest to the second.
  if (!(half > 0)) scale = a.radius / kernel::absolute(along);
  m.place[0] = {a.c.x + scale * along * w.x + half * w.y, a.c.y + scale * along * w.y - half * w.x};
  m.place[1] = {a.c.x + scale * along * w.x - half * w.y, a.c.y + scale * along * w.y + half * w.x};
  m.sine = double(half * l / (a.radius * b.radius));
  return m;
}

}  // namespace

/// How far from where the moved bodies' borders meet the place may be: what they were moved by over the sine of the
/// angle, and where they touch the length on which they are hardly apart.
double Corners::limit(const Border<quad>& a, const Border<quad>& b, double sine) const {
  const double g = bodies_.enlargement();
  const double radius =
      std::min(bodies_.scale(), std::max({double(a.radius), double(b.radius), bodies_.largest_radius()}));
  return std::min(8 * g / std::max(sine, 0x1p-30), 8 * std::sqrt(g * radius));
}

Q Corners::meet(BorderId from, BorderId to, Q first, Q last) const {
  const Border<quad> a = nominal(from), b = nominal(to);
  const Meeting m = a.arc ? (b.arc ? circles(a, b) : line_circle(b, a)) : (b.arc ? line_circle(a, b) : lines(a, b));
  const auto away = [&](Q p) { return double(length(p - first) + length(p - last)) / 2; };
  if (m.sine >= (are_incident(a.key, b.key) ? 0.0 : 1.0 / 16)) {
    const Q best = away(m.place[1]) < away(m.place[0]) ? m.place[1] : m.place[0];
    if (away(best) <= limit(a, b, m.sine) + double(length(last - first))) return best;
  }
  if (first.x == last.x && first.y == last.y) return last;
  const auto amiss = [&](Q p) { return std::max(off(from, p), off(to, p)); };
  return amiss(first) < amiss(last) ? first : last;
}

double Corners::off(BorderId border, Q p) const {
  const Border<quad> b = nominal(border);
  if (b.arc) return std::abs(double(length(p - b.c) - b.radius));
  const Q d = b.q - b.p;
  return std::abs(double(cross(d, p - b.p) / length(d)));
}

bool Corners::runs_back(BorderId border, Q p, Q q) const {
  const Border<quad> b = nominal(border);
  if (!b.arc) return dot(b.q - b.p, q - p) < 0;
  const Q u = p - b.c, v = q - b.c;
  return dot(u, v) > 0 && (cross(u, v) < 0) != b.clockwise;
}

bool Corners::are_incident(const Key& a, const Key& b) const {
  const auto p = bodies_.ends(a), q = bodies_.ends(b);
  if (p[0] == none || q[0] == none) return false;
  return p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1];
}

}  // namespace krepl::arcs
