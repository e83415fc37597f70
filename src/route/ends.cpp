#include "route/ends.hpp"

#include <cstdio>
#include <string>

#include "model/radius_check.hpp"

namespace krepl::route {
namespace {

std::string digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", x);
  return text;
}

std::string name_of(const Obstacles& obstacles, std::uint32_t item) {
  const Network::Source source = obstacles.source(item);
  const bool segment = item < obstacles.network().segments().size();
  return "feature " + std::to_string(source.feature) + " (part " + std::to_string(source.part) +
         (segment ? ", segment from vertex " : ", vertex ") + std::to_string(source.vertex) + ")";
}

}  // namespace

std::string place_text(const Network& network, Point p) {
  return digits(p.x + network.origin().x) + " " + digits(p.y + network.origin().y);
}

std::optional<Error> refuse_end(const Obstacles& obstacles, Point p, double radius, double clearance, const char* end) {
  const Network& network = obstacles.network();
  const Obstacles::Nearest nearest = obstacles.nearest(p);
  const std::string remedy = "move it to a free place, or use a smaller radius";
  if (const auto polygon = obstacles.polygon_around(p)) {
    return Error{ErrorCode::input,
                 std::string(end) + " is inside the polygon of feature " + std::to_string(*polygon) + ", " +
                     shown(nearest.distance) + " from its border: the disk overlaps it, " +
                     shown(nearest.distance + radius) + " deep",
                 "at " + place_text(network, p), remedy};
  }
  if (nearest.distance >= clearance) return std::nullopt;
  return Error{ErrorCode::input,
               std::string(end) + ": the disk overlaps " + name_of(obstacles, nearest.item) + ", " +
                   shown(radius - nearest.distance) + " deep",
               "at " + place_text(network, p) + ", touching " + place_text(network, nearest.at), remedy};
}

}  // namespace krepl::route
