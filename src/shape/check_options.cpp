#include "shape/check_options.hpp"

#include <cmath>
#include <string>

namespace krepl::shape {
namespace {

Error usage(std::string what, std::string remedy) { return {ErrorCode::usage, std::move(what), "", std::move(remedy)}; }

}  // namespace

Status check_options(const Network& network, const ShapeOptions& o) {
  if (!std::isfinite(o.distance) || o.distance == 0)
    return usage("the radius is zero or not a finite number", "give a number above or below zero");
  if (!std::isfinite(o.mitre_limit) || o.mitre_limit < 1)
    return usage("the mitre limit is below 1", "give the largest ratio of a mitre's length to the radius, 1 or more");
  if (o.ring && !network.has_polygons())
    return usage("there is no polygon to take out of its zone", "a ring is made of polygons");
  if (o.side == Side::both) return std::monostate{};
  if (o.distance < 0) return usage("a one-sided zone has no negative radius", "choose the other side");
  if (network.has_polygons())
    return usage("a polygon has no left or right side", "use a negative radius, or a ring, for one side of its border");
  if (o.cap == Cap::square) return usage("one-sided zones end straight across", "leave the cap out");
  return std::monostate{};
}

Status check_shrinkable(const Network& network) {
  for (std::uint32_t p = 0; p < network.part_count(); ++p) {
    if (network.part_is_ring(p)) continue;
    const bool point = network.part(p).size() == 1;
    return Error{ErrorCode::usage,
                 std::string("a negative radius shrinks polygons, but there is a ") + (point ? "point" : "line"),
                 "feature " + std::to_string(network.part_feature(p)), "leave it out, or give a positive radius"};
  }
  return std::monostate{};
}

}  // namespace krepl::shape
