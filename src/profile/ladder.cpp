#include "profile/ladder.hpp"

#include "profile/contact.hpp"

namespace krepl::profile {

namespace {

using Real = DoubleDouble;

Vec<Real> exact_difference(Point p, Point q) { return {Real::sum(p.x, -q.x), Real::sum(p.y, -q.y)}; }

Vec<Real> direction(const Entry& side) {
  if (side.label == left_half_line) return {0.0, 1.0};
  return frame_of(exact_difference(side.b, side.a)).u;
}

/// A contact with a plain bound on its error along the curve.
struct Bounded {
  Vec<Real> n;
  Real t;
  Real error;
};

/// Near a double root (a circle that just touches) the quotient is unbounded, but its square root never is.
Bounded bounded(const Contact<Real>& c, bool double_root) {
  const Real square_root = root(2.0 * c.numerator);
  Real error = c.denominator > 0.0 ? c.numerator / c.denominator : Real(std::numeric_limits<double>::infinity());
  if (double_root && !(error < square_root)) error = square_root;
  return {c.n, c.t, error};
}

Bounded start_after(const Entry& p, const Later& next, bool on_circle, double r) {
  const Real radius = r;
  const Point at = on_circle ? next.b : next.a;
  const Vec<Real> d = exact_difference(at, p.a);
  if (p.label == left_half_line && on_circle) return {{Real(-1.0), Real(0.0)}, Real(0.0), Real(0.0)};
  if (on_circle) {
    if (!is_side(p.label)) return bounded(circle_to_circle(d, radius), true);
    return bounded(side_to_circle(d, direction(p), radius), true);
  }
  const Frame<Real> f = frame_of(exact_difference(next.b, next.a));
  if (!is_side(p.label)) return bounded(circle_to_side(Real(-1.0) * d, f.u, f.length, radius), true);
  return bounded(side_to_side(d, exact_difference(next.a, p.b), direction(p), f.u, f.length, radius), false);
}

/// The start of an entry, from the entry before it, as the sweep made it.
Bounded start_of(const Entry& before, const Entry& p, double radius) {
  const bool side = is_side(p.label);
  if (side && !is_side(before.label) && before.a == p.a) return {left_of(direction(p)), Real(0.0), Real(0.0)};
  if (!side && is_side(before.label) && before.label != left_half_line && before.b == p.a)
    return {left_of(direction(before)), Real(0.0), Real(0.0)};
  return start_after(before, side ? Later{p.a, p.b} : Later{p.a, p.a}, !side, radius);
}

int sign_beyond(Real value, Real tolerance) {
  return value > tolerance ? 1 : (value < -tolerance ? -1 : 0);
}

int covered(const Entry& before, const Entry& p, const Later& next, double r) {
  const Real radius = r;
  const Bounded start = start_of(before, p, r);
  const Frame<Real> f = frame_of(exact_difference(next.b, next.a));
  const Vec<Real> d = exact_difference(p.a, next.a);
  const Vec<Real> c = d + (radius * start.n + start.t * right_of(start.n));
  const Real along = dot(c, f.u);
  if (!(along > 0.0)) return c.x > 0.0 && dot(c, left_of(f.u)) < 0.0 ? 1 : -1;  // see Sweep::covered
  const Real tolerance = start.error + Real(32 * epsilon<Real>) * (extent(d) + radius + magnitude(start.t));
  if (along < f.length) return sign_beyond(radius - dot(c, left_of(f.u)), tolerance);
  const Vec<Real> q = c - f.length * f.u;
  if (q.y < 0.0) return 1;
  return sign_beyond(radius - root(dot(q, q)), tolerance);
}

int beyond(const Entry& p, const Later& next, double r) {
  const Real radius = r;
  const Frame<Real> f = frame_of(exact_difference(next.b, next.a));
  const Vec<Real> d = exact_difference(next.a, p.a);
  const Vec<Real> z = d + (f.length * f.u + radius * left_of(f.u));
  const Real tolerance = Real(32 * epsilon<Real>) * (extent(d) + radius + f.length);
  if (is_side(p.label)) return sign_beyond(radius - dot(z, left_of(direction(p))), tolerance);
  if (z.y < 0.0) return sign_beyond(radius - z.x, tolerance);
  if (z.x >= radius) return -1;
  return sign_beyond(radius - root(dot(z, z)), tolerance);
}

int turn(const Entry& before, const Entry& arc, const Later& next, double radius) {
  const Bounded start = start_of(before, arc, radius);
  const Real tolerance = start.error / Real(radius) + Real(16 * epsilon<Real>);
  return sign_beyond(cross(start.n, left_of(frame_of(exact_difference(next.b, next.a)).u)), tolerance);
}

/// True for a vector of doubles whose products neither over- nor underflow.
bool plain(Vec<Real> d) {
  const auto fine = [](Real x) {
    return x.low == 0 && (x.high == 0 || (std::fabs(x.high) > 1e-100 && std::fabs(x.high) < 1e100));
  };
  return fine(d.x) && fine(d.y);
}

/// Sign of the cross product of two segments' directions.
int direction_turn(const Entry& before, const Later& next) {
  const bool wall = before.label == left_half_line;
  const Vec<Real> d1 = wall ? Vec<Real>{0.0, 1.0} : exact_difference(before.b, before.a);
  const Vec<Real> d2 = exact_difference(next.b, next.a);
  if (plain(d1) && plain(d2)) {  // lattices: products of two doubles are exact, and compared exactly
    const Real first = Real::product(d1.x.high, d2.y.high), second = Real::product(d1.y.high, d2.x.high);
    return first > second ? 1 : (first < second ? -1 : 0);
  }
  const Vec<Real> e1 = near_one(d1).vec, e2 = near_one(d2).vec;
  const Real first = e1.x * e2.y, second = e1.y * e2.x;
  return sign_beyond(first - second, Real(8 * epsilon<Real>) * (magnitude(first) + magnitude(second)));
}

/// Normals with no turn between them are equal (0) or opposite. Opposite ones are horizontal: up then down is a spike that
/// shows its arc (-1), down then up a slit that is closed (1).
int opposite_or_equal(Point start_normal, Vec<double> d2) {
  const double cosine = start_normal.y * d2.x - start_normal.x * d2.y;
  if (cosine >= 0) return 0;
  return start_normal.x < 0 ? -1 : 1;
}

/// Whether p and `next` are walls at one place that go the same way, so that their offset sides lie on one line.
bool same_wall(const Entry& p, const Later& next) {
  const bool up = p.label == left_half_line || p.b.y > p.a.y;
  return is_side(p.label) && p.a.x == p.b.x && next.a.x == next.b.x && up == (next.b.y > next.a.y);
}

/// Whether the side of `next`, whose end is known to be on the line of p's side, lies on it as a whole, goes the same way
/// and reaches further: then it shows from where p ends.
bool goes_on(const Entry& p, const Later& next, double r) {
  if (!is_side(p.label)) return false;
  const Real radius = r;
  const Vec<Real> along = exact_difference(next.b, next.a), u = direction(p);
  const Vec<Real> d = exact_difference(next.a, p.a);
  const Real gap = radius - dot(d + radius * left_of(frame_of(along).u), left_of(u));
  if (magnitude(gap) > Real(32 * epsilon<Real>) * (extent(d) + radius)) return false;
  return dot(along, u) > 0.0 && dot(exact_difference(next.b, p.b), u) > 0.0;
}

/// Where two walls at one place overlap the earlier one stays, although the later one lies over its start too: the rule
/// must not depend on where the start is, or blocks would decide otherwise than the whole.
bool earlier_wall_stays(const Entry& before, const Entry& p, const Later& next, double radius) {
  if (!same_wall(p, next)) return false;
  const Real rest = magnitude(exact_difference(p.b, p.a).y) - start_of(before, p, radius).t;
  return rest > Real(32 * epsilon<Real>) * Real(radius + std::fabs(p.b.y - p.a.y));
}

}  // namespace

Start precise_start(const Entry& p, const Later& next, bool on_circle, double radius, ProfileCounters& counters) {
  ++counters.in_double_double;
  const double scale = radius + extent(difference<double>(on_circle ? next.b : next.a, p.a));
  const Bounded c = start_after(p, next, on_circle, radius);
  const double error = larger(double(c.error), 0x1p-50 * scale);
  return {{double(c.n.x), double(c.n.y)}, double(c.t), float(error)};
}

int precise_covered(const Entry& before, const Entry& p, const Later& next, double radius, ProfileCounters& counters) {
  ++counters.in_double_double;
  if (const int answer = covered(before, p, next, radius); answer != 0) return answer;
  ++counters.ties;
  return earlier_wall_stays(before, p, next, radius) ? -1 : 1;
}

int precise_beyond(const Entry& p, const Later& next, double radius, ProfileCounters& counters) {
  ++counters.in_double_double;
  if (const int answer = beyond(p, next, radius); answer != 0) return answer;
  ++counters.ties;
  return goes_on(p, next, radius) ? -1 : 1;
}

int precise_turn(const Entry& before, const Entry& arc, bool tangent, const Later& next, double radius,
                 ProfileCounters& counters) {
  ++counters.in_double_double;
  int answer = tangent ? direction_turn(before, next) : turn(before, arc, next, radius);
  if (answer == 0) answer = opposite_or_equal(arc.n, difference<double>(next.b, next.a));
  if (answer == 0) ++counters.ties;
  return answer;
}

}  // namespace krepl::profile
