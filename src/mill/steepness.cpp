#include "mill/steepness.hpp"

#include <cmath>

#include "terrain/drop_cutter_part.hpp"

namespace krepl::mill {

double Steepness::at(Point place) {
  if (cutter_.cutter().kind() == Cutter::Kind::ball) {
    const DropCutter::Contact contact = cutter_.at(place);
    if (!contact.touches()) return 0;
    return std::atan2(std::hypot(place.x - contact.point.x, place.y - contact.point.y),
                      contact.height - contact.point.z);
  }
  drop::Part part;
  if (!search_.find_touched(place, part)) return 0;
  drop::ProfileTool tool(cutter_.cutter());
  tool.place = place;
  const Point slope = drop::touch_part(part, tool).slope;
  return std::atan(std::hypot(slope.x, slope.y));
}

}  // namespace krepl::mill
