#include "mill/level_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>

#include "mill/level_bodies.hpp"
#include "mill/ring_order.hpp"

namespace krepl::mill {
namespace {

constexpr int lattices = 6, deepest = 20;
constexpr std::size_t most_bodies = 96;  // of a cell, unless it is a small one already
constexpr int small = 4;

/// Where the border crosses a line of the lattice.
struct Crossing {
  bool vertical;
  std::int64_t line, bin;
  auto operator<=>(const Crossing&) const = default;
};

/// Along the border through a cell, the higher side on the left; without the last point.
struct Stretch {
  Crossing from, to;
  std::vector<Point> points;
};

/// A crossing on the way around a cell, counter-clockwise: out of what is higher, or into it.
struct Passage {
  bool out;
  Crossing crossing;
  Point place;
};

class Tracer {
 public:
  Tracer(const LiftedCutter& cutter, double level, const LevelSetOptions& options, const Context& context, int lattice)
      : bodies_(cutter, level, options.grain), o_(options), context_(context) {
    const Terrain& terrain = cutter.drop.terrain();
    const double margin = cutter.drop.radius() + 2 * options.cell;
    const Point3 low = terrain.lowest(), high = terrain.highest();
    side_ = options.within / 2;
    // Parts have sides on round numbers: no line of the lattice shall run along one.
    const double shift = (0.381966 + 0.0917 * lattice) * options.cell;
    first_ = {low.x - margin - shift, low.y - margin - 0.618034 * shift};
    const double extent = std::max(high.x - first_.x, high.y - first_.y) + margin;
    while (std::ldexp(side_, top_) < extent) ++top_;
  }

  bool run() { return divide(0, 0, top_); }
  std::vector<Stretch> stretches;

 private:
  double x(std::int64_t i) const { return first_.x + double(i) * side_; }
  double y(std::int64_t j) const { return first_.y + double(j) * side_; }

  /// The cell of 2^k smallest ones at (i, j).
  bool divide(std::int64_t i, std::int64_t j, int k) {
    if (context_.cancelled()) return true;
    const std::int64_t size = std::int64_t{1} << k;
    const Point low{x(i), y(j)}, high{x(i + size), y(j + size)};
    const bool large = high.x - low.x > o_.cell;
    if (bodies_.is_covered(low, high)) return true;
    bodies_.list(low, high);
    if (bodies_.size() == 0) return true;
    if (!large) {
      const double margin = 0.75 * (high.x - low.x) + 2 * o_.within;
      low_ = {low.x - margin, low.y - margin}, high_ = {high.x + margin, high.y + margin};
      bodies_.list(low_, high_);
      if (bodies_.size() <= most_bodies || k <= small) {
        if (!find_passages(i, j, size)) return false;
        if (passages_.empty()) return true;
        if ((k == 0 || passages_.size() == 2) && join_passages(k == 0)) return true;
      }
    }
    for (const std::int64_t di : {std::int64_t{0}, size / 2})
      for (const std::int64_t dj : {std::int64_t{0}, size / 2})
        if (!divide(i + di, j + dj, k - 1)) return false;
    return true;
  }

  std::int64_t bin(double t) const { return std::int64_t(std::llround(t / (4 * o_.grain))); }

  /// Around a cell; false if its sides differ about a corner.
  bool find_passages(std::int64_t i, std::int64_t j, std::int64_t size) {
    passages_.clear();
    bool first_state = false, state = false;
    for (int s = 0; s < 4; ++s) {
      const bool vertical = s % 2 == 1, backwards = s >= 2;
      const std::int64_t at = vertical ? (s == 1 ? i + size : i) : (s == 0 ? j : j + size);
      const Line line = vertical ? Line{{x(at), 0}, {0, 1}} : Line{{0, y(at)}, {1, 0}};
      const double a = vertical ? y(j) : x(i), b = vertical ? y(j + size) : x(i + size);
      bodies_.free_parts(line, a, b, free_);
      const bool at_a = free_.empty() || free_.front().low > a, at_b = free_.empty() || free_.back().high < b;
      const bool begins = backwards ? at_b : at_a;
      if (s == 0)
        first_state = begins;
      else if (begins != state)
        return false;
      state = backwards ? at_a : at_b;
      const auto pass = [&](double t, bool out) { passages_.push_back({out, {vertical, at, bin(t)}, line.at(t)}); };
      for (std::size_t n = 0; n < free_.size(); ++n) {
        const Interval& f = free_[backwards ? free_.size() - 1 - n : n];
        if (backwards ? f.high < b : f.low > a) pass(backwards ? f.high : f.low, true);
        if (backwards ? f.low > a : f.high < b) pass(backwards ? f.low : f.high, false);
      }
    }
    return state == first_state;
  }

  /// Each way out with the next way in, so that what is higher is joined where it can be. False if the border is not
  /// near.
  bool join_passages(bool as_they_are) {
    const std::size_t count = passages_.size();
    const std::size_t before = stretches.size();
    for (std::size_t n = 0; n < count; ++n) {
      if (!passages_[n].out) continue;
      const Passage &from = passages_[n], &to = passages_[(n + 1) % count];
      Stretch stretch{from.crossing, to.crossing, {from.place}};
      if (!as_they_are && !follow(from.place, to.place, 0, stretch.points)) {
        stretches.resize(before);
        return false;
      }
      stretches.push_back(std::move(stretch));
    }
    return true;
  }

  bool is_listed(Point p) const {
    return p.x - o_.within >= low_.x && p.y - o_.within >= low_.y && p.x + o_.within <= high_.x &&
           p.y + o_.within <= high_.y;
  }

  /// Appends what is needed between two places of the border.
  bool follow(Point p, Point q, int depth, std::vector<Point>& points) {
    const double dx = q.x - p.x, dy = q.y - p.y, length = std::hypot(dx, dy);
    if (length <= o_.within / 2) return true;
    const Point way{dx / length, dy / length}, right{way.y, -way.x};
    const auto beside = [&](double off) { return Line{{p.x + off * right.x, p.y + off * right.y}, way}; };
    if (bodies_.is_free(beside(o_.within), 0, length) && bodies_.is_covered(beside(-o_.within), 0, length)) return true;
    if (depth == deepest) return false;
    // Straight across from the middle of the chord.
    const Point middle{p.x + dx / 2, p.y + dy / 2};
    const Line across{middle, right};
    const double reach = std::max(length / 2, o_.within);
    bodies_.free_parts(across, -reach, reach, free_);
    double nearest = 2 * reach;
    for (const Interval& f : free_)
      if (f.low > -reach && std::abs(f.low) < std::abs(nearest)) nearest = f.low;
    if (nearest == 2 * reach) return false;
    const Point found = across.at(nearest);
    if (!is_listed(found)) return false;
    if (!follow(p, found, depth + 1, points)) return false;
    points.push_back(found);
    return follow(found, q, depth + 1, points);
  }

  LevelBodies bodies_;
  const LevelSetOptions& o_;
  const Context& context_;
  Point first_, low_, high_;
  double side_;
  int top_ = 0;
  std::vector<Interval> free_;
  std::vector<Passage> passages_;
};

/// Stretches put together; false if an end has no beginning.
bool link(std::vector<Stretch>& stretches, std::vector<std::vector<Point>>& rings) {
  const auto before = [](const Stretch& a, const Stretch& b) { return a.from < b.from; };
  std::sort(stretches.begin(), stretches.end(), before);
  for (std::size_t n = 1; n < stretches.size(); ++n)
    if (stretches[n].from == stretches[n - 1].from) return false;
  std::vector<char> taken(stretches.size());
  for (std::size_t first = 0; first < stretches.size(); ++first) {
    if (taken[first]) continue;
    std::vector<Point> ring;
    for (std::size_t n = first; !taken[n];) {
      taken[n] = true;
      ring.insert(ring.end(), stretches[n].points.begin(), stretches[n].points.end());
      const auto next = std::lower_bound(stretches.begin(), stretches.end(), stretches[n].to,
                                         [](const Stretch& s, const Crossing& c) { return s.from < c; });
      if (next == stretches.end() || next->from != stretches[n].to) return false;
      n = std::size_t(next - stretches.begin());
      if (taken[n] && n != first) return false;
    }
    rings.push_back(std::move(ring));
  }
  return true;
}

/// Which segments are steep: how much the surface falls across each, within twice the accuracy on both sides of it.
LevelRing finish(std::vector<Point>&& points, const LiftedCutter& cutter, const LevelSetOptions& o) {
  LevelRing ring;
  for (const Point p : points)
    if (ring.points.empty() || std::hypot(p.x - ring.points.back().x, p.y - ring.points.back().y) > o.within / 16)
      ring.points.push_back(p);
  const std::size_t n = ring.points.size();
  ring.is_steep.assign(n, 1);
  const double off = 2 * o.within, least = 2 * off * std::tan(o.steep);
  for (std::size_t k = 0; k < n && o.steep > 0; ++k) {
    const Point p = ring.points[k], q = ring.points[(k + 1) % n];
    const double dx = q.x - p.x, dy = q.y - p.y, length = std::hypot(dx, dy);
    if (length == 0) continue;
    const Point m{p.x + dx / 2, p.y + dy / 2}, aside{-dy / length * off, dx / length * off};
    ring.is_steep[k] =
        cutter.height({m.x + aside.x, m.y + aside.y}) - cutter.height({m.x - aside.x, m.y - aside.y}) >= least;
  }
  if (o.reversed && n > 1) ring.reverse();
  return ring;
}

}  // namespace

bool trace_level_set(const LiftedCutter& cutter, double level, const LevelSetOptions& options, const Context& context,
                     std::vector<LevelRing>& rings) {
  for (int lattice = 0; lattice < lattices; ++lattice) {
    Tracer tracer(cutter, level, options, context, lattice);
    std::vector<std::vector<Point>> found;
    if (!tracer.run() || !link(tracer.stretches, found)) continue;
    for (const std::size_t n : order_rings(found)) rings.push_back(finish(std::move(found[n]), cutter, options));
    return true;
  }
  return false;
}

}  // namespace krepl::mill
