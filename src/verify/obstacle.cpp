#include "verify/obstacle.hpp"

#include <limits>
#include <map>
#include <tuple>

namespace krepl::verify {

namespace {

Real inset_of(const InputPart& part, double radius) { return part.radius > 0 ? Real(radius) - Real(part.radius) : 0; }

/// Lowest and highest place.
std::pair<Real, Real> heights_of(const CircularArc& arc) {
  auto [low, high] = std::minmax({arc.a.y, arc.b.y});
  for (const Real sign : {Real(1), Real(-1)}) {
    const Vec pole = arc.a + arc.pole(sign);
    if (arc.spans(pole)) low = std::min(low, pole.y), high = std::max(high, pole.y);
  }
  return {low, high};
}

}  // namespace

std::vector<Obstacle::Segment> Obstacle::cut(const std::vector<InputPart>& parts, double radius) {
  std::vector<Segment> segments;
  for (const InputPart& part : parts) {
    const auto& v = part.vertices;
    const Real inset = inset_of(part, radius);
    if (v.size() == 1) segments.push_back({v[0], v[0], inset});
    auto middle = part.middles.begin();
    for (std::size_t i = 0; i + 1 < v.size(); ++i) {
      if (middle != part.middles.end() && *middle == i + 1) {
        ++middle;
        if (const auto arc = CircularArc::through(v[i], v[i + 1], v[i + 2])) {
          segments.push_back({v[i], v[i + 2], inset, std::make_shared<const CircularArc>(*arc)});
          ++i;
          continue;
        }
      }
      segments.push_back({v[i], v[i + 1], inset});
    }
    if (part.ring && v.size() > 1 && !(v.front() == v.back())) segments.push_back({v.back(), v.front(), inset});
  }
  return segments;
}

std::vector<Obstacle::Vertex> Obstacle::corners(const std::vector<InputPart>& parts, double radius) {
  std::vector<Vertex> corners;
  for (const InputPart& part : parts)
    for (const Point& p : part.vertices) corners.push_back({p, inset_of(part, radius)});
  return corners;
}

Obstacle::Obstacle(const std::vector<InputPart>& parts, double radius)
    : segments_(cut(parts, radius)), vertices_(corners(parts, radius)) {
  for (const Segment& q : segments_.items()) {
    if (q.arc) {
      Arc arc{q.arc->in_ray_frame(), q.inset, 0, 0};
      std::tie(arc.low, arc.high) = heights_of(arc.curve);
      arcs_.push_back(arc);
      continue;
    }
    Axis axis{ray_frame(q.a), ray_frame(q.b), q.inset};
    if (axis.high.y < axis.low.y) std::swap(axis.low, axis.high);
    tallest_ = std::max(tallest_, axis.high.y - axis.low.y);
    axes_.push_back(axis);
  }
  std::sort(axes_.begin(), axes_.end(), [](const Axis& p, const Axis& q) { return p.low.y < q.low.y; });

  std::map<std::int64_t, std::uint32_t> polygon_of;
  std::vector<std::pair<Real, Real>> ranges;
  for (const InputPart& part : parts) {
    if (!part.ring) continue;
    const auto polygon = polygon_of.emplace(part.feature, std::uint32_t(polygon_of.size())).first->second;
    for (const Segment& q : cut({part}, radius)) {
      sides_.push_back({ray_frame(q.a), ray_frame(q.b), polygon, {}});
      ranges.push_back(std::minmax(sides_.back().a.y, sides_.back().b.y));
      if (!q.arc) continue;
      sides_.back().arc = std::make_shared<const CircularArc>(q.arc->in_ray_frame());
      ranges.back() = heights_of(*sides_.back().arc);
    }
  }
  side_bands_ = Bands(ranges);
}

Real Obstacle::extent() const {
  const Box b = box();
  return std::max(b.x1 - b.x0, b.y1 - b.y0) / 2;
}

Real Obstacle::resolution() const {
  const Box b = box();
  const Real largest = std::max(std::max(std::abs(b.x0), std::abs(b.x1)), std::max(std::abs(b.y0), std::abs(b.y1)));
  return largest * std::numeric_limits<double>::epsilon();
}

std::pair<Real, Real> Obstacle::heights() const {
  Real low = HUGE_VALL, high = -HUGE_VALL;
  for (const Axis& axis : axes_) low = std::min(low, axis.low.y), high = std::max(high, axis.high.y);
  for (const Arc& arc : arcs_) low = std::min(low, arc.low), high = std::max(high, arc.high);
  return {low, high};
}

void Obstacle::add_ends(Real r, std::vector<Real>& out) const {
  for (const Axis& axis : axes_)
    for (const Real y : {axis.low.y, axis.high.y})
      out.insert(out.end(), {y - (r - axis.inset), y + (r - axis.inset)});
  for (const Arc& arc : arcs_) {
    const Real own = r - arc.inset;
    for (const Vec& end : {arc.curve.a, arc.curve.b}) out.insert(out.end(), {end.y - own, end.y + own});
    for (const Real sign : {Real(1), Real(-1)}) {
      const Vec pole = arc.curve.a + arc.curve.pole(sign);
      if (arc.curve.spans(pole)) out.insert(out.end(), {pole.y - own, pole.y + own});
    }
  }
}

/// Between any two neighbours of the places where the line meets the circles and the walls of an arc's zone, it is all in
/// or all out, and the distance tells which.
void Obstacle::add_arcs(Real y, Real widest, std::vector<Interval>& out) const {
  std::vector<Real> cuts;
  for (const Arc& arc : arcs_) {
    const Real r = widest - arc.inset;
    if (y < arc.low - r || y > arc.high + r) continue;
    cuts.clear();
    arc.curve.crossings(y, r, cuts);
    if (arc.curve.r > r) arc.curve.crossings(y, -r, cuts);
    arc.curve.wall_crossings(y, cuts);
    for (const Vec& end : {arc.curve.a, arc.curve.b}) {
      const Real square = (r - (y - end.y)) * (r + (y - end.y));
      if (square >= 0) cuts.insert(cuts.end(), {end.x - std::sqrt(square), end.x + std::sqrt(square)});
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
      if (arc.curve.distance({(cuts[i] + cuts[i + 1]) / 2, y}) <= r) out.emplace_back(cuts[i], cuts[i + 1]);
  }
}

/// The chord's crossing, and one more where the place is between chord and arc.
bool Obstacle::Side::crosses(Vec p) const {
  const Real turn = cross(b - a, p - a);
  // On the chord: to the right in the plane, and above, as the crossings have it.
  const bool right = turn < 0 || (turn == 0 && (a.y != b.y ? b.y > a.y : b.x < a.x));
  const bool chord = (a.y <= p.y) != (b.y <= p.y) && right != (b.y > a.y);
  if (!arc) return chord;
  const bool beyond = arc->full() || right == arc->left;
  return chord != (beyond && arc->off_circle(p) < 0);
}

bool Obstacle::in_polygon(Vec place) const {
  const Vec p = ray_frame(place);
  std::vector<std::uint32_t> crossed;
  for (const std::uint32_t i : side_bands_.at(p.y)) {
    if (sides_[i].crosses(p)) crossed.push_back(sides_[i].polygon);
  }
  std::sort(crossed.begin(), crossed.end());
  for (std::size_t i = 0; i < crossed.size();) {
    std::size_t j = i;
    while (j < crossed.size() && crossed[j] == crossed[i]) ++j;
    if ((j - i) % 2 == 1) return true;
    i = j;
  }
  return false;
}

void Obstacle::add_cigars(Real y, Real widest, std::vector<Interval>& out) const {
  auto it =
      std::partition_point(axes_.begin(), axes_.end(), [&](const Axis& axis) { return axis.low.y < y - widest - tallest_; });
  for (; it != axes_.end() && it->low.y <= y + widest; ++it) {
    const Real r = widest - it->inset;
    const Vec a = it->low, b = it->high;
    Real x0 = HUGE_VALL, x1 = -HUGE_VALL;
    for (const Vec& c : {a, b}) {
      const Real square = (r - (y - c.y)) * (r + (y - c.y));
      if (square < 0) continue;
      x0 = std::min(x0, c.x - std::sqrt(square)), x1 = std::max(x1, c.x + std::sqrt(square));
    }
    // The rectangle between the end disks: the line meets its two sides parallel to the segment.
    const Vec d = b - a;
    const Real l = length(d);
    if (l > 0 && d.y != 0)
      for (const Real side : {r, -r}) {
        const Vec q = a + (side / l) * left_of(d);
        const Real t = (y - q.y) / d.y;
        if (t >= 0 && t <= 1) x0 = std::min(x0, q.x + t * d.x), x1 = std::max(x1, q.x + t * d.x);
      }
    // A horizontal segment's own disks span it; the interval of a convex set is the hull of what was found.
    if (x0 <= x1) out.emplace_back(x0, x1);
  }
}

void Obstacle::add_polygons(Real y, std::vector<Interval>& out) const {
  std::vector<std::pair<std::uint32_t, Real>> crossings;
  std::vector<Real> cuts;
  for (const std::uint32_t i : side_bands_.at(y)) {
    const Side& s = sides_[i];
    if (s.arc) {
      cuts.clear();
      s.arc->crossings(y, 0, cuts);
      for (const Real x : cuts)
        if (s.arc->spans({x, y})) crossings.emplace_back(s.polygon, x);
      continue;
    }
    if ((s.a.y <= y) == (s.b.y <= y)) continue;
    crossings.emplace_back(s.polygon, s.a.x + (y - s.a.y) / (s.b.y - s.a.y) * (s.b.x - s.a.x));
  }
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    out.emplace_back(crossings[i].second, crossings[i + 1].second);
}

Real Obstacle::section(Real y, Real r) const {
  std::vector<Interval> intervals;
  add_cigars(y, r, intervals);
  add_arcs(y, r, intervals);
  add_polygons(y, intervals);
  std::sort(intervals.begin(), intervals.end());
  Real total = 0, reach = -HUGE_VALL;
  for (const auto& [x0, x1] : intervals) {
    if (x1 <= reach) continue;
    total += x1 - std::max(x0, reach);
    reach = x1;
  }
  return total;
}

}  // namespace krepl::verify
