#include "profile/ladder.hpp"

#include "profile/contact.hpp"

namespace krepl::profile {

namespace {

template <class Real>
struct Frame {
  Vec<Real> u;
  Real length;
};

template <class Real>
Frame<Real> frame_of(Point a, Point b) {
  const Vec<Real> d = difference<Real>(b, a);
  const Real length = root(dot(d, d));
  return {(1 / length) * d, length};
}

template <class Real>
Vec<Real> direction(const Entry& side) {
  if (side.label == left_half_line) return {Real(0), Real(1)};
  return frame_of<Real>(side.a, side.b).u;
}

/// A contact with a plain bound on its error along the curve.
template <class Real>
struct Bounded {
  Vec<Real> n;
  Real t;
  Real error;
};

/// Near a double root (a circle that just touches) the quotient is unbounded, but its square root never is.
template <class Real>
Bounded<Real> bounded(const Contact<Real>& c, bool double_root) {
  const Real square_root = root(2 * c.numerator);
  Real error = c.denominator > 0 ? c.numerator / c.denominator : Real(std::numeric_limits<double>::infinity());
  if (double_root && !(error < square_root)) error = square_root;
  return {c.n, c.t, error};
}

template <class Real>
Bounded<Real> start_after(const Entry& p, const Later& next, bool on_circle, double r) {
  const Real radius = Real(r);
  const Point at = on_circle ? next.b : next.a;
  const Vec<Real> d = difference<Real>(at, p.a);
  if (p.label == left_half_line && on_circle) return {{Real(-1), Real(0)}, Real(0), Real(0)};
  if (on_circle) {
    if (!is_side(p.label)) return bounded(circle_to_circle(d, radius), true);
    return bounded(side_to_circle(d, direction<Real>(p), radius), true);
  }
  const Frame<Real> f = frame_of<Real>(next.a, next.b);
  if (!is_side(p.label)) return bounded(circle_to_side(Real(-1) * d, f.u, f.length, radius), true);
  return bounded(side_to_side(d, difference<Real>(next.a, p.b), direction<Real>(p), f.u, f.length, radius), false);
}

/// The start of an entry, from the entry before it, as the sweep made it.
template <class Real>
Bounded<Real> start_of(const Entry& before, const Entry& p, double radius) {
  const bool side = is_side(p.label);
  if (side && !is_side(before.label) && before.a == p.a) return {left_of(direction<Real>(p)), Real(0), Real(0)};
  if (!side && is_side(before.label) && before.label != left_half_line && before.b == p.a)
    return {left_of(direction<Real>(before)), Real(0), Real(0)};
  return start_after<Real>(before, side ? Later{p.a, p.b} : Later{p.a, p.a}, !side, radius);
}

template <class Real>
int sign_beyond(Real value, Real tolerance) {
  return value > tolerance ? 1 : (value < -tolerance ? -1 : 0);
}

template <class Real>
int covered(const Entry& before, const Entry& p, const Later& next, double r) {
  const Real radius = Real(r);
  const Bounded<Real> start = start_of<Real>(before, p, r);
  const Frame<Real> f = frame_of<Real>(next.a, next.b);
  const Vec<Real> d = difference<Real>(p.a, next.a);
  const Vec<Real> c = d + (radius * start.n + start.t * right_of(start.n));
  const Real along = dot(c, f.u);
  if (!(along > 0)) return c.x > 0 && dot(c, left_of(f.u)) < 0 ? 1 : -1;  // see Sweep::covered
  const Real tolerance = start.error + Real(32 * epsilon<Real>) * (extent(d) + radius + magnitude(start.t));
  if (along < f.length) return sign_beyond(radius - dot(c, left_of(f.u)), tolerance);
  const Vec<Real> q = c - f.length * f.u;
  if (q.y < 0) return 1;
  return sign_beyond(radius - root(dot(q, q)), tolerance);
}

template <class Real>
int beyond(const Entry& p, const Later& next, double r) {
  const Real radius = Real(r);
  const Frame<Real> f = frame_of<Real>(next.a, next.b);
  const Vec<Real> d = difference<Real>(next.a, p.a);
  const Vec<Real> z = d + (f.length * f.u + radius * left_of(f.u));
  const Real tolerance = Real(32 * epsilon<Real>) * (extent(d) + radius + f.length);
  if (is_side(p.label)) return sign_beyond(radius - dot(z, left_of(direction<Real>(p))), tolerance);
  if (z.y < 0) return sign_beyond(radius - z.x, tolerance);
  if (z.x >= radius) return -1;
  return sign_beyond(radius - root(dot(z, z)), tolerance);
}

template <class Real>
int turn(const Entry& before, const Entry& arc, const Later& next, double radius) {
  const Bounded<Real> start = start_of<Real>(before, arc, radius);
  const Real tolerance = start.error / Real(radius) + Real(16 * epsilon<Real>);
  return sign_beyond(cross(start.n, left_of(frame_of<Real>(next.a, next.b).u)), tolerance);
}

struct Product {
  double high, low;
};

/// a * b without rounding (Dekker), barring under- and overflow, which the caller excludes.
Product exact_product(double a, double b) {
  constexpr double splitter = 0x1p27 + 1;
  const double ca = splitter * a, ah = ca - (ca - a), al = a - ah;
  const double cb = splitter * b, bh = cb - (cb - b), bl = b - bh;
  const double high = a * b;
  return {high, ((ah * bh - high) + ah * bl + al * bh) + al * bl};
}

/// True if x - y is exactly d.
bool exact_difference(double x, double y, double d) {
  const double back = x - d, rest = d + back - x;
  return back == y && rest == 0;
}

/// Sign of the cross product of two segments' directions. On lattices it is zero all the time, so it must be cheap there.
int direction_turn(Vec<double> d1, bool exact1, const Entry& before, const Later& next, ProfileCounters& counters) {
  const Vec<double> d2 = difference<double>(next.b, next.a);
  if (d1.y == 0 && d2.y == 0) return 0;
  const Product p = exact_product(d1.x, d2.y), q = exact_product(d1.y, d2.x);
  const double big = larger(magnitude(p.high), magnitude(q.high));
  const bool exact = exact1 && exact_difference(next.b.x, next.a.x, d2.x) && exact_difference(next.b.y, next.a.y, d2.y);
  if (exact && big < 1e250 && (big == 0 || big > 1e-200)) {
    const double high = p.high - q.high;
    if (high != 0) return high > 0 ? 1 : -1;  // the low parts are below half a unit of the high ones
    return p.low > q.low ? 1 : (p.low < q.low ? -1 : 0);
  }
  ++counters.in_quadruple;
  const bool wall = before.label == left_half_line;
  const Vec<quad> e1 = wall ? Vec<quad>{0, 1} : difference<quad>(before.b, before.a);
  const Vec<quad> e2 = difference<quad>(next.b, next.a);
  const quad first = e1.x * e2.y, second = e1.y * e2.x;
  return sign_beyond(first - second, quad(8 * epsilon<quad>) * (magnitude(first) + magnitude(second)));
}

/// Opposite directions can only be vertical: up then down is a spike that shows its arc, down then up is closed.
int opposite_or_equal(const Point& start_normal, Vec<double> d2) {
  if (d2.x != 0) return 0;
  const bool up_before = start_normal.x < 0, up_after = d2.y > 0;
  if (up_before == up_after) return 0;
  return up_before ? -1 : 1;
}

}  // namespace

Start precise_start(const Entry& p, const Later& next, bool on_circle, double radius, ProfileCounters& counters) {
  ++counters.in_long_double;
  const double scale = radius + extent(difference<double>(on_circle ? next.b : next.a, p.a));
  const Bounded<long double> c = start_after<long double>(p, next, on_circle, radius);
  if (c.error <= 0x1p-50L * scale) return {{double(c.n.x), double(c.n.y)}, double(c.t), float(0x1p-50 * scale)};
  ++counters.in_quadruple;
  const Bounded<quad> q = start_after<quad>(p, next, on_circle, radius);
  const double error = larger(double(q.error), 0x1p-50 * scale);
  return {{double(q.n.x), double(q.n.y)}, double(q.t), float(error)};
}

int precise_covered(const Entry& before, const Entry& p, const Later& next, double radius, ProfileCounters& counters) {
  ++counters.in_long_double;
  if (const int answer = covered<long double>(before, p, next, radius); answer != 0) return answer;
  ++counters.in_quadruple;
  if (const int answer = covered<quad>(before, p, next, radius); answer != 0) return answer;
  ++counters.ties;
  return 1;
}

int precise_beyond(const Entry& p, const Later& next, double radius, ProfileCounters& counters) {
  ++counters.in_long_double;
  if (const int answer = beyond<long double>(p, next, radius); answer != 0) return answer;
  ++counters.in_quadruple;
  if (const int answer = beyond<quad>(p, next, radius); answer != 0) return answer;
  ++counters.ties;
  return -1;
}

int precise_turn(const Entry& before, const Entry& arc, bool tangent, const Later& next, double radius,
                 ProfileCounters& counters) {
  int answer;
  if (tangent) {
    const bool wall = before.label == left_half_line;
    const Vec<double> d1 = wall ? Vec<double>{0, 1} : difference<double>(before.b, before.a);
    const bool exact = wall || (exact_difference(before.b.x, before.a.x, d1.x) &&
                                exact_difference(before.b.y, before.a.y, d1.y));
    answer = direction_turn(d1, exact, before, next, counters);
  } else {
    ++counters.in_long_double;
    answer = turn<long double>(before, arc, next, radius);
    if (answer == 0) {
      ++counters.in_quadruple;
      answer = turn<quad>(before, arc, next, radius);
    }
  }
  if (answer == 0) answer = opposite_or_equal(arc.n, difference<double>(next.b, next.a));
  if (answer == 0) ++counters.ties;
  return answer;
}

}  // namespace krepl::profile
