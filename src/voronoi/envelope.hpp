#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "voronoi/sites.hpp"

namespace krepl::voronoi {

template <class Real>
Real infinite() {
  return Real(std::numeric_limits<double>::infinity());
}

/// Where one curve is nearer than another: at most two stretches of the parameter, in order.
template <class Real>
struct Stretches {
  struct Stretch {
    Real low, high;
  };
  Stretch stretch[2];
  int count = 0;

  static Stretches all() { return between(-infinite<Real>(), infinite<Real>()); }
  static Stretches nowhere() { return {}; }
  static Stretches between(Real low, Real high) {
    Stretches s;
    s.stretch[0] = {low, high};
    s.count = 1;
    return s;
  }
  static Stretches outside(Real low, Real high) {
    Stretches s;
    s.stretch[0] = {-infinite<Real>(), low};
    s.stretch[1] = {high, infinite<Real>()};
    s.count = 2;
    return s;
  }
};

/// The face of one site, as the lower envelope of its bisectors with all others over the site's own parameter (the
/// place along a side, the direction from a vertex). `Curve` has a label, none for the horizon; `nearer(b, a)` tells
/// where b lies below a.
template <class Real, class Curve>
class Envelope {
 public:
  struct Arc {
    Real begin, end;
    Curve curve;
  };

  void start(Real low, Real high, const Curve& horizon) {
    arcs_.clear(), done_.clear(), waiting_.clear(), waiting_begin_.clear();
    arcs_.push_back({low, high, horizon});
  }
  /// Those of the piece in work: all, unless split() was called.
  const std::vector<Arc>& arcs() const { return arcs_; }

  /// A border of many arcs is worked at in pieces, or each new one would move all others along. The second half of the
  /// arcs waits from now on.
  void split() {
    const auto half = arcs_.begin() + std::ptrdiff_t(arcs_.size() / 2);
    waiting_begin_.push_back(waiting_.size());
    waiting_.insert(waiting_.end(), half, arcs_.end());
    arcs_.erase(half, arcs_.end());
  }
  /// The piece in work is done; the next one that waits is taken up. False if there is none: all arcs are together again.
  bool next_piece() {
    auto first = arcs_.begin();
    if (first_joins_before()) done_.back().end = first->end, ++first;
    done_.insert(done_.end(), first, arcs_.end());
    arcs_.clear();
    if (waiting_begin_.empty()) {
      arcs_.swap(done_);
      return false;
    }
    arcs_.assign(waiting_.begin() + std::ptrdiff_t(waiting_begin_.back()), waiting_.end());
    waiting_.erase(waiting_.begin() + std::ptrdiff_t(waiting_begin_.back()), waiting_.end());
    waiting_begin_.pop_back();
    return true;
  }
  /// The arcs beside the piece in work; null at the border's ends.
  const Arc* arc_before() const { return done_.empty() ? nullptr : &done_.back(); }
  const Arc* arc_after() const { return waiting_begin_.empty() ? nullptr : &waiting_[waiting_begin_.back()]; }

  /// Takes the minimum with a curve that is defined between low and high. Returns true if anything changed.
  bool insert(const Curve& curve, Real low, Real high) {
    if (!(low < high)) return false;
    wins_.clear();
    const auto reached = std::partition_point(arcs_.begin(), arcs_.end(), [&](const Arc& a) { return !(a.end > low); });
    first_ = std::size_t(reached - arcs_.begin());
    for (std::size_t i = first_; i < arcs_.size() && arcs_[i].begin < high; ++i)
      wins_.push_back(win(arcs_[i], curve, low, high));
    for (std::size_t k = 0; k + 1 < wins_.size(); ++k)
      agree(arcs_[first_ + k], wins_[k], arcs_[first_ + k + 1], wins_[k + 1]);
    if (std::none_of(wins_.begin(), wins_.end(), [](const Win& w) { return w.holds[0] || w.holds[1]; })) return false;
    const std::size_t from = first_ > 0 ? first_ - 1 : 0;  // what changes may go on from the arc before
    next_.assign(arcs_.begin() + std::ptrdiff_t(from), arcs_.begin() + std::ptrdiff_t(first_));
    for (std::size_t k = 0; k < wins_.size(); ++k) cut(arcs_[first_ + k], wins_[k], curve);
    replace(from, first_ + wins_.size());
    return true;
  }

 private:
  bool first_joins_before() const {
    return !done_.empty() && done_.back().curve.label == arcs_.front().curve.label;
  }
  /// Puts next_ in the place of the arcs from `from` to before `to`: a face may have thousands.
  void replace(std::size_t from, std::size_t to) {
    const std::size_t common = std::min(to - from, next_.size());
    const auto at = arcs_.begin() + std::ptrdiff_t(from), rest = next_.begin() + std::ptrdiff_t(common);
    std::copy(next_.begin(), rest, at);
    const auto end = at + std::ptrdiff_t(common);
    if (common < to - from) arcs_.erase(end, arcs_.begin() + std::ptrdiff_t(to));
    else arcs_.insert(end, rest, next_.end());
  }

  /// Where the new curve is nearer than an arc's, before and after it is cut to the arc.
  struct Win {
    Stretches<Real> whole;
    Real from[2], to[2];
    bool holds[2] = {false, false};
  };

  static Win win(const Arc& arc, const Curve& curve, Real low, Real high) {
    Win w;
    w.whole = nearer(curve, arc.curve);
    const Real u = std::max(arc.begin, low), v = std::min(arc.end, high);
    for (int i = 0; i < w.whole.count; ++i) {
      w.from[i] = std::max(u, w.whole.stretch[i].low), w.to[i] = std::min(v, w.whole.stretch[i].high);
      w.holds[i] = w.from[i] < w.to[i];
    }
    return w;
  }

  /// The distance of a place from the nearest end of a stretch.
  static Real margin(const Win& w, Real x) {
    Real least = infinite<Real>();
    for (int i = 0; i < w.whole.count; ++i) {
      least = std::min({least, distance(w.whole.stretch[i].low, x), distance(w.whole.stretch[i].high, x)});
    }
    return least;
  }
  static bool join(Real a, Real b) {
    const Real near = std::sqrt(kernel::unit_roundoff<Real>) * 0x1p-12;
    return distance(a, b) <= near * std::max(a, b);
  }
  static Real distance(Real a, Real b) { return a < b ? b - a : a - b; }

  /// Where two arcs are equally high at their common end, the new curve wins over both there or over none. Where
  /// rounding says otherwise, a stretch that is shorter than the other arc's margin is none.
  static void agree(const Arc& before, Win& left, const Arc& after, Win& right) {
    const Real x = after.begin;
    const int l = left.holds[1] && left.to[1] == x ? 1 : (left.holds[0] && left.to[0] == x ? 0 : -1);
    const int r = right.holds[0] && right.from[0] == x ? 0 : (right.holds[1] && right.from[1] == x ? 1 : -1);
    if ((l >= 0) == (r >= 0) || !join(before.curve.height(x), after.curve.height(x))) return;
    if (l >= 0 && x - left.whole.stretch[l].low < margin(right, x)) left.holds[l] = false;
    if (r >= 0 && right.whole.stretch[r].high - x < margin(left, x)) right.holds[r] = false;
  }

  /// Appends what becomes of one arc; stretches of length zero vanish.
  void cut(const Arc& arc, const Win& w, const Curve& curve) {
    Real done = arc.begin;
    for (int i = 0; i < 2; ++i) {
      if (!w.holds[i]) continue;
      append(done, w.from[i], arc.curve);
      append(w.from[i], w.to[i], curve);
      done = w.to[i];
    }
    append(done, arc.end, arc.curve);
  }
  void append(Real begin, Real end, const Curve& curve) {
    if (!(begin < end)) return;
    if (!next_.empty() && next_.back().curve.label == curve.label && next_.back().end == begin) {
      next_.back().end = end;
    } else {
      next_.push_back({begin, end, curve});
    }
  }

  std::size_t first_ = 0;
  std::vector<Win> wins_;
  std::vector<Arc> arcs_, next_;
  std::vector<Arc> done_, waiting_;  // pieces before and after the one in work, the nearest last
  std::vector<std::size_t> waiting_begin_;
};

}  // namespace krepl::voronoi
