#include <algorithm>

#include "terrain/envelope.hpp"

// Labels along a line.
namespace krepl::terrain {

template <class Real>
struct Envelope<Real>::Line {
  bool vertical;
  Real at;
  Point point(Real t) const { return vertical ? Point{at, t} : Point{t, at}; }
  Box box(Real t0, Real t1) const { return {point(t0), point(t1)}; }
};

template <class Real>
void Envelope<Real>::section(bool vertical, double at, double from, double to, Index start, Index end,
                             std::span<const Index> candidates, std::vector<LineCrossing>& out) {
  ++counters_.lines;
  out_ = &out;
  stack_.assign(candidates.begin(), candidates.end());
  const std::size_t before = out.size();
  section(Line{vertical, at}, from, start, to, end, 0, 0);
  drop_slivers(Line{vertical, at}, start, before, out);
}

/// Where patches are equally high along a curve, or tangent to each other's borders, rounding alone decides what shows
/// between them.
template <class Real>
void Envelope<Real>::drop_slivers(const Line& line, Index start, std::size_t first,
                                  std::vector<LineCrossing>& crossings) const {
  std::size_t kept = first;
  const auto label_before = [&](std::size_t i) { return i == first ? start : crossings[i - 1].after; };
  const auto unit_across = [&](Index before, const LineCrossing& c) -> Gradient {
    const Gradient g = gradient_across(before, c.after, c.meeting, line.point(c.t));
    const Real length = size(g);
    return length > 0 ? Gradient{g.x / length, g.y / length} : Gradient{0, 0};
  };
  // What is between the last crossing kept and the i-th. A line may run aslant through what is thin, and what is steep
  // is thicker on the surface than it is wide in the plane.
  const auto is_thin = [&](std::size_t i) {
    const LineCrossing &a = crossings[kept - 1], &b = crossings[i];
    const Real along = b.t - a.t;
    if (along > 0x1p12 * tolerance_) return false;
    const Gradient slope = a.after == none ? Gradient{0, 0} : patches_.gradient(a.after, line.point((a.t + b.t) / 2));
    // What lies in a gap may be left out where that is twice the tolerance wide (back_to_back): no gap may show so narrow.
    const Real narrow = (a.after == none ? 4 : 1) * tolerance_;
    for (const Gradient n : {unit_across(label_before(kept - 1), a), unit_across(a.after, b)}) {
      if (n.x == 0 && n.y == 0) {
        if (along >= narrow) return false;
        continue;
      }
      const Real width = along * absolute(line.vertical ? n.y : n.x), rise = absolute(slope.x * n.x + slope.y * n.y);
      if (width >= narrow || width * rise >= thickness_) return false;
    }
    return true;
  };
  // A patch that ends in a wall falls like a root there: what of it lies beside the wall is much taller than it is
  // wide.
  const auto is_tall = [&](std::size_t i) {  // between the last crossing kept and the i-th
    const LineCrossing &a = crossings[i - 1], &b = crossings[i];
    const bool ends_first = a.meeting == Meeting::rim;
    if (a.after == none || ends_first == (b.meeting == Meeting::rim)) return false;
    const Point wall = line.point(ends_first ? a.t : b.t);
    if (rim_at(a.after, wall) == nullptr) return false;
    const Index beyond = ends_first ? label_before(i - 1) : b.after;
    return beyond == none || rim_height(a.after, wall) > border_height(beyond, wall);
  };
  for (std::size_t i = first; i < crossings.size(); ++i) {
    crossings[kept] = crossings[i];
    if (kept > first && is_thin(kept) && !is_tall(kept)) {
      --kept;
      const Index before = label_before(kept), after = crossings[kept + 1].after;
      if (before == after) continue;
      const bool was_gap = crossings[kept].after == none;
      crossings[kept].after = after;
      crossings[kept].meeting = was_gap ? Meeting::rim : meeting(before, after, line.point(crossings[kept].t));
    }
    ++kept;
  }
  crossings.resize(kept);
}

/// True if a stretch of a line is nowhere inside the strip or disc of a cylinder or sphere, as where it runs along its rim.
template <class Real>
bool Envelope<Real>::misses(const Line& line, Real t0, Real t1, Index i) const {
  const Patch& p = patches_[i];
  const Real radius = patches_.radius();
  if (p.kind == Terrain::FeatureKind::face) return false;
  if (p.kind == Terrain::FeatureKind::vertex) return absolute(line.at - (line.vertical ? p.at.x : p.at.y)) >= radius;
  return p.is_clear_of(line.point(t0), line.point(t1), radius);
}

/// The label at a place where no patch is but a body of a label at an end of the stretch: two patches next to each other may hide
/// each other but for less than is told apart. A body is of the vertices and edges around its patch, too, and these go first.
template <class Real>
Index Envelope<Real>::body_at(Point p, std::span<const Index> ends, std::span<const Index> candidates) const {
  Index best = none;
  Real highest = below_everything;
  for (const Index l : ends) {
    const Real height = l == none ? below_everything : patches_.body_height(l, p);
    if (height > highest) highest = height, best = l;
  }
  if (best == none) return none;
  for (const Index c : candidates) {
    if (patches_[c].kind < patches_[best].kind && patches_.body_height(c, p) >= highest - noise_) best = c;
  }
  return best;
}

/// stack_[first ..]: the candidates of the stretch around this one.
template <class Real>
void Envelope<Real>::section(const Line& line, Real t0, Index l0, Real t1, Index l1, std::size_t first, int depth) {
  const std::size_t begin = stack_.size();
  const std::array<Index, 2> ends{l0, l1};
  std::array<Index, 2> champions;
  int count = 0;
  for (const Index l : ends) {
    if (l != none && (count == 0 || champions[0] != l)) champions[count++] = l;
  }
  const auto has_others = [&](std::size_t from) {
    return std::any_of(stack_.begin() + std::ptrdiff_t(from), stack_.end(), [&](Index c) { return c != l0 && c != l1; });
  };
  bool others = has_others(first);
  if (others) {
    // filter() appends to the vector it reads from.
    kept_.clear();
    filter(line.box(t0, t1), {champions.data(), std::size_t(count)}, {stack_.data() + first, begin - first}, kept_);
    stack_.insert(stack_.end(), kept_.begin(), kept_.end());
    others = has_others(begin);
  } else {
    stack_.insert(stack_.end(), stack_.begin() + std::ptrdiff_t(first), stack_.begin() + std::ptrdiff_t(begin));
  }
  const bool tiny = t1 - t0 <= smallest_stretch_ || depth > 100;
  if (l0 == l1 && (tiny || (!others && l0 != none))) {
    // One label only: its domain may have a notch, but then another label would be left.
    stack_.resize(begin);
    return;
  }
  if (l0 == l1) {
    const auto keeps_out = [&](Index c) { return c != l0 && misses(line, t0, t1, c); };
    stack_.erase(std::remove_if(stack_.begin() + std::ptrdiff_t(begin), stack_.end(), keeps_out), stack_.end());
    if (!has_others(begin)) {
      stack_.resize(begin);
      return;
    }
  }
  if (l0 != l1 && (tiny || (!others && single_crossing(line, t0, l0, t1, l1)))) {
    Meeting how = Meeting::rim;
    const Real t = tiny ? (t0 + t1) / 2 : locate(line, t0, l0, t1, l1, how);
    if (tiny) how = meeting(l0, l1, line.point(t));
    out_->push_back({double(t), l1, how});
    stack_.resize(begin);
    return;
  }
  const auto left = [&] { return std::span<const Index>(stack_.data() + begin, stack_.size() - begin); };
  if (t1 - t0 <= fine_cell_ && finer_ != nullptr) {
    // Also what reaches into the stretch by less than matters in double.
    for (int k = 0; k < count; ++k) {
      if (std::find(stack_.begin() + std::ptrdiff_t(begin), stack_.end(), champions[k]) == stack_.end())
        stack_.push_back(champions[k]);
    }
    finer(left())->section(line.vertical, double(line.at), double(t0), double(t1), l0, l1, left(), *out_);
    stack_.resize(begin);
    return;
  }
  const Real tm = t0 + (t1 - t0) / 2;
  Index lm = winner(line.point(tm), left());
  if (lm == none) lm = body_at(line.point(tm), ends, left());
  section(line, t0, l0, tm, lm, begin, depth + 1);
  section(line, tm, lm, t1, l1, begin, depth + 1);
  stack_.resize(begin);
}

/// True if the domain of the first label, which holds t0, ends before that of the second begins, which holds t1.
template <class Real>
bool Envelope<Real>::gap(const Line& line, Real t0, Index l0, Real t1, Index l1) const {
  const auto last_within = [&](Real inside, Real outside, Index l) {
    for (int i = 0; i < 60 && absolute(outside - inside) > tolerance_ / 4; ++i) {
      const Real m = inside + (outside - inside) / 2;
      (patches_.contains(l, line.point(m)) ? inside : outside) = m;
    }
    return inside;
  };
  return last_within(t1, t0, l1) - last_within(t0, t1, l0) > 4 * tolerance_;
}

/// True if the two labels, the only ones left, certainly change once. Concave heights have descending derivatives.
template <class Real>
bool Envelope<Real>::single_crossing(const Line& line, Real t0, Index l0, Real t1, Index l1) const {
  if (l0 == none || l1 == none) return t1 - t0 < patches_.radius() / 16;
  if (patches_.seam(l0, l1) != nullptr) return true;
  const Point p = line.point(t0), q = line.point(t1);
  const auto slope = [&](Index l, Point at) {
    const Gradient g = patches_.gradient(l, at);
    return line.vertical ? g.y : g.x;
  };
  const bool first_covers = patches_.contains(l0, q), second_covers = patches_.contains(l1, p);
  if (!first_covers || !second_covers)
    return t1 - t0 < patches_.radius() / 16 && (first_covers || second_covers || !gap(line, t0, l0, t1, l1));
  const Range first{slope(l0, q), slope(l0, p)}, second{slope(l1, q), slope(l1, p)};
  return (second - first).excludes_zero();
}

/// Where a function with values of different sign at a and b is zero, by the secant.
template <class Real>
template <class Function>
Real Envelope<Real>::root(const Function& value, Real a, Real fa, Real b, Real fb) const {
  // Illinois: halving the value of the end that stays so that both ends move.
  Real last = (a + b) / 2;
  for (int i = 0, side = 0; i < 80; ++i) {
    Real m = a - fa * (b - a) / (fb - fa);
    if (!(m > a)) return a;  // but for rounding it lies between
    if (!(m < b)) return b;
    if (i % 16 == 15) m = a + (b - a) / 2;
    if (absolute(m - last) <= smallest_stretch_) break;
    last = m;
    const Real fm = value(m);
    if (fm == 0) break;
    if ((fm > 0) == (fa > 0)) {
      a = m;
      fa = fm;
      if (side < 0) fb /= 2;
      side = -1;
    } else {
      b = m;
      fb = fm;
      if (side > 0) fa /= 2;
      side = 1;
    }
  }
  return last;
}

/// The place of the one change from l0 to l1: where the function that they share is zero, or the heights are equal, else by
/// bisection.
template <class Real>
Real Envelope<Real>::locate(const Line& line, Real t0, Index l0, Real t1, Index l1, Meeting& how) const {
  const Bound* seam = l0 != none && l1 != none ? patches_.seam(l0, l1) : nullptr;
  const bool heights = seam == nullptr && l0 != none && l1 != none;
  const auto value = [&](Real t) {  // positive on the side of l0
    const Point p = line.point(t);
    if (seam != nullptr) return -seam->sign() * seam->value(p, patches_.square_radius());
    return patches_.extended_height(l0, p) - patches_.extended_height(l1, p);
  };
  const Index two[2] = {l0, l1};
  const std::span<const Index> both(two + (l0 == none), (l0 != none) + (l1 != none));
  Real a = t0, b = t1, fa = 0, fb = 0;
  bool smooth = seam != nullptr || heights;
  if (smooth) {
    fa = value(a);
    fb = value(b);
    smooth = is_finite(fa) && is_finite(fb) && ((fa > 0) != (fb > 0));
  }
  if (smooth) {
    const Real t = root(value, a, fa, b, fb);
    const Point p = line.point(t);
    // The domains of both reach as far as where the heights are equal, or one of them ends before.
    if (seam != nullptr || (patches_.contains(l0, p) && patches_.contains(l1, p))) {
      how = seam != nullptr ? Meeting::seam : Meeting::valley;
      if (how == Meeting::seam) return t;
      const Gradient g = patches_.gradient(l0, p), h = patches_.gradient(l1, p);
      const Real slope = line.vertical ? g.y - h.y : g.x - h.x;
      if (!(noise_ * (1 + size(g)) > tolerance_ * absolute(slope))) return t;
      if (Envelope<DoubleDouble>* finer = this->finer(two))
        return Real(double(finer->locate({line.vertical, line.at}, a, l0, b, l1, how)));
      return t;
    }
  }
  for (int i = 0; i < 60 && b - a > smallest_stretch_; ++i) {
    const Real m = a + (b - a) / 2;
    if (m == a || m == b) break;
    (winner(line.point(m), both, false) == l0 ? a : b) = m;  // where rounding decides, it may
  }
  // Where the one ends before the other begins there is a gap between two walls, if too narrow to show, or a patch that is as high
  // as both.
  const auto is_gap_at = [&](Point p) {
    return !patches_.contains(l0, p) && !patches_.contains(l1, p) && (is_beyond_wall(l0, p) || is_beyond_wall(l1, p));
  };
  const bool is_gap = l0 != none && l1 != none && is_gap_at(line.point(b));
  how = is_gap ? Meeting::rim : meeting(l0, l1, line.point((a + b) / 2));
  return a + (b - a) / 2;
}

template class Envelope<double>;
template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
