#include "mill/drive_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl::mill {
namespace {

constexpr double lowest = -std::numeric_limits<double>::infinity();
constexpr int deepest = 200;
constexpr double straight = 1e-12;  // turns below that are rounding

/// Where the tangents at both ends meet: above it no concave function goes.
CurvePoint meet(double a, Touch at_a, double b, Touch at_b) {
  const double turn = at_a.slope - at_b.slope;
  double t = a + (b - a) / 2;
  if (turn > 0) t = std::clamp(a + ((at_b.height - at_a.height) - at_b.slope * (b - a)) / turn, a, b);
  return {t, std::max(at_a.height + at_a.slope * (t - a), at_b.height + at_b.slope * (t - b))};
}

double chord(double a, double za, double b, double zb, double t) {
  return b > a ? za + (zb - za) * ((t - a) / (b - a)) : std::max(za, zb);
}

}  // namespace

/// The bodies that are highest at both ends of an interval, and the floor.
struct DriveCurve::Ends {
  std::size_t first = nobody, last = nobody;  // candidates; nobody: the floor
  double first_height, last_height;
};

/// A body's height, beyond the inner part of its domain by the tangent there: next to a wall heights change too fast.
Touch DriveCurve::touch(std::size_t body, double t) {
  const Interval& domain = domains_[body];
  const double margin = 2 * options_.smallest;
  if (domain.high - domain.low <= 4 * margin) return {bodies_.top_of_narrow(body, domain.high - domain.low), 0};
  ++touches_;
  const double inner = std::clamp(t, domain.low + margin, domain.high - margin);
  Touch touch = bodies_.at(body, inner);
  if (touch.height == lowest)
    return {bodies_.top_of_narrow(body, 2 * margin), 0};  // only rounding could bring that about
  touch.height += touch.slope * (t - inner);
  return touch;
}

void DriveCurve::add_candidate(std::size_t body, double low, double high, Touch at_low, Touch at_high) {
  candidates_.push_back({body, low, high, at_low, at_high, meet(low, at_low, high, at_high)});
}

void DriveCurve::trace_stretch(double from, double to) {
  domains_.resize(bodies_.size());
  candidates_.clear();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Interval& domain = domains_[i] = bodies_.domain(i);
    if (!(domain.low <= domain.high)) continue;
    domain.low -= options_.smallest, domain.high += options_.smallest;
    const double low = std::max(from, domain.low), high = std::min(to, domain.high);
    if (low < high) add_candidate(i, low, high, touch(i, low), touch(i, high));
  }
  subdivide(from, to, 0, 0);
}

DriveCurve::Ends DriveCurve::find_ends(double a, double b, std::size_t first) const {
  Ends ends;
  ends.first_height = ends.last_height = options_.floor;
  for (std::size_t i = first; i < candidates_.size(); ++i) {
    const Candidate& c = candidates_[i];
    // Among equals one that reaches over the whole interval.
    const bool whole = c.low == a && c.high == b;
    if (c.low == a && (c.at_low.height > ends.first_height || (whole && c.at_low.height == ends.first_height)))
      ends.first = i, ends.first_height = c.at_low.height;
    if (c.high == b && (c.at_high.height > ends.last_height || (whole && c.at_high.height == ends.last_height)))
      ends.last = i, ends.last_height = c.at_high.height;
  }
  return ends;
}

/// Drops candidates that stay below the floor, or below the chord of a body that is highest at an end.
void DriveCurve::prune(double a, double b, std::size_t first) {
  const Ends ends = find_ends(a, b, first);
  double z[2][2] = {{options_.floor, options_.floor}, {options_.floor, options_.floor}};
  int k = 0;
  for (const std::size_t i : {ends.first, ends.last}) {
    if (i != nobody && candidates_[i].low == a && candidates_[i].high == b)
      z[k][0] = candidates_[i].at_low.height, z[k][1] = candidates_[i].at_high.height;
    ++k;
  }
  const auto is_below = [&](CurvePoint p, CurvePoint q) {
    for (const auto& height : z)
      if (p.z <= chord(a, height[0], b, height[1], p.t) && q.z <= chord(a, height[0], b, height[1], q.t)) return true;
    return p.z <= options_.floor && q.z <= options_.floor;
  };
  std::size_t kept = first;
  for (std::size_t i = first; i < candidates_.size(); ++i) {
    const Candidate& c = candidates_[i];
    const bool hidden = i != ends.first && i != ends.last && is_below({c.low, c.at_low.height}, c.apex) &&
                        is_below(c.apex, {c.high, c.at_high.height});
    if (!hidden) candidates_[kept++] = c;
  }
  candidates_.resize(kept);
}

/// Whether the hull over the candidates is nowhere farther above the highest body than the accuracy.
bool DriveCurve::is_close(double a, double b, const Ends& ends, std::size_t first) const {
  const auto heights = [&](std::size_t i, double& za, double& zb) {
    za = zb = options_.floor;
    if (i == nobody) return true;
    za = candidates_[i].at_low.height, zb = candidates_[i].at_high.height;
    return candidates_[i].low == a && candidates_[i].high == b;
  };
  double fa, fb, la, lb;
  if (!heights(ends.first, fa, fb) || !heights(ends.last, la, lb)) return false;
  const double slope = (ends.last_height - ends.first_height) / (b - a);
  const double room = options_.accuracy * std::sqrt(1 + slope * slope);
  // The two chords cross in a valley.
  double depth = 0;
  const double drop_first = ends.last_height - fb, drop_last = ends.first_height - la;
  if (drop_first > 0 && drop_last > 0) depth = drop_first * drop_last / (drop_first + drop_last);
  for (std::size_t i = first; i < candidates_.size(); ++i) {
    const Candidate& c = candidates_[i];
    for (const CurvePoint p : {CurvePoint{c.low, c.at_low.height}, c.apex, CurvePoint{c.high, c.at_high.height}})
      if (p.z - (ends.first_height + slope * (p.t - a)) + depth > room) return false;
  }
  return depth <= room;
}

/// Where a body ends, else near the valley or the top that is in the way.
double DriveCurve::split_place(double a, double b, const Ends& ends, std::size_t first) const {
  const double middle = a + (b - a) / 2;
  double best = middle, off = b - a;
  for (std::size_t i = first; i < candidates_.size(); ++i) {
    for (const double t : {candidates_[i].low, candidates_[i].high}) {
      if (t > a && t < b && std::abs(t - middle) < off) best = t, off = std::abs(t - middle);
    }
  }
  if (off < b - a) return best;
  if (ends.first != ends.last) {
    const auto tangent = [&](std::size_t i, bool at_a) -> Touch {
      if (i == nobody) return {options_.floor, 0};
      return at_a ? candidates_[i].at_low : candidates_[i].at_high;
    };
    const Touch p = tangent(ends.first, true), q = tangent(ends.last, false);
    const double turn = q.slope - p.slope;
    if (turn > 0) {
      const double t = a + (p.height - q.height + q.slope * (b - a)) / turn;
      if (t > a && t < b) return std::clamp(t, a + (b - a) / 16, b - (b - a) / 16);
    }
  }
  return middle;
}

void DriveCurve::subdivide(double a, double b, std::size_t first, int depth) {
  prune(a, b, first);
  if (candidates_.size() == first) {
    append({a, options_.floor});
    append({b, options_.floor});
    return;
  }
  const Ends ends = find_ends(a, b, first);
  if (b - a <= options_.smallest || depth > deepest || is_close(a, b, ends, first)) {
    emit({a, ends.first_height}, {b, ends.last_height}, first);
    candidates_.resize(first);
    return;
  }
  const double m = split_place(a, b, ends, first);
  if (!(m > a && m < b)) {  // no number lies between
    const double top = std::max(ends.first_height, ends.last_height);
    append({a, top});
    append({b, top});
    candidates_.resize(first);
    return;
  }
  split(a, m, b, first, depth);
  candidates_.resize(first);
}

void DriveCurve::split(double a, double m, double b, std::size_t first, int depth) {
  const std::size_t end = candidates_.size();
  // Left of m; the heights at m are kept for the other side.
  const std::size_t middle = end;
  for (std::size_t i = first; i < end; ++i) {
    const Candidate c = candidates_[i];
    if (c.low < m && c.high > m) {
      const Touch at_m = touch(c.body, m);
      candidates_[i] = {c.body, m, c.high, at_m, c.at_high, meet(m, at_m, c.high, c.at_high)};
      add_candidate(c.body, c.low, m, c.at_low, at_m);
    } else if (c.low < m) {
      candidates_.push_back(c);
    }
  }
  subdivide(a, m, middle, depth + 1);
  candidates_.resize(end);
  std::size_t kept = first;
  for (std::size_t i = first; i < end; ++i)
    if (candidates_[i].high > m) candidates_[kept++] = candidates_[i];
  candidates_.resize(kept);
  subdivide(m, b, first, depth + 1);
}

/// The upper hull of the curve's ends and the candidates' ends and apexes.
void DriveCurve::emit(CurvePoint a, CurvePoint b, std::size_t first) {
  hull_.assign({a, b});
  for (std::size_t i = first; i < candidates_.size(); ++i) {
    const Candidate& c = candidates_[i];
    hull_.push_back({c.low, c.at_low.height});
    hull_.push_back(c.apex);
    hull_.push_back({c.high, c.at_high.height});
  }
  std::sort(hull_.begin(), hull_.end(), [](CurvePoint p, CurvePoint q) { return p.t != q.t ? p.t < q.t : p.z > q.z; });
  std::size_t kept = 0;
  for (const CurvePoint p : hull_) {
    if (kept > 0 && hull_[kept - 1].t == p.t) continue;  // the highest came first
    while (kept > 1 && (hull_[kept - 1].z - hull_[kept - 2].z) * (p.t - hull_[kept - 2].t) <=
                           (p.z - hull_[kept - 2].z) * (hull_[kept - 1].t - hull_[kept - 2].t))
      --kept;
    hull_[kept++] = p;
  }
  for (std::size_t i = 0; i < kept; ++i) append(hull_[i]);
}

void DriveCurve::append(CurvePoint p) {
  CurveRun& out = *out_;
  if (!out.empty() && out.back().t == p.t && out.back().z == p.z) return;
  // Straight on: neighbours share tangents.
  if (out.size() > 1) {
    const CurvePoint o = out[out.size() - 2], q = out.back();
    const double ut = q.t - o.t, uz = q.z - o.z, vt = p.t - q.t, vz = p.z - q.z;
    const double turn = ut * vz - uz * vt;
    // Left out only where the middle point does not lie above the line, and no farther below it than rounding explains.
    if (ut > 0 && vt > 0 && turn >= 0 && turn <= straight * (std::abs(ut * vz) + std::abs(uz * vt))) {
      out.back() = p;
      return;
    }
  }
  out.push_back(p);
}

void DriveCurve::trace(const Line& line, double from, double to, bool over_air, std::vector<CurveRun>& runs) {
  const double grain = options_.grain;
  double length = bodies_.stretch();
  CurveRun run;
  bool in_air = true;
  for (double t = from; t < to;) {
    double end = std::min(to, t + std::max(grain, std::round(length / grain) * grain));
    const bool shortest = end - t <= grain;
    if (!bodies_.list(line, t, end, options_.floor, shortest)) {
      length = (end - t) / 2;
      continue;
    }
    const bool air = !over_air && !bodies_.touches() && bodies_.size() == 0;
    if (air && !in_air && run.size() > 1) runs.push_back(std::move(run)), run.clear();
    in_air = air;
    if (!air) {
      out_ = &run;
      trace_stretch(t, end);
    }
    if (bodies_.size() < 24) length *= 1.25;
    length = std::min(length, 4 * bodies_.stretch());
    t = end;
  }
  if (run.size() > 1) runs.push_back(std::move(run));
}

double DriveCurve::highest(const Line& line, double from, double to) {
  return std::max(highest_above(line, from, to, 0), options_.floor);
}

double DriveCurve::highest_above(const Line& line, double from, double to, double slope) {
  double top = lowest, length = bodies_.stretch();
  CurveRun run;
  for (double t = from; t < to;) {
    const double end = std::min(to, t + length);
    const bool shortest = end - t <= bodies_.stretch() / 4096 || end == t;
    if (!bodies_.list(line, t, end, options_.floor, shortest)) {
      length = (end - t) / 2;
      continue;
    }
    run.clear();
    out_ = &run;
    trace_stretch(t, end);
    for (const CurvePoint& p : run) top = std::max(top, p.z - slope * p.t);
    t = end;
    length = std::min(length * 1.25, 16 * bodies_.stretch());
  }
  return top;
}

}  // namespace krepl::mill
