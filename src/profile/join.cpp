#include "profile/join.hpp"

// The boundary of the left part lies above that of the right part up to one crossing and below it from there on, because
// the touching place moves right with the disk. So the crossing is found by bisection on both sides.
//
// Only what is certain by a wide margin is answered here. Then no decision of a sweep over both parts together could have
// been different, and the crossing is computed from the same two elements by the same formula: the bits are the same.
// Everything else (ties on flat ground and lattices) is left to repeating the first segments of the right part.
namespace krepl::profile {

namespace {

/// What is nearer than this, times the sizes involved, is not certain.
constexpr double margin = 0x1p-32;

Vec<double> vec(Point p) { return {p.x, p.y}; }

int certain_sign(double value, double tolerance) { return value > tolerance ? 1 : (value < -tolerance ? -1 : 0); }

bool same_start(const Entry& e, const Entry& f) { return e.label == f.label && e.n == f.n && e.t == f.t; }

}  // namespace

Vec<double> Sweep::start_from(std::size_t entry, Point origin) const {
  const Entry& e = stack_[entry];
  return difference<double>(e.a, origin) + (radius_ * vec(e.n) + e.t * right_of(vec(e.n)));
}

/// Where the piece of an open entry ends.
Vec<double> Sweep::open_end_from(std::size_t entry, Point origin) const {
  if (entry + 1 < open_left_count()) return start_from(entry + 1, origin);
  if (!holding_ && hold_ > 0) return difference<double>(seam_, origin);
  return difference<double>(last_vertex(), origin) + Vec<double>{radius_, 0};
}

/// Whether a place (relative to origin) lies above the open boundary: 1 above, -1 below, 0 not certain. Beyond the right
/// end of the domain counts as above.
int Sweep::place_above(Vec<double> place, Point origin) const {
  const std::size_t first = emitted_begin(), last = open_left_count() - 1;
  const double reach = margin * (radius_ + extent(place));
  const double end = open_end_from(last, origin).x;
  if (place.x > end + reach) return 1;
  if (!(place.x > start_from(first, origin).x + reach)) return 0;
  std::size_t low = first, high = last + 1;  // the piece over place.x is in [low, high)
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (start_from(middle, origin).x <= place.x ? low : high) = middle;
  }
  if (place.x < start_from(low, origin).x + reach || place.x > open_end_from(low, origin).x - reach) return 0;
  const Entry& e = stack_[low];
  const Vec<double> c = place - difference<double>(e.a, origin);
  const double tolerance = margin * (radius_ + extent(c));
  if (is_side(e.label)) return certain_sign(dot(c, vec(e.n)) - radius_, tolerance);
  if (c.y < 0) return -1;
  return certain_sign(std::sqrt(dot(c, c)) - radius_, tolerance);
}

bool Sweep::find_splice(const Sweep& right, Splice& splice) {
  const Point origin = last_vertex();
  const std::size_t theirs = right.open_left_count();
  const Label shared = stack_[top_].label;
  if (theirs < 3 || size() < 3 || right.stack_[1].label != shared) return false;
  // The shared vertex's arc: the left part shows it from its own start on, the right part up to the next entry's start.
  const Vec<double> first_end = right.start_from(2, origin);
  const int order = certain_sign(cross(vec(stack_[top_].n), first_end), margin * radius_);
  if (order < 0) {
    splice = {size(), 2, false, {}};
    return true;
  }
  if (order == 0) return false;
  std::size_t low = 1, high = theirs - 1;  // the end of entry low is below the left part's boundary, that of high above
  if (place_above(right.open_end_from(high, origin), origin) != 1) return false;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    const int answer = place_above(right.open_end_from(middle, origin), origin);
    if (answer == 0) return false;
    (answer < 0 ? low : high) = middle;
  }
  std::size_t mine = emitted_begin(), hidden = top_;  // the start of hidden is below the right part's boundary
  while (hidden - mine > 1) {
    const std::size_t middle = mine + (hidden - mine) / 2;
    const Vec<double> start = start_from(middle, origin);
    const bool outside = start.x < -radius_ - margin * (radius_ + extent(start));
    const int answer = outside ? 1 : right.place_above(start, origin);
    if (answer == 0) return false;
    (answer > 0 ? mine : hidden) = middle;
  }
  return crossing_with(right, mine, high, splice);
}

/// The crossing of my entry with theirs, if it lies well inside both.
bool Sweep::crossing_with(const Sweep& right, std::size_t mine, std::size_t theirs, Splice& splice) {
  const Entry& p = stack_[mine];
  const Entry& q = right.stack_[theirs];
  if (p.label == left_half_line || q.label == left_half_line) return false;
  const bool on_circle = !is_side(q.label);
  const Vec<double> along = difference<double>(q.b, q.a);
  const double length = std::sqrt(dot(along, along));
  const Start c = crossing(p, q.a, on_circle ? q.a : q.b, q.n, length, on_circle);
  Entry e = q;
  e.n = c.n;
  e.t = c.t;
  e.error = c.error;
  const Vec<double> offset = radius_ * vec(e.n) + e.t * right_of(vec(e.n));  // from q.a
  const Vec<double> end = right.open_end_from(theirs, q.a);
  const Vec<double> from_p = difference<double>(q.a, p.a) + offset;
  const double tolerance = margin * (radius_ + extent(end) + extent(from_p) + p.t);
  const auto before = [&](bool side, Vec<double> first, Vec<double> second, Vec<double> u) {
    return side ? dot(second - first, u) > tolerance : cross(first, second) < -tolerance * radius_;
  };
  const Vec<double> start_p = radius_ * vec(p.n) + p.t * right_of(vec(p.n));
  const Vec<double> start_q = right.start_from(theirs, q.a);
  const Vec<double> uq = right_of(vec(q.n)), up = right_of(vec(p.n));
  if (!before(!on_circle, start_q, offset, uq) || !before(!on_circle, offset, end, uq) ||
      !before(is_side(p.label), start_p, from_p, up))
    return false;
  splice = {mine + 1, theirs + 1, true, e};
  return true;
}

/// Two neighbouring entries with the same starts in both: from there on both sweeps decide alike.
bool Sweep::find_agreement(const Sweep& right, Splice& splice) const {
  constexpr std::size_t depth = 64;
  const auto begin = right.stack_.begin();
  const auto end = begin + std::ptrdiff_t(right.open_left_count());
  for (std::size_t i = top_; i > emitted_ + 1 && i + depth > top_; --i) {
    const auto found = std::lower_bound(begin + 1, end, stack_[i].label,
                                        [](const Entry& e, Label label) { return e.label < label; });
    if (found == end || found - begin < 2) continue;
    if (!same_start(*found, stack_[i]) || !same_start(found[-1], stack_[i - 1])) continue;
    splice = {i + 1, std::size_t(found - begin) + 1, false, {}};
    return true;
  }
  return false;
}

/// Whether the last piece before those that `right` emitted stays, so that they start where they say.
bool Sweep::seam_is_clean(const Sweep& right, const Splice& splice) const {
  if (right.holding_) return true;
  Emission trial = emission_;
  const Entry* before = nullptr;
  const auto none = [](auto&&...) {};
  const auto pass = [&](const Entry& e) {
    if (before != nullptr) trial.piece(*before, center_at_start(e, radius_), none);
    before = &e;
  };
  for (std::size_t i = emitted_; i < splice.keep; ++i) pass(stack_[i]);
  if (splice.crossing) pass(splice.entry);
  for (std::size_t i = splice.from; i < right.hold_; ++i) pass(right.stack_[i]);
  if (before == nullptr) return false;
  trial.piece(*before, right.seam_, none);
  return !trial.carried();
}

void Sweep::splice_entries(const Sweep& right, const Splice& splice) {
  const std::size_t count = right.open_left_count() - splice.from;
  const std::size_t begin = splice.keep + (splice.crossing ? 1 : 0);
  if (stack_.size() < begin + count + 2 * batch + 4) stack_.resize(2 * (begin + count) + 4 * batch);
  if (splice.crossing) stack_[splice.keep] = splice.entry;
  std::copy_n(right.stack_.begin() + std::ptrdiff_t(splice.from), count, stack_.begin() + std::ptrdiff_t(begin));
  top_ = begin + count - 1;
  counters_.largest_stack = std::max<std::uint64_t>(counters_.largest_stack, held());
}

/// After all up to the seam was handed out: what `right` still has open is what is open here.
void Sweep::continue_as(const Sweep& right) {
  const std::size_t count = right.size() - right.hold_;
  if (stack_.size() < count + 2 * batch + 4) stack_.resize(2 * count + 4 * batch);
  std::copy_n(right.stack_.begin() + std::ptrdiff_t(right.hold_), count, stack_.begin());
  top_ = count - 1;
  emitted_ = right.emitted_ - right.hold_;
  const std::uint64_t dropped = emission_.dropped() + right.emission_.dropped();
  emission_ = right.emission_;
  emission_.set_dropped(dropped);
}

}  // namespace krepl::profile
