#include "mill/cutter_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "mill/ball_bodies.hpp"
#include "mill/part_domain.hpp"
#include "terrain/drop_cutter_part.hpp"

namespace krepl::mill {

bool CutterBodies::list(const Line& line, double from, double to, double floor, bool all) {
  line_ = line, listed_ = {from, to};
  if (search_.list(line.at(from), line.at(to), floor - lift_, slack_, parts_)) return true;
  // Halving a stretch does not help where as many triangles meet.
  if (!all && to - from > stretch() / 64) return false;
  search_.list_all(line.at(from), line.at(to), parts_);
  return true;
}

Interval CutterBodies::domain(std::size_t body) const {
  if (body < parts_.size()) return domain_of(parts_[body], tool_.radius, line_);
  const double more = std::max(listed_.high - listed_.low, tool_.radius);
  return {listed_.low - more, listed_.high + more};
}

Touch CutterBodies::at(std::size_t body, double t) const {
  const Point d = line_.direction, place = line_.at(t);
  if (body == parts_.size()) {
    const drop::StretchSearch::Base& base = search_.base();
    const double rise = base.slope.x * (place.x - base.place.x) + base.slope.y * (place.y - base.place.y);
    return {base.height + rise + lift_, base.slope.x * d.x + base.slope.y * d.y};
  }
  drop::ProfileTool tool = tool_;
  tool.place = place;
  const drop::PartTouch touch = drop::touch_part(parts_[body], tool);
  return {touch.height + lift_, touch.slope.x * d.x + touch.slope.y * d.y};
}

double CutterBodies::top_of_narrow(std::size_t body, double width) const {
  const drop::Part& p = parts_[body];
  // As far from the axis as for balls.
  const double reach = std::max(0.0, tool_.radius - width / 2);
  return std::max({p.corner[0].z, p.corner[1].z, p.corner[2].z}) - tool_.profile.height(reach) + lift_;
}

double CutterBodies::stretch() const {
  return 0.5 * std::sqrt(tool_.radius * std::min(search_.cell(), 4 * tool_.radius));
}

std::unique_ptr<LineBodies> make_bodies(const LiftedCutter& cutter, double slack) {
  if (cutter.drop.cutter().kind() == Cutter::Kind::ball) return std::make_unique<BallBodies>(cutter.drop);
  return std::make_unique<CutterBodies>(cutter, slack);
}

}  // namespace krepl::mill
