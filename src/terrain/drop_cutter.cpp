#include "krepl/drop_cutter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "kernel/parallel.hpp"
#include "terrain/drop_cutter_grid.hpp"
#include "terrain/drop_cutter_mesh.hpp"
#include "terrain/drop_cutter_settle.hpp"

namespace krepl {
namespace {

using drop::Search;
using Index = Terrain::Index;

constexpr std::size_t run_places = 256;   // of a list, done one after the other
constexpr std::size_t tile_places = 32;   // a side of a raster's tile, done in a serpentine

/// Radii that double precision can hold together with coordinates of this size.
Status check_radius(double radius, double extent) {
  if (!std::isfinite(radius) || !(radius > 0)) {
    return Error{ErrorCode::usage, "the radius is not a finite number greater than zero", "", "give one in the unit of the terrain"};
  }
  if (radius < 0x1p-50 * extent || radius > 0x1p50 * extent) {
    return Error{ErrorCode::usage, std::string("the radius is too ") + (radius < extent ? "small" : "large") + " for the terrain's coordinates in double precision",
                 "", "give one in the unit of the terrain"};
  }
  return std::monostate{};
}

Error cancelled() { return {ErrorCode::cancelled, "cancelled", "", ""}; }

}  // namespace

class DropCutter::Hierarchy {
 public:
  Hierarchy(const Terrain& terrain, const Context& context) : scale_(terrain), settle_(terrain, scale_.extent) {
    if (terrain.is_grid()) grid_.emplace(terrain, scale_, context);
    else mesh_.emplace(terrain, scale_, context);
  }
  double extent() const { return scale_.extent; }

  /// One place, with what is known from a neighbour: `near` is the part of the hierarchy that it touched, and after the
  /// call the part that this one touches.
  Contact touch(Point place, double radius, Index& near) const {
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) return {};
    if (grid_) return touch(*grid_, place, radius, near);
    return touch(*mesh_, place, radius, near);
  }

  /// A part that the ball may well touch, if at the neighbouring place it touched `last`.
  Index guess(const Contact& last, Index part, Point from, Point to) const {
    if (!last.touches() || !grid_ || settle_.kind(last.feature) != Terrain::FeatureKind::face) return part;
    return grid_->part_at({last.point.x + to.x - from.x, last.point.y + to.y - from.y});
  }

 private:
  template <class Tree>
  Contact touch(const Tree& tree, Point place, double radius, Index& near) const {
    Search search = tree.search(place, radius);
    tree.run(search, near);
    near = search.part();
    if (search.feature() == Terrain::none) return {};
    return settle_.contact(search);
  }

  drop::Scale scale_;
  drop::Settle settle_;
  std::optional<drop::GridPyramid> grid_;
  std::optional<drop::MeshTree> mesh_;
};

Result<DropCutter> DropCutter::build(std::shared_ptr<const Terrain> terrain, double radius, const Context& context) {
  const double extent = terrain->extent();
  if (!(extent >= 1e-20 && extent <= 1e30)) {
    return Error{ErrorCode::input, "the terrain's coordinates are outside 1e-20 .. 1e30", "", "scale them"};
  }
  if (Status checked = check_radius(radius, extent); !checked) return checked.error();
  auto hierarchy = std::make_shared<const Hierarchy>(*terrain, context);
  if (context.cancelled()) return cancelled();
  return DropCutter(std::move(terrain), std::move(hierarchy), radius);
}

Result<DropCutter> DropCutter::with_radius(double radius) const {
  if (Status checked = check_radius(radius, hierarchy_->extent()); !checked) return checked.error();
  return DropCutter(terrain_, hierarchy_, radius);
}

DropCutter::Contact DropCutter::at(Point place) const {
  Index near = Terrain::none;
  return hierarchy_->touch(place, radius_, near);
}

Status DropCutter::at(std::span<const Point> places, std::span<Contact> contacts, const Context& context) const {
  if (contacts.size() != places.size()) {
    return Error{ErrorCode::usage, "there is not one contact for each place", "", ""};
  }
  kernel::Progress progress(context, places.size());
  const bool done = kernel::parallel_blocks(context, places.size(), run_places, [&](std::size_t first, std::size_t last) {
    Index near = Terrain::none;
    for (std::size_t i = first; i < last; ++i) {
      if (i > first) near = hierarchy_->guess(contacts[i - 1], near, places[i - 1], places[i]);
      contacts[i] = hierarchy_->touch(places[i], radius_, near);
    }
    progress.add(last - first);
  });
  if (!done) return cancelled();
  return std::monostate{};
}

Status DropCutter::at(const Raster& raster, std::span<Contact> contacts, const Context& context) const {
  if (raster.columns != 0 && contacts.size() / raster.columns != raster.rows) {
    return Error{ErrorCode::usage, "there is not one contact for each place of the raster", "", ""};
  }
  if (contacts.size() != raster.columns * raster.rows) {
    return Error{ErrorCode::usage, "there is not one contact for each place of the raster", "", ""};
  }
  const std::size_t across = (raster.columns + tile_places - 1) / tile_places, up = (raster.rows + tile_places - 1) / tile_places;
  kernel::Progress progress(context, contacts.size());
  const bool done = kernel::parallel_blocks(context, across * up, 1, [&](std::size_t tile, std::size_t) {
    const std::size_t c0 = tile % across * tile_places, r0 = tile / across * tile_places;
    const std::size_t width = std::min(tile_places, raster.columns - c0), height = std::min(tile_places, raster.rows - r0);
    Index near = Terrain::none;
    const Contact* last = nullptr;
    Point from;
    for (std::size_t k = 0; k < width * height; ++k) {
      const std::size_t row = k / width, column = row % 2 == 0 ? k % width : width - 1 - k % width;
      const Point place = raster.place(c0 + column, r0 + row);
      if (last != nullptr) near = hierarchy_->guess(*last, near, from, place);
      Contact& contact = contacts[(r0 + row) * raster.columns + c0 + column];
      contact = hierarchy_->touch(place, radius_, near);
      last = &contact, from = place;
    }
    progress.add(width * height);
  });
  if (!done) return cancelled();
  return std::monostate{};
}

}  // namespace krepl
