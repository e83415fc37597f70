#include "route/horizon.hpp"

namespace krepl::route {
namespace {

/// Looking further for obstacles that block costs more than it saves.
constexpr int most_obstacles = 2048;
/// Wider than this a range of angles cannot be told from its complement.
constexpr double widest = 2.5;

/// An angle between -half a turn and half a turn.
double signed_angle(double a) {
  a = std::fmod(a, turn);
  return a > turn / 2 ? a - turn : a < -turn / 2 ? a + turn : a;
}

}  // namespace

Horizon::Horizon(const Obstacles& obstacles, const Wheel& wheel, double from, double span, double radius, double slack,
                 const Reach& reach)
    : wheel_(wheel), from_(from), span_(std::max(span, 1e-9)), radius_(radius), slack_(slack) {
  blocked_.fill(std::numeric_limits<double>::infinity());
  limit(reach);
  const std::array<double, bins> before = blocked_;
  look(obstacles, reach);
  if (!std::isfinite(reach.budget)) return;
  const double width = span_ / bins;
  // An obstacle farther than four times that is narrower than a bin.
  const double far = radius_ / width;
  for (int i = 0; i < bins; ++i) {
    const auto k = std::size_t(i);
    if (blocked_[k] < before[k] || before[k] < far) continue;
    if (last_open_ < first_open_) first_open_ = i;
    last_open_ = i;
  }
  const int open = last_open_ - first_open_ + 1;
  if (open > 0 && open <= bins / 2 && width > 1e-6)
    finer_ = std::make_unique<Horizon>(obstacles, wheel, from_ + first_open_ * width, open * width, radius, slack, reach);
}

/// Looks at obstacles, the nearest first, but not at what is behind others.
void Horizon::look(const Obstacles& obstacles, const Reach& reach) {
  // Whatever comes between a place of the wheel and one within its reach is in this ellipse.
  const double within = distance(wheel_.center, reach.goal) + reach.budget + 4 * radius_ + slack_;
  int seen = 0;
  obstacles.each_by_distance(
      wheel_.center,
      [&](double distance, Point a, Point b) {
        block(a, b);
        return ++seen < most_obstacles && (seen % 16 != 0 || !done(distance));
      },
      [&](double away, const Box& box) { return away + distance(reach.goal, box) <= within && !hides(box); });
}

/// A way may be as long as it takes to the ellipse about its start and the goal.
void Horizon::limit(const Reach& reach) {
  if (!std::isfinite(reach.budget)) return;
  const double width = span_ / bins, r = std::abs(wheel_.radius);
  const double shift = r * width / 2;  // of the start, within a bin
  const double budget = reach.budget + 2 * shift + slack_;
  for (int i = 0; i < bins; ++i) {
    const double angle = from_ + (i + 0.5) * width;
    const Point start = wheel_.center + Point{r * std::cos(angle), r * std::sin(angle)};
    const Point way = reach.goal - start;
    const double away = length(way);
    double off = 0;
    if (away > 2 * shift)
      off = std::max(0.0, std::abs(signed_angle(std::atan2(way.y, way.x) - angle - ahead())) - width / 2 -
                              2 * shift / away - 1e-9);
    const double far = away + shift;
    blocked_[std::size_t(i)] = budget * (2 * far + budget) / (2 * (budget + far * (1 - std::cos(off)))) + 2 * shift + slack_;
  }
}

/// True if everything is blocked nearer than what comes next.
bool Horizon::done(double distance) const {
  return std::all_of(blocked_.begin(), blocked_.end(), [&](double b) { return b < distance; });
}

/// From where on the wheel a way leaves to the way.
double Horizon::ahead() const { return wheel_.radius > 0 ? turn / 4 : wheel_.radius < 0 ? -turn / 4 : 0; }

std::optional<double> Horizon::leaving(Point center, double radius) const {
  const auto t = tangent(wheel_, {center, radius}, 0);
  if (!t || !(t->length > 0)) return std::nullopt;
  const double way = std::atan2(t->direction.y, t->direction.x);
  return way - ahead();
}

/// Takes positions along the bins, from 0 to `bins`; a range that lies beside them is not taken.
template <class Take>
void Horizon::each_range(double from, double width, const Take& take) const {
  const double offset = positive_angle(std::fmod(from - from_, turn));
  for (const double shift : {0.0, -turn}) {
    const double begin = (offset + shift) / span_ * bins, end = (offset + shift + width) / span_ * bins;
    if (end >= 0 && begin <= bins) take(std::max(begin, 0.0), std::min(end, double(bins)));
  }
}

/// A segment blocks all ways between the outermost ones that touch the disks about its ends; a way gets at most as far
/// as its farther end.
void Horizon::block(Point a, Point b) {
  const double reach = std::max(distance(a, wheel_.center), distance(b, wheel_.center));
  const double thin = radius_ - 4 * slack_;
  if (std::min(distance(a, wheel_.center), distance(b, wheel_.center)) <= 2 * radius_ + slack_) return;
  if (distance_to_segment(wheel_.center, a, b) <= 2 * radius_ + slack_) return;
  std::optional<double> first;
  double low = 0, high = 0;
  for (int k = 0; k < (a == b ? 1 : 2); ++k) {
    const Point end = k == 0 ? a : b;
    for (const double side : {thin, -thin}) {
      const auto angle = leaving(end, side);
      if (!angle) return;
      if (!first) first = angle;
      const double off = signed_angle(*angle - *first);
      low = std::min(low, off), high = std::max(high, off);
    }
  }
  if (high - low > widest) return;
  const double trim = 4 * slack_ / radius_ + 1e-12;
  each_range(*first + low + trim, high - low - 2 * trim, [&](double begin, double end) {
    for (int i = int(std::ceil(begin)); i + 1 <= end; ++i)
      blocked_[std::size_t(i)] = std::min(blocked_[std::size_t(i)], reach);
  });
}

/// Whether all bins that a range of angles touches are blocked before a length.
template <class Hides>
bool Horizon::bins_hide(double from, double width, double length, const Hides& finer_hides) const {
  bool hidden = true;
  each_range(from, width, [&](double begin, double end) {
    const int first = std::min(int(begin), bins - 1), last = std::min(int(end), bins - 1);
    for (int i = first; hidden && i <= last; ++i) {
      if (blocked_[std::size_t(i)] < length) continue;
      hidden = finer_ && i >= first_open_ && i <= last_open_ && finer_hides(*finer_);
    }
  });
  return hidden;
}

bool Horizon::hides(double angle, double length) const {
  const double pad = 2 * slack_ / radius_ + 1e-12;  // ways may leave that much beyond the range
  return bins_hide(angle - pad, 2 * pad, length, [&](const Horizon& finer) { return finer.hides(angle, length); });
}

/// All ways that leave the wheel towards the circle about the box.
bool Horizon::hides(const Box& box) const {
  const double near = distance(wheel_.center, box);
  if (!(near > 2 * radius_ + slack_)) return false;
  const Point middle{(box.min_x + box.max_x) / 2, (box.min_y + box.max_y) / 2};
  const double half = std::hypot(box.max_x - box.min_x, box.max_y - box.min_y) / 2;
  const Point way = middle - wheel_.center;
  const double away = length(way), r = std::abs(wheel_.radius);
  if (!(away > half + r)) return false;
  // By how much tangents to both sides of the circle are turned from the way to its middle.
  const double low = std::asin((wheel_.radius - half) / away), width = std::asin((wheel_.radius + half) / away) - low;
  const double from = std::atan2(way.y, way.x) + low - ahead();
  if (width > widest) return false;
  const double least = std::sqrt((near - r) * (near + r)) - slack_;
  const double pad = 4 * slack_ / radius_ + 1e-9;
  return bins_hide(from - pad, width + 2 * pad, least, [&](const Horizon& finer) { return finer.hides(box); });
}

}  // namespace krepl::route
