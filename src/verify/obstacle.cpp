#include "verify/obstacle.hpp"

#include <limits>
#include <map>

namespace krepl::verify {

namespace {

Real inset_of(const InputPart& part, double radius) { return part.radius > 0 ? Real(radius) - Real(part.radius) : 0; }

}  // namespace

std::vector<Obstacle::Segment> Obstacle::cut(const std::vector<InputPart>& parts, double radius) {
  std::vector<Segment> segments;
  for (const InputPart& part : parts) {
    const auto& v = part.vertices;
    const Real inset = inset_of(part, radius);
    if (v.size() == 1) segments.push_back({v[0], v[0], inset});
    for (std::size_t i = 0; i + 1 < v.size(); ++i) segments.push_back({v[i], v[i + 1], inset});
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
      sides_.push_back({ray_frame(q.a), ray_frame(q.b), polygon});
      ranges.push_back(std::minmax(sides_.back().a.y, sides_.back().b.y));
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
  return {low, high};
}

void Obstacle::add_ends(Real r, std::vector<Real>& out) const {
  for (const Axis& axis : axes_)
    for (const Real y : {axis.low.y, axis.high.y})
      out.insert(out.end(), {y - (r - axis.inset), y + (r - axis.inset)});
}

bool Obstacle::in_polygon(Vec place) const {
  const Vec p = ray_frame(place);
  std::vector<std::uint32_t> crossed;
  for (const std::uint32_t i : side_bands_.at(p.y)) {
    const Side& s = sides_[i];
    if ((s.a.y <= p.y) == (s.b.y <= p.y)) continue;
    const bool up = s.b.y > s.a.y;
    const Real turn = cross(s.b - s.a, p - s.a);
    if (up ? turn > 0 : turn < 0) crossed.push_back(s.polygon);
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
  for (const std::uint32_t i : side_bands_.at(y)) {
    const Side& s = sides_[i];
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
