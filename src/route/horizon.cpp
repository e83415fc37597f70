#include "route/horizon.hpp"

namespace krepl::route {
namespace {

/// Looking further for obstacles that block costs more than it saves.
constexpr int most_obstacles = 512;
/// Wider than this a range of angles cannot be told from its complement.
constexpr double widest = 2.5;

/// An angle between -half a turn and half a turn.
double signed_angle(double a) {
  a = std::fmod(a, turn);
  return a > turn / 2 ? a - turn : a < -turn / 2 ? a + turn : a;
}

}  // namespace

Horizon::Horizon(const Obstacles& obstacles, const Wheel& wheel, double from, double span, double radius, double slack)
    : wheel_(wheel), from_(from), span_(std::max(span, 1e-9)), radius_(radius), slack_(slack) {
  blocked_.fill(std::numeric_limits<double>::infinity());
  int seen = 0;
  obstacles.each_by_distance(wheel.center, [&](double distance, Point a, Point b) {
    block(a, b);
    return ++seen < most_obstacles && (seen % 16 != 0 || !done(distance));
  });
}

/// True if everything is blocked nearer than what comes next.
bool Horizon::done(double distance) const {
  return std::all_of(blocked_.begin(), blocked_.end(), [&](double b) { return b < distance; });
}

std::optional<double> Horizon::leaving(Point center, double radius) const {
  const auto t = tangent(wheel_, {center, radius}, 0);
  if (!t || !(t->length > 0)) return std::nullopt;
  const double way = std::atan2(t->direction.y, t->direction.x);
  return wheel_.radius > 0 ? way - turn / 4 : wheel_.radius < 0 ? way + turn / 4 : way;
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
  for (const Point end : {a, b}) {
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

bool Horizon::hides(double angle, double length) const {
  bool hidden = true;
  const double pad = 2 * slack_ / radius_ + 1e-12;  // ways may leave that much beyond the range
  each_range(angle - pad, 2 * pad, [&](double begin, double end) {
    const int first = std::min(int(begin), bins - 1), last = std::min(int(end), bins - 1);
    for (int i = first; i <= last; ++i) hidden = hidden && blocked_[std::size_t(i)] < length;
  });
  return hidden;
}

bool Horizon::hides(const Box& box) const {
  const double near = distance(wheel_.center, box);
  if (!(near > 2 * radius_ + slack_)) return false;
  std::optional<double> first;
  double low = 0, high = 0;
  for (const Point corner : {Point{box.min_x, box.min_y}, Point{box.max_x, box.min_y}, Point{box.min_x, box.max_y},
                             Point{box.max_x, box.max_y}}) {
    const auto angle = leaving(corner, 0);
    if (!angle) return false;
    if (!first) first = angle;
    const double off = signed_angle(*angle - *first);
    low = std::min(low, off), high = std::max(high, off);
  }
  if (high - low > widest) return false;
  const double length = std::sqrt((near - wheel_.radius) * (near + wheel_.radius)) - slack_;
  const double pad = 4 * slack_ / radius_ + 1e-9;
  bool hidden = true;
  each_range(*first + low - pad, high - low + 2 * pad, [&](double begin, double end) {
    const int from = std::min(int(begin), bins - 1), to = std::min(int(end), bins - 1);
    for (int i = from; hidden && i <= to; ++i) hidden = blocked_[std::size_t(i)] < length;
  });
  return hidden;
}

}  // namespace krepl::route
