#include "profile/sweep.hpp"

// A call in the innermost loop would pass points through memory.
#if defined(__GNUC__)
#define KREPL_INLINE [[gnu::always_inline]] inline
#else
#define KREPL_INLINE inline
#endif

namespace krepl::profile {

namespace {

constexpr double largest_coordinate = 1e140;
/// Below this the square of a length has lost digits, and the length is measured again with care.
constexpr double smallest_square = 1e-280;
/// Roundings of a test in double precision, of all numbers that go into it: sum of sizes times this.
constexpr double rounding = 32 * epsilon<double>;

/// Bound on the turn's sine where an arc starts with a segment's normal.
constexpr double smooth_turn_bound = 8 * epsilon<double>;

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
  turn_bound_ = smooth_turn_bound;
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

/// The state of the stack's top while a batch is appended, in registers: nothing here may be reached through `this`, or
/// every push would force it out to memory.
struct Sweep::Top {
  const double radius;
  Entry* arc;           // the arc about the last vertex
  bool tangent;
  double turn_bound;
  double last_length;
  std::uint64_t pops = 0, segments = 0;
  ProfileCounters& counters;

  struct Segment {
    Point v, w, n;
    double length;
    Label label;        // of the circle about w
    Vec<double> along() const { return right_of(vec(n)); }
    Later later() const { return {v, w}; }
  };

  KREPL_INLINE void insert(const Point w, const Point n, const double length, const Label label) {
    const Segment s{arc->a, w, n, length, label};
    ++segments;
    const double sine = arc->n.x * n.y - arc->n.y * n.x;
    if (sine < -turn_bound) return ridge(s);
    int turned = 1;
    if (!(sine > turn_bound)) [[unlikely]] {
      const bool flat = tangent && n.x == 0 && arc->n.x == 0;
      turned = flat ? 0 : precise_turn(arc[-1], *arc, tangent, s.later(), radius, counters);
      if (turned < 0) return ridge(s);
    }
    if (!short_valley(s, turned, sine)) valley(s);
  }

 private:
  KREPL_INLINE void put_side(Entry* e, const Segment& s, double t, float error) {
    *e = {s.v, s.w, s.n, t, s.label - 1, error};
  }
  /// The circle about s.w, entered smoothly from the side of s.
  KREPL_INLINE void put_end(Entry* e, const Segment& s) {
    *e = {s.w, s.w, s.n, 0, s.label, 0};
    arc = e;
    tangent = true;
    turn_bound = smooth_turn_bound;
    last_length = s.length;
  }

  /// As far as can be seen from here: the arc stays up to the new side, which shows from its first point.
  KREPL_INLINE void ridge(const Segment& s) {
    put_side(arc + 1, s, 0, 0);
    put_end(arc + 2, s);
  }

  /// The arc at v is hidden; both sides at v are long enough for their crossing. By far the most frequent valley.
  KREPL_INLINE bool short_valley(const Segment& s, int turned, double sine) {
    if (!tangent) return false;
    const Entry& side = arc[-1];
    const double cosine = side.n.x * s.n.x + side.n.y * s.n.y;
    double t = 0;
    if (turned != 0) {
      t = clamped(along_adjacent_side(sine, cosine, radius), 0.0, s.length);
      const double reach = t * (1 + 0x1p-30) + side.t + double(side.error) + 0x1p-40 * radius;
      if (!(cosine > least_adjacent_cosine && t < s.length * (1 - 0x1p-30) && reach < last_length)) return false;
    }
    const double scale = radius + extent(difference<double>(s.v, side.a));
    const double error = settled_error(adjacent_error * epsilon<double> * radius, 1, scale);
    put_side(arc, s, t, float(error));
    put_end(arc + 1, s);
    return true;
  }

  /// The arc at v is hidden: find the one crossing further left (thesis section 2.3).
  KREPL_INLINE void valley(const Segment& s) {
    Entry* p = arc - 1;
    while (p->label != left_half_line && covered(p, s)) --p;
    pops += static_cast<std::uint64_t>(arc - 1 - p);
    const bool on_circle = beyond(*p, s);
    const Start start = crossing(*p, s, on_circle);
    if (on_circle) {
      arc = p + 1;
      *arc = {s.w, s.w, start.n, 0, s.label, start.error};
      tangent = false;
      turn_bound = double(start.error) / radius + smooth_turn_bound;
    } else {
      put_side(p + 1, s, start.t, start.error);
      put_end(p + 2, s);
    }
  }

  /// Whether the start of p lies below the boundary of the sum of segment v w alone.
  KREPL_INLINE bool covered(const Entry* p, const Segment& s) {
    const Vec<double> d = difference<double>(p->a, s.v);
    const Vec<double> normal = vec(s.n);
    const double t = p->t;
    const Vec<double> c{d.x + (radius * p->n.x + t * p->n.y), d.y + (radius * p->n.y - t * p->n.x)};
    const double along = dot(c, s.along());
    // Behind v the segment's sum is v's own circle, which the boundary so far includes. On a wall going up, the far end of
    // that circle is neither behind v nor beyond it, but covered.
    if (!(along > 0)) return c.x > 0 && dot(c, normal) < 0;
    const double tolerance = double(p->error) + rounding * (extent(d) + radius + t);
    double gap = radius - dot(c, normal), bound = tolerance;
    if (along >= s.length) {
      const Vec<double> q = c - s.length * s.along();
      if (q.y < 0) return true;
      gap = radius * radius - dot(q, q);
      bound = tolerance * (2 * radius + extent(q));
    }
    if (std::fabs(gap) > bound) [[likely]] return gap > 0;
    return precise_covered(p[-1], *p, s.later(), radius, counters) > 0;
  }

  /// Whether the end of the offset side is still below the curve of p, so that the crossing lies on the circle about w.
  KREPL_INLINE bool beyond(const Entry& p, const Segment& s) {
    const Vec<double> d = difference<double>(s.v, p.a);
    const Vec<double> z = d + (s.length * s.along() + radius * vec(s.n));
    const double tolerance = rounding * (extent(d) + radius + s.length);
    double gap = radius - dot(z, vec(p.n));
    double bound = tolerance;
    if (!is_side(p.label)) {
      gap = radius - z.x;
      if (z.y >= 0) {
        gap = radius * radius - dot(z, z);
        bound = tolerance * (2 * radius + extent(z));
      }
    }
    if (std::fabs(gap) > bound) [[likely]] return gap > 0;
    return precise_beyond(p, s.later(), radius, counters) > 0;
  }

 public:
  /// Where s (its side, or the circle about its end) starts after p.
  KREPL_INLINE Start crossing(const Entry& p, const Segment& s, bool on_circle) {
    const Vec<double> d = difference<double>(on_circle ? s.w : s.v, p.a);
    const Vec<double> up = right_of(vec(p.n));
    Contact<double> c;
    if (is_side(p.label)) {
      c = on_circle ? side_to_circle(d, up, radius)
                    : side_to_side(d, difference<double>(s.v, p.b), up, s.along(), s.length, radius);
    } else {
      c = on_circle ? circle_to_circle(d, radius) : circle_to_side(-1.0 * d, s.along(), s.length, radius);
    }
    const double error = settled_error(c.numerator, c.denominator, radius + extent(d));
    if (error < std::numeric_limits<double>::infinity()) [[likely]]
      return {on_circle ? Point{c.n.x, c.n.y} : s.n, c.t, float(error)};
    Start precise = precise_start(p, s.later(), on_circle, radius, counters);
    if (!on_circle) precise.n = s.n;
    return precise;
  }
};

std::size_t Sweep::append(const Point* points, std::size_t count, std::uint32_t index) {
  if (count == 0) return 0;
  if (stack_.size() < top_ + 2 * batch + 4) stack_.resize(2 * stack_.size());
  const std::size_t good = measure(points, count);
  Top top{radius_, stack_.data() + top_, tangent_, turn_bound_, last_length_, 0, 0, counters_};
  for (std::size_t k = 0; k < good; ++k) {
    if (edges_.length[k] == 0) continue;
    top.insert(points[k], {edges_.nx[k], edges_.ny[k]}, edges_.length[k], 2 * (index + static_cast<std::uint32_t>(k)));
  }
  top_ = static_cast<std::size_t>(top.arc - stack_.data());
  tangent_ = top.tangent;
  turn_bound_ = top.turn_bound;
  last_length_ = top.last_length;
  counters_.pops += top.pops;
  counters_.segments += top.segments;
  counters_.largest_stack = std::max<std::uint64_t>(counters_.largest_stack, held());
  return good;
}

Start Sweep::crossing(const Entry& p, Point v, Point w, Point n, double length, bool on_circle) {
  Top top{radius_, nullptr, false, 0, 0, 0, 0, counters_};
  return top.crossing(p, {v, w, n, length, 0}, on_circle);
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

/// A block keeps all that the part left of it may still hide, and a few entries more to recognise agreement by; the last of
/// them shows after rounding, because a join at a seam behind a dropped piece is refused.
bool Sweep::hold_ends_at(std::size_t entry) {
  constexpr int spare = 4;
  const Point start = center_at_start(stack_[entry], radius_);
  if (!(start.x > hold_limit_) || ++beyond_limit_ <= spare) return false;
  const Entry& before = stack_[entry - 1];
  if (!runs_forward(before, center_at_start(before, radius_), start)) return false;
  holding_ = false;
  hold_ = entry;
  seam_ = start;
  emission_.begin(start);
  return true;
}

}  // namespace krepl::profile
