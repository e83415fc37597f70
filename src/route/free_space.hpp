#pragma once

#include <optional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/zone.hpp"
#include "route/obstacles.hpp"

namespace krepl::route {

/// The slack within which decisions are taken (route.hpp): the zone's radius is `shrink` less than the disk's, and what
/// is tested against the obstacles may be `tolerance` nearer than the disk's radius.
struct Slack {
  double shrink, tolerance;
};
Slack slack_for(const Network& network, double radius);

/// An arc of the boundary of free space, which a taut string may turn about. Relative to the network's origin.
struct FreeArc {
  Point center;
  double from, span;  ///< counter-clockwise
  bool full;          ///< the whole circle
  std::uint32_t vertex;
};

/// The free places of a disk's centre: outside its zone.
class FreeSpace {
 public:
  /// Errors: those of compute_zone.
  static Result<FreeSpace> build(std::shared_ptr<const Network> network, double radius, const Context& context);

  const std::vector<FreeArc>& arcs() const { return arcs_; }
  /// The hole of the zone that a free place lies in; nothing outside all of them. O(pieces).
  std::optional<std::uint32_t> pocket(Point p) const;

 private:
  explicit FreeSpace(Zone zone) : zone_(std::move(zone)) {}
  void collect_arcs();
  Zone zone_;
  std::vector<FreeArc> arcs_;
};

}  // namespace krepl::route
