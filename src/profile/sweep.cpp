#include "profile/sweep.hpp"

namespace krepl::profile {

namespace {

constexpr double largest_coordinate = 1e140;
/// Below this the square of a length has lost digits, and the length is measured again with care.
constexpr double smallest_square = 1e-280;
/// Roundings of a test in double precision, of all numbers that go into it: sum of sizes times this.
constexpr double rounding = 32 * epsilon<double>;

Vec<double> vec(Point p) { return {p.x, p.y}; }

}  // namespace

void Sweep::start(double radius, Point first, std::uint32_t index, bool held) {
  radius_ = radius;
  if (stack_.size() < 2 * batch + 4) stack_.resize(8 * batch);
  stack_[0] = {first, first, {-1, 0}, 0, left_half_line, 0};
  stack_[1] = {first, first, {-1, 0}, 0, 2 * index, 0};
  top_ = 1;
  emitted_ = 0;
  tangent_ = true;
  turn_bound_ = 8 * epsilon<double>;
  last_length_ = 0;
  emission_ = {};
  counters_ = {};
  counters_.largest_stack = 2;
  holding_ = held;
  hold_ = 0;
  hold_limit_ = first.x + radius + 0x1p-40 * (std::fabs(first.x) + radius);
  beyond_limit_ = 0;
}

/// Lengths and unit normals of the next segments. Apart from the stack, so that the compiler packs divisions and roots.
std::size_t Sweep::measure(const Point* points, std::size_t count) {
  bool bad = false, small = false;
  Point before = last_vertex();
  const auto one = [&](std::size_t k, Point p, Point q) {
    const double dx = q.x - p.x, dy = q.y - p.y;
    const double square = dx * dx + dy * dy;
    const double length = std::sqrt(square);
    edges_.length[k] = length;
    edges_.nx[k] = -dy / length;
    edges_.ny[k] = dx / length;
    bad |= !(dx >= 0) | !(square <= largest_coordinate * largest_coordinate);
    small |= square < smallest_square;
  };
  one(0, before, points[0]);
  for (std::size_t k = 1; k < count; ++k) one(k, points[k - 1], points[k]);
  if (!bad && !small) [[likely]] return count;
  for (std::size_t k = 0; k < count; before = points[k++]) {
    const double dx = points[k].x - before.x, dy = points[k].y - before.y;
    if (!(dx >= 0 && dx <= largest_coordinate && std::fabs(dy) <= largest_coordinate)) return k;
    if (dx == 0 && dy == 0) {
      edges_.length[k] = 0;
    } else if (dx * dx + dy * dy < smallest_square) {
      const double big = std::max(dx, std::fabs(dy));
      const double sx = dx / big, sy = dy / big, s = std::sqrt(sx * sx + sy * sy);
      edges_.length[k] = s * big;
      edges_.nx[k] = -sy / s;
      edges_.ny[k] = sx / s;
    }
  }
  return count;
}

std::size_t Sweep::append(const Point* points, std::size_t count, std::uint32_t index) {
  if (count == 0) return 0;
  if (stack_.size() < top_ + 2 * batch + 4) stack_.resize(2 * stack_.size());
  const std::size_t good = measure(points, count);
  for (std::size_t k = 0; k < good; ++k)
    if (edges_.length[k] != 0) insert(k, points[k], 2 * (index + static_cast<std::uint32_t>(k)));
  counters_.largest_stack = std::max<std::uint64_t>(counters_.largest_stack, top_ + 1 - (emitted_ - std::min(emitted_, hold_)));
  return good;
}

inline void Sweep::put_circle(Entry* e, Point at, Point n, float error, Label label) {
  *e = {at, at, n, 0, label, error};
}

/// Appends the segment from the last vertex to w.
inline void Sweep::insert(std::size_t k, Point w, Label vertex_label) {
  const Point n{edges_.nx[k], edges_.ny[k]};
  const double length = edges_.length[k];
  ++counters_.segments;
  Entry* arc = &stack_[top_];
  const double sine = arc->n.x * n.y - arc->n.y * n.x;
  int turned = sine < -turn_bound_ ? -1 : 1;
  if (!(std::fabs(sine) > turn_bound_)) [[unlikely]] {
    turned = precise_turn(arc[-1], *arc, tangent_, {arc->a, w}, radius_, counters_);
  }
  if (turned >= 0) {
    insert_valley(w, n, length, vertex_label, turned, sine);
    return;
  }
  // A ridge as far as can be seen from here: the arc stays up to the new side, which shows from its first point.
  arc[1] = {arc->a, w, n, 0, vertex_label - 1, 0};
  put_circle(arc + 2, w, n, 0, vertex_label);
  top_ += 2;
  tangent_ = true;
  turn_bound_ = 8 * epsilon<double>;
  last_length_ = length;
}

/// The arc at the last vertex v is hidden by the segment v w: find the one crossing further left (thesis section 2.3).
void Sweep::insert_valley(Point w, Point n, double length, Label vertex_label, int turned, double sine) {
  Entry* slot = &stack_[top_];
  const Point v = slot->a;
  const Label side_label = vertex_label - 1;
  if (tangent_) {
    const Entry& side = slot[-1];
    const double cosine = side.n.x * n.x + side.n.y * n.y;
    const double t = turned == 0 ? 0 : clamped(along_adjacent_side(sine, cosine, radius_), 0.0, length);
    const double reach = t * (1 + 0x1p-30) + side.t + double(side.error) + 0x1p-40 * radius_;
    // Both sides long enough for their crossing: by far the most frequent valley.
    if (turned == 0 || (cosine > least_adjacent_cosine && t < length * (1 - 0x1p-30) && reach < last_length_)) {
      const double scale = radius_ + extent(difference<double>(v, side.a));
      const double error = settled_error(adjacent_error * epsilon<double> * radius_, 1, scale);
      *slot = {v, w, n, t, side_label, float(error)};
      put_circle(slot + 1, w, n, 0, vertex_label);
      ++top_;
      last_length_ = length;
      turn_bound_ = 8 * epsilon<double>;
      return;
    }
  }
  Entry* p = slot - 1;
  while (p->label != left_half_line && covered(p[-1], *p, v, w, n, length)) --p;
  counters_.pops += static_cast<std::uint64_t>(slot - 1 - p);
  slot = p + 1;
  const bool on_circle = beyond(*p, v, w, n, length);
  const Start start = crossing(*p, v, w, n, length, on_circle);
  if (on_circle) {
    put_circle(slot, w, start.n, start.error, vertex_label);
    tangent_ = false;
    turn_bound_ = circle_turn_bound(start.error);
  } else {
    *slot = {v, w, n, start.t, side_label, start.error};
    ++slot;
    put_circle(slot, w, n, 0, vertex_label);
    tangent_ = true;
    turn_bound_ = 8 * epsilon<double>;
    last_length_ = length;
  }
  top_ = static_cast<std::size_t>(slot - stack_.data());
}

/// Whether the start of p lies below the boundary of the sum of segment v w alone.
inline bool Sweep::covered(const Entry& before, const Entry& p, Point v, Point w, Point n, double length) {
  const Vec<double> d = difference<double>(p.a, v);
  const Vec<double> normal = vec(n), u = right_of(normal);
  const Vec<double> c{d.x + (radius_ * p.n.x + p.t * p.n.y), d.y + (radius_ * p.n.y - p.t * p.n.x)};
  // Behind v the segment's sum is v's own circle, which the boundary so far includes. On a wall going up, the far end of
  // that circle is neither behind v nor beyond it, but covered.
  const double along = dot(c, u);
  if (!(along > 0)) return c.x > 0 && dot(c, normal) < 0;
  const double tolerance = double(p.error) + rounding * (extent(d) + radius_ + p.t);
  double gap;
  if (along < length) {
    gap = radius_ - dot(c, normal);
  } else {
    const Vec<double> q = c - length * u;
    if (q.y < 0) return true;
    const double square = dot(q, q);
    gap = radius_ * radius_ - square;
    if (std::fabs(gap) > tolerance * (2 * radius_ + extent(q))) [[likely]] return gap > 0;
    return precise_covered(before, p, {v, w}, radius_, counters_) > 0;
  }
  if (std::fabs(gap) > tolerance) [[likely]] return gap > 0;
  return precise_covered(before, p, {v, w}, radius_, counters_) > 0;
}

/// Whether the end of v w's offset side is still below the curve of p, so that the crossing lies on the circle about w.
inline bool Sweep::beyond(const Entry& p, Point v, Point w, Point n, double length) {
  const Vec<double> d = difference<double>(v, p.a);
  const Vec<double> z = d + (length * right_of(vec(n)) + radius_ * vec(n));
  const double tolerance = rounding * (extent(d) + radius_ + length);
  double gap = radius_ - dot(z, vec(p.n));
  double bound = tolerance;
  if (!is_side(p.label)) {
    gap = radius_ - z.x;
    if (z.y >= 0) {
      gap = radius_ * radius_ - dot(z, z);
      bound = tolerance * (2 * radius_ + extent(z));
    }
  }
  if (std::fabs(gap) > bound) [[likely]] return gap > 0;
  return precise_beyond(p, {v, w}, radius_, counters_) > 0;
}

/// Where segment v w (its side, or the circle about w) starts after p.
Start Sweep::crossing(const Entry& p, Point v, Point w, Point n, double length, bool on_circle) {
  const Vec<double> d = difference<double>(on_circle ? w : v, p.a);
  const Vec<double> u = right_of(vec(n));
  Contact<double> c;
  if (is_side(p.label)) {
    const Vec<double> up = right_of(vec(p.n));
    c = on_circle ? side_to_circle(d, up, radius_)
                  : side_to_side(d, difference<double>(v, p.b), up, u, length, radius_);
  } else {
    c = on_circle ? circle_to_circle(d, radius_) : circle_to_side(-1.0 * d, u, length, radius_);
  }
  const double error = settled_error(c.numerator, c.denominator, radius_ + extent(d));
  if (error < std::numeric_limits<double>::infinity()) [[likely]]
    return {on_circle ? Point{c.n.x, c.n.y} : n, c.t, float(error)};
  Start precise = precise_start(p, {v, w}, on_circle, radius_, counters_);
  if (!on_circle) precise.n = n;
  return precise;
}

/// Takes emitted entries off the bottom; one stays, because the next one's start may have to be computed again from it.
void Sweep::compact() {
  constexpr std::size_t worth_it = 2048;
  if (holding_ || emitted_ < hold_ + worth_it || emitted_ - hold_ < (size() - hold_) / 2) return;
  const auto begin = stack_.begin();
  const std::size_t first = emitted_ - 1;
  std::copy(begin + std::ptrdiff_t(first), begin + std::ptrdiff_t(size()), begin + std::ptrdiff_t(hold_));
  top_ -= first - hold_;
  emitted_ = hold_ + 1;
}

/// A block keeps all that the part left of it may still hide, and a few entries more to recognise agreement by.
bool Sweep::hold_ends_at(std::size_t entry) {
  constexpr int spare = 4;
  const Point start = center_at_start(stack_[entry], radius_);
  if (!(start.x > hold_limit_) || ++beyond_limit_ <= spare) return false;
  holding_ = false;
  hold_ = entry;
  seam_ = start;
  emission_.begin(start);
  return true;
}

}  // namespace krepl::profile
