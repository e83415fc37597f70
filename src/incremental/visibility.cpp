#include "incremental/visibility.hpp"

#include <algorithm>
#include <optional>

namespace krepl::incremental {

using FeatureKind = Terrain::FeatureKind;

void add_domain(const Parts& parts, Index part, std::vector<Condition>& conditions) {
  const Part& p = parts[part];
  if (p.kind == FeatureKind::face) {
    const TrianglePart& t = parts.triangle_of(part);
    for (std::size_t k = 0; k < 3; ++k) conditions.push_back({t.inward[k], dot(t.inward[k], t.corner[k])});
  } else if (p.kind == FeatureKind::edge) {
    const EdgePart& e = parts.edge_of(part);
    conditions.push_back({e.direction, dot(e.direction, e.at)});
    conditions.push_back({-e.direction, -dot(e.direction, e.at) - e.length});
    conditions.push_back({e.up, dot(e.up, e.at)});  // horizontal touch: (c - at) . up = 0
  } else {
    conditions.push_back({{0, 0, 1}, parts.vertex_of(part).at.z});
  }
}

namespace {

/// Directions out of a vertex along the triangle's two edges there.
void add_vertex_cone(const Parts& parts, Index part, const TrianglePart& t, std::vector<Condition>& conditions) {
  const Vector at = parts.vertex_of(part).at;
  for (std::size_t k = 0; k < 3; ++k) {
    if (t.vertex[k] != parts[part].item) continue;
    for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
      const Vector d = unit(t.corner[other] - at);
      conditions.push_back({-d, -dot(d, at)});
    }
  }
}

void add_edge_cone(const Parts& parts, Index part, const TrianglePart& t, std::vector<Condition>& conditions) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (t.edge[k] == parts[part].item) conditions.push_back({-t.inward[k], -dot(t.inward[k], t.corner[k])});
  }
}

}  // namespace

void add_cover(const Parts& parts, std::span<const Index> own, Index triangle, std::vector<Condition>& conditions) {
  const TrianglePart& t = parts.triangles()[triangle];
  bool has_own = false;
  for (const Index part : own) {
    if (part == none) continue;
    const auto& of = parts[part].triangles;
    if (std::find(of.begin(), of.end(), triangle) == of.end()) continue;
    has_own = true;
    if (parts[part].kind == FeatureKind::vertex) add_vertex_cone(parts, part, t, conditions);
    if (parts[part].kind == FeatureKind::edge) add_edge_cone(parts, part, t, conditions);
  }
  if (!has_own) conditions.push_back({{}, 0, triangle});
}

namespace {

class Search {
 public:
  Search(const Parts& parts, const Curve& curve, const std::vector<Condition>& conditions, const Tolerance& tolerance)
      : parts_(parts), curve_(curve), conditions_(conditions), tolerance_(tolerance) {}

  std::vector<Interval> run(Real begin, Real end) {
    begin_ = begin, end_ = end;
    const int pieces = curve_.shape == Curve::Shape::line ? 2 : curve_.shape == Curve::Shape::circle ? 16 : 12;
    std::vector<Sample> samples;
    for (int i = 0; i <= pieces; ++i) {
      samples.push_back(sample(i == pieces ? end : begin + (end - begin) * Real(i) / pieces));
    }
    for (int i = 0; i < pieces; ++i) {
      std::vector<Open> open;
      for (Index k = 0; k < conditions_.size(); ++k) {
        open.push_back({k, value(k, samples[std::size_t(i)]), value(k, samples[std::size_t(i) + 1])});
      }
      settle(samples[std::size_t(i)], samples[std::size_t(i) + 1], std::move(open), 0);
    }
    std::vector<Interval> intervals;
    for (const Found& f : found_) {
      Interval i{sharpened(f, false), sharpened(f, true), {}};
      if (i.begin.t < i.end.t) intervals.push_back(i);
    }
    for (const Low& low : lows_) add_touch(low, intervals);
    return intervals;
  }

 private:
  /// Parameters are known to so many bits.
  static constexpr int most_depth = 52;

  struct Sample {
    Real t;
    Vector c;
  };
  /// A stretch, and the conditions that end it; none at an end of the range.
  struct Found {
    Real begin;
    Index begin_condition;
    Real end;
    Index end_condition;
  };
  struct Low {
    Index condition;
    Real from, to;
  };
  struct Open {
    Index condition;
    Real begin, end;
  };
  struct Crossing {
    Index condition;
    bool rising;
    Real begin, end;
  };

  Sample sample(Real t) const { return {t, curve_.point(t)}; }
  Real value(Index k, const Sample& s) const { return conditions_[k].value(parts_, s.c); }

  /// Decides [a, b], given the conditions that are open there and their values at the ends.
  void settle(const Sample& a, const Sample& b, std::vector<Open> open, int depth) {
    const Sample m = sample((a.t + b.t) / 2);
    const Vector chord = b.c - a.c, off = m.c - Real(0.5) * (a.c + b.c);
    const Real size = length(chord), bend = 2 * length(off);
    std::vector<Open> first, second;
    std::vector<Crossing> crossings;
    bool all_cross = true;
    for (const Open& o : open) {
      const bool linear = conditions_[o.condition].prism == none;
      const Real middle = value(o.condition, m);
      const Real low = std::min({o.begin, middle, o.end}), high = std::max({o.begin, middle, o.end});
      // How far the function can be from the two chords of its values; a distance of R bends by the square of the way.
      Real slack = bend / 4;
      if (!linear) {
        const Real least = std::max(parts_.radius() + low - size - bend, parts_.radius() / 8);
        slack = std::min(slack + size * size / (32 * least), size / 4 + bend);
      }
      // Between the two thresholds either is right, so that rounding cannot keep an interval open.
      if (high + slack < -tolerance_.touch / 4) return hide(a.t, o.condition);
      if (low - slack >= -tolerance_.touch) {
        if (!linear && low <= tolerance_.touch) note_low(o.condition, a.t, b.t);
        continue;
      }
      // A condition that holds with equality all along: something else touches the ball too.
      if (low >= -tolerance_.touch && high <= tolerance_.touch && is_tie(o.condition, a, b)) {
        if (!linear) note_low(o.condition, a.t, b.t);
        continue;
      }
      const Real rise = middle - o.begin, more = o.end - middle;
      const bool monotone = rise * more > 0 && std::fabs(rise) > 4 * slack && std::fabs(more) > 4 * slack;
      // Down to zero and not below: where exactly it gets there could not be told, were it tangent.
      if (monotone && low >= -tolerance_.touch) continue;
      first.push_back({o.condition, o.begin, middle});
      second.push_back({o.condition, middle, o.end});
      if (monotone) crossings.push_back({o.condition, rise > 0, o.begin, o.end});
      all_cross = all_cross && monotone;
    }
    if (first.empty()) return keep({a.t, none, b.t, none});
    if (all_cross) return keep_between(a, b, crossings);
    if (size + bend <= tolerance_.finest || depth > most_depth) {
      for (const Open& o : second) {
        if (o.begin < -tolerance_.touch) return hide(a.t, o.condition);
      }
      return keep({a.t, none, b.t, none});
    }
    settle(a, m, std::move(first), depth + 1);
    settle(m, b, std::move(second), depth + 1);
  }

  bool is_tie(Index k, const Sample& a, const Sample& b) const {
    for (const Real share : {0.13L, 0.29L, 0.61L, 0.83L}) {
      if (std::fabs(value(k, sample(a.t + share * (b.t - a.t)))) > tolerance_.touch) return false;
    }
    return true;
  }

  /// The latest place where a condition starts to hold and the first where one ceases to. Where two are the same but
  /// for the tolerance, the better one tells: the first (last) place at which all the others hold up to the tolerance.
  void keep_between(const Sample& a, const Sample& b, const std::vector<Crossing>& crossings) {
    Found kept{a.t, none, b.t, none};
    struct Root {
      Real t;
      Index condition;
      bool rising;
    };
    std::vector<Root> roots;
    for (const Crossing& c : crossings) roots.push_back({root(c, a.t, b.t), c.condition, c.rising});
    for (const bool rising : {true, false}) {
      std::vector<Root> some;
      for (const Root& r : roots) {
        if (r.rising == rising) some.push_back(r);
      }
      std::sort(some.begin(), some.end(), [&](const Root& x, const Root& y) { return rising ? x.t < y.t : x.t > y.t; });
      for (std::size_t i = 0; i < some.size(); ++i) {
        const Sample s = sample(some[i].t);
        const bool all = std::all_of(some.begin() + std::ptrdiff_t(i) + 1, some.end(),
                                     [&](const Root& r) { return value(r.condition, s) >= -tolerance_.touch; });
        if (!all) continue;
        if (rising)
          kept.begin = some[i].t, kept.begin_condition = some[i].condition;
        else
          kept.end = some[i].t, kept.end_condition = some[i].condition;
        break;
      }
    }
    if (!(kept.end > kept.begin)) return hide(a.t, crossings[0].condition);
    if (kept.begin_condition != none) hide(a.t, kept.begin_condition);
    keep(kept);
    if (kept.end_condition != none) hide(kept.end, kept.end_condition);
  }

  /// By bisection sped up by false positions.
  Real root(const Crossing& c, Real begin, Real end) const {
    Real fa = c.begin, fb = c.end;
    if ((fa >= 0) == (fb >= 0)) return std::fabs(fa) < std::fabs(fb) ? begin : end;
    Real a = begin, b = end;
    int stuck = 0;
    for (int i = 0; i < 200; ++i) {
      Real t = stuck >= 2 ? (a + b) / 2 : a + (b - a) * (fa / (fa - fb));
      if (!(t > a && t < b)) t = (a + b) / 2;
      if (t <= a || t >= b) break;
      const Real f = value(c.condition, sample(t));
      if (f == 0) return t;
      const bool with_a = (f >= 0) == (fa >= 0);
      stuck = (with_a ? t - a : b - t) < (b - a) / 2 ? stuck + 1 : 0;
      if (with_a)
        a = t, fa = f;
      else
        b = t, fb = f;
    }
    return std::fabs(fa) < std::fabs(fb) ? a : b;
  }

  /// What has been found so far ends or begins at t because of a condition.
  void hide(Real t, Index condition) {
    if (!found_.empty() && found_.back().end == t && found_.back().end_condition == none)
      found_.back().end_condition = condition;
    hidden_by_ = condition;
  }
  void keep(Found f) {
    if (f.begin_condition == none && f.begin != begin_) f.begin_condition = hidden_by_;
    if (!found_.empty() && found_.back().end == f.begin && found_.back().end_condition == none) {
      found_.back().end = f.end;
      found_.back().end_condition = f.end_condition;
    } else {
      found_.push_back(f);
    }
  }

  /// Stretches where a condition comes down to the tolerance, neighbouring ones joined.
  void note_low(Index condition, Real from, Real to) {
    for (Low& low : lows_) {
      if (low.condition != condition || low.to != from) continue;
      low.to = to;
      return;
    }
    lows_.push_back({condition, from, to});
  }
  void add_touch(const Low& low, std::vector<Interval>& intervals) const {
    if (low.to - low.from > (end_ - begin_) * 0x1p-18L) return;  // equal all along
    const auto at = [&](Real t) { return value(low.condition, sample(t)); };
    Real a = low.from - (low.to - low.from), b = low.to + (low.to - low.from);
    for (Interval& i : intervals) {
      if (!(i.begin.high < a && b < i.end.low)) continue;
      if (at(a) <= tolerance_.touch || at(b) <= tolerance_.touch) return;
      for (int k = 0; k < 80; ++k) {
        const Real third = (b - a) / 3;
        (at(a + third) < at(b - third) ? b : a) = at(a + third) < at(b - third) ? b - third : a + third;
      }
      i.touches.push_back({lowest_place(low.condition, (a + b) / 2), low.from, low.to});
    }
  }

  /// The place of a minimum close to t. Rounding decides where the function is lowest, so it is taken halfway between places at which
  /// it is equally high farther off, which moves with the square of their distance.
  Real lowest_place(Index k, Real t) const {
    const auto at = [&](Real x) { return value(k, sample(x)); };
    const auto halfway = [&](Real off) -> std::optional<Real> {
      const Real right = t + off, level = at(right);
      Real inside = t, outside = t - 2 * off;
      if (right > end_ || outside < begin_ || at(inside) >= level || at(outside) <= level) return std::nullopt;
      for (int i = 0; i < 64; ++i) {
        const Real middle = (inside + outside) / 2;
        (at(middle) < level ? inside : outside) = middle;
      }
      return (right + inside) / 2;
    };
    const Real off = (end_ - begin_) * 0x1p-16L;
    const std::optional<Real> far = halfway(off), near = halfway(off / 2);
    return far && near ? (4 * *near - *far) / 3 : t;
  }

  /// An end moved to where its condition is zero, and how far from there that is within the tolerance.
  StretchEnd sharpened(const Found& f, bool at_end) const {
    const Real t = at_end ? f.end : f.begin;
    const Index k = at_end ? f.end_condition : f.begin_condition;
    if (k == none) return {t, t, t};
    const Real inward = at_end ? -1 : 1, other = at_end ? f.begin : f.end;
    const auto at = [&](Real x) { return value(k, sample(x)); };
    const Real nothing = -tolerance_.touch / 256;
    const Real zero = at(t) >= nothing ? t : reach(t, inward, other, [&](Real x) { return at(x) >= nothing; });
    Real in = reach(zero, inward, other, [&](Real x) { return at(x) >= tolerance_.touch; });
    const Real out = reach(zero, -inward, at_end ? end_ : begin_, [&](Real x) { return at(x) <= -tolerance_.touch; });
    // Zero for a stretch, not along a tangent: something else touches the ball there, too, and what is open is as much
    // as on the other side.
    if (std::fabs(at(zero + (in - zero) / 4)) < tolerance_.touch / 100) {
      const Real as_much = zero + 2 * (zero - out);
      in = inward > 0 ? std::min(in, as_much) : std::max(in, as_much);
    }
    return {zero, std::min(in, out), std::max(in, out)};
  }
  /// From t towards a limit the first place that passes, to the half of its distance; the limit if none does.
  template <class Test>
  Real reach(Real t, Real direction, Real limit, const Test& test) const {
    Real step = (end_ - begin_) * 0x1p-46L, last = t;
    for (;; step *= 2) {
      const Real x = t + direction * step;
      if (direction * (limit - x) <= 0) return limit;
      if (test(x)) break;
      last = x;
    }
    Real first = t + direction * step;
    for (int i = 0; i < 30 && last != first; ++i) {
      const Real middle = (last + first) / 2;
      (test(middle) ? first : last) = middle;
    }
    return first;
  }

  const Parts& parts_;
  const Curve& curve_;
  const std::vector<Condition>& conditions_;
  const Tolerance& tolerance_;
  Real begin_ = 0, end_ = 0;
  std::vector<Found> found_;
  std::vector<Low> lows_;
  Index hidden_by_ = none;
};

}  // namespace

std::vector<Interval> where_all_hold(const Parts& parts, const Curve& curve, Real begin, Real end,
                                     const std::vector<Condition>& conditions, const Tolerance& tolerance) {
  return Search(parts, curve, conditions, tolerance).run(begin, end);
}

}  // namespace krepl::incremental
