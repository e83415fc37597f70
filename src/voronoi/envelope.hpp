#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "voronoi/sites.hpp"

namespace krepl::voronoi {

template <class Real>
constexpr Real infinite() {
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

/// The face of one site, as the lower envelope of its bisectors with all others over the site's own parameter (the place
/// along a side, the direction from a vertex). `Curve` has a label, none where no site is near; `nearer(b, a)` tells where
/// b lies below a.
template <class Real, class Curve>
class Envelope {
 public:
  struct Arc {
    Real begin, end;
    Curve curve;
  };

  void start(Real low, Real high) {
    arcs_.clear();
    arcs_.push_back({low, high, Curve{}});
  }
  const std::vector<Arc>& arcs() const { return arcs_; }

  /// Takes the minimum with a curve that is defined between low and high. Returns true if anything changed.
  bool insert(const Curve& curve, Real low, Real high) {
    if (!(low < high)) return false;
    bool changed = false;
    next_.clear();
    for (const Arc& arc : arcs_) changed = cut(arc, curve, low, high) || changed;
    if (changed) arcs_.swap(next_);
    return changed;
  }

 private:
  /// Appends what becomes of one arc; stretches of length zero vanish.
  bool cut(const Arc& arc, const Curve& curve, Real low, Real high) {
    const Real u = std::max(arc.begin, low), v = std::min(arc.end, high);
    if (!(u < v)) {
      append(arc.begin, arc.end, arc.curve);
      return false;
    }
    const auto wins = nearer(curve, arc.curve);
    Real done = arc.begin;
    for (int i = 0; i < wins.count; ++i) {
      const Real from = std::max(u, wins.stretch[i].low), to = std::min(v, wins.stretch[i].high);
      if (!(from < to) || from < done) continue;
      append(done, from, arc.curve);
      append(from, to, curve);
      done = to;
    }
    append(done, arc.end, arc.curve);
    return done > arc.begin;
  }
  void append(Real begin, Real end, const Curve& curve) {
    if (!(begin < end)) return;
    if (!next_.empty() && next_.back().curve.label == curve.label && next_.back().end == begin) {
      next_.back().end = end;
    } else {
      next_.push_back({begin, end, curve});
    }
  }

  std::vector<Arc> arcs_, next_;
};

}  // namespace krepl::voronoi
