#include "shape/bend_region.hpp"

#include <algorithm>
#include <cmath>

#include "shape/join_choice.hpp"

namespace krepl::shape {

using namespace vectors;
using zone::Index;
using zone::none;

std::optional<BendRegion> BendRegion::at(const zone::Instance& in, Index vertex, const ShapeOptions& options) {
  if (options.join == Join::round) return std::nullopt;
  const auto sector = in.sector(vertex);
  const auto normal = [&](Index side) {
    const auto ends = in.ends(side);
    const Point d = in.vertices()[ends.to] - in.vertices()[ends.from];
    const double l = length(d);
    return Point{d.y / l, -d.x / l};
  };
  const Point before = normal(sector.before), after = normal(sector.after);
  const double angle = std::atan2(cross(before, after), dot(before, after));
  const Join join = join_of(options, angle);
  if (join == Join::round) return std::nullopt;
  const double radius = in.nominal_radius();
  const Point at = in.vertices()[vertex];
  if (join == Join::mitre)
    return BendRegion(at, {{before, radius, sector.before}, {after, radius, sector.after}});
  const Point middle = before + after;
  return BendRegion(at, {{(1 / length(middle)) * middle, radius * std::cos(angle / 2), none}});
}

double BendRegion::excess(Point place) const {
  double most = -HUGE_VAL;
  for (const Border& b : borders_) most = std::max(most, dot(b.normal, place - vertex_) - b.distance);
  return most;
}

std::vector<BendRegion::Stretch> BendRegion::stretches(Point from, Point to) const {
  const Border& first = borders_.front();
  if (borders_.size() == 1) return {{first, from, to}};
  const Border& second = borders_.back();
  // The tip is as far along the first border as the angle between the two tells.
  const double cosine = dot(first.normal, second.normal), sine = cross(first.normal, second.normal);
  const Point along{-first.normal.y, first.normal.x};
  const Point tip = vertex_ + first.distance * first.normal + (first.distance * sine / (1 + cosine)) * along;
  if (cross(to - vertex_, tip - vertex_) >= 0) return {{first, from, to}};
  if (cross(from - vertex_, tip - vertex_) <= 0) return {{second, from, to}};
  return {{first, from, tip}, {second, tip, to}};
}

}  // namespace krepl::shape
