#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/free_space.hpp"
#include "krepl/zone.hpp"

/// Connected components of the free space of a disk in the plane (docs/free.md): between two places of one component the disk can
/// go, between those of two it cannot.
namespace krepl {

/// Component 0 is the unbounded one; each hole of the zone is the outer border of one other, in the order of the zone's rings.
///
/// Free space is closed: touching is free, and a gap exactly 2R wide lets the disk through. What touches and what is 2^-44 S too
/// narrow are not told apart (or 16 steps of the coordinates, if these are coarser); S as in krepl/free_space.hpp. This is the
/// tolerance of compute_route, which finds a way if and only if the components are the same.
///
/// Immutable: any number of threads may use one at the same time.
class FreeComponents {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  /// Errors: those of compute_zone and DiskFreeSpace::build; a radius below 4 times the tolerance (usage). Cost: that of the zone.
  static Result<FreeComponents> build(std::shared_ptr<const Network> network, double radius, const Context& context = {});

  std::size_t count() const;
  /// The component of a placement; none if the disk is not free there, or the place is not finite. Expected O(log n).
  std::uint32_t at(Point place) const;
  /// The same for many, with the same bits for any number of threads. Errors: components.size() != places.size() (usage);
  /// cancelled.
  Status at(std::span<const Point> places, std::span<std::uint32_t> components, const Context& context = {}) const;
  /// Whether the disk can get from one place to the other; not if one of them is not free.
  bool same(Point a, Point b) const {
    const std::uint32_t first = at(a);
    return first != none && first == at(b);
  }

  const DiskFreeSpace& space() const;
  /// Of a radius smaller by the tolerance: what lies outside of it are the components.
  const Zone& zone() const;

 private:
  struct State;
  explicit FreeComponents(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  std::shared_ptr<const State> state_;
};

}  // namespace krepl
