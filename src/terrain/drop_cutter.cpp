#include "krepl/drop_cutter.hpp"

#include <cmath>
#include <string>

#include "kernel/parallel.hpp"
#include "terrain/drop_cutter_hierarchy.hpp"

namespace krepl {
namespace {

constexpr std::size_t run_places = 256;  // of a list, done one after the other

/// Radii that double precision can hold together with coordinates of this size.
Status check_radius(double radius, double extent) {
  if (!std::isfinite(radius) || !(radius > 0)) {
    return Error{ErrorCode::usage, "the radius is not a finite number greater than zero", "", "give one in the unit of the terrain"};
  }
  if (radius < 0x1p-50 * extent || radius > 0x1p50 * extent) {
    const std::string how = radius < extent ? "small" : "large";
    return Error{ErrorCode::usage, "the radius is too " + how + " for the terrain's coordinates in double precision", "",
                 "give one in the unit of the terrain"};
  }
  return std::monostate{};
}

}  // namespace

Result<DropCutter> DropCutter::build(std::shared_ptr<const Terrain> terrain, double radius, const Context& context) {
  const double extent = terrain->extent();
  if (!(extent >= 1e-20 && extent <= 1e30)) {
    return Error{ErrorCode::input, "the terrain's coordinates are outside 1e-20 .. 1e30", "", "scale them"};
  }
  if (Status checked = check_radius(radius, extent); !checked) return checked.error();
  auto hierarchy = std::make_shared<const Hierarchy>(*terrain, context);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return DropCutter(std::move(terrain), std::move(hierarchy), radius);
}

Result<DropCutter> DropCutter::with_radius(double radius) const {
  if (Status checked = check_radius(radius, hierarchy_->extent()); !checked) return checked.error();
  return DropCutter(terrain_, hierarchy_, radius);
}

DropCutter::Contact DropCutter::at(Point place) const {
  Hierarchy::Trace none;
  return hierarchy_->with_tree([&](const auto& tree) { return hierarchy_->touch(tree, place, radius_, none); });
}

Status DropCutter::at(std::span<const Point> places, std::span<Contact> contacts, const Context& context) const {
  if (contacts.size() != places.size()) {
    return Error{ErrorCode::usage, "there is not one contact for each place", "", ""};
  }
  kernel::Progress progress(context, places.size());
  const bool done = kernel::parallel_blocks(context, places.size(), run_places, [&](std::size_t first, std::size_t last) {
    hierarchy_->with_tree([&](const auto& tree) {
      Hierarchy::Trace trace;
      for (std::size_t i = first; i < last; ++i) contacts[i] = hierarchy_->touch(tree, places[i], radius_, trace);
    });
    progress.add(last - first);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return std::monostate{};
}

}  // namespace krepl
