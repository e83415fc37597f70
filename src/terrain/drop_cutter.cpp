#include "krepl/drop_cutter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kernel/hilbert.hpp"
#include "kernel/parallel.hpp"
#include "kernel/radix_sort.hpp"
#include "terrain/drop_cutter_hierarchy.hpp"

namespace krepl {
namespace {

constexpr std::size_t run_places = 256;                    // of a list, done one after the other
constexpr std::size_t most_sorted = std::size_t{1} << 32;  // of a list: numbers of 32 bits
constexpr std::size_t samples_in_cache = std::size_t{1} << 19;

/// Cutters that double precision can hold together with coordinates of this size.
Status check_radius(double radius, double extent) {
  if (!std::isfinite(radius) || !(radius > 0)) {
    return Error{ErrorCode::usage, "the radius is not a finite number greater than zero", "",
                 "give one in the unit of the terrain"};
  }
  if (radius < 0x1p-50 * extent || radius > 0x1p50 * extent) {
    const std::string how = radius < extent ? "small" : "large";
    return Error{ErrorCode::usage, "the radius is too " + how + " for the terrain's coordinates in double precision", "",
                 "give one in the unit of the terrain"};
  }
  return std::monostate{};
}

Status check_cutter(const Cutter& cutter, double extent) {
  if (Status checked = check_radius(cutter.radius(), extent); !checked) return checked.error();
  if (cutter.corner_radius() > 0 && cutter.corner_radius() < 0x1p-50 * cutter.radius()) {
    return Error{ErrorCode::usage, "the tool's corner radius is too small beside its diameter for double precision", "",
                 "give a flat tool or a cone without a tip radius"};
  }
  return std::monostate{};
}

/// Whether a good guess and samples that are in the cache save more than sorting the places costs.
bool is_sorting_worthwhile(const Terrain& terrain, double radius) {
  if (!terrain.is_grid()) return true;
  const Terrain::Grid& grid = terrain.grid();
  return radius > 2 * std::max(grid.cell_x, grid.cell_y) || grid.columns * grid.rows > samples_in_cache;
}

/// Whether a quarter of the places are farther than R from the ones before.
bool is_scattered(std::span<const Point> places, double radius) {
  std::size_t far = 0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double x = places[i].x - places[i - 1].x, y = places[i].y - places[i - 1].y;
    far += x * x + y * y < radius * radius ? 0 : 1;
  }
  return far > places.size() / 4;
}

/// The places along the Hilbert curve, numbers in the lower half of each word.
std::vector<std::uint64_t> along_curve(std::span<const Point> places, const Terrain& terrain, const Context& context) {
  const Point3 low = terrain.lowest(), high = terrain.highest();
  const auto cell = [](double x, double from, double to) {
    const double at = (x - from) / (to - from) * 0x1p16;
    return at >= 0 ? std::uint32_t(std::min(at, 65535.0)) : 0u;  // also if it is not a number
  };
  std::vector<std::uint64_t> words(places.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t x = cell(places[i].x, low.x, high.x), y = cell(places[i].y, low.y, high.y);
    words[i] = std::uint64_t{kernel::HilbertCurve::index(x, y)} << 32 | i;
  }
  Context quiet;
  quiet.threads = context.threads, quiet.cancel = context.cancel;
  kernel::radix_sort(words, 32, quiet);
  return words;
}

}  // namespace

Result<DropCutter> DropCutter::build(std::shared_ptr<const Terrain> terrain, double radius, const Context& context) {
  if (Status checked = check_radius(radius, terrain->extent()); !checked) return checked.error();
  return build(std::move(terrain), *Cutter::ball(2 * radius), context);
}

Result<DropCutter> DropCutter::build(std::shared_ptr<const Terrain> terrain, const Cutter& cutter,
                                     const Context& context) {
  const double extent = terrain->extent();
  if (!(extent >= 1e-20 && extent <= 1e30)) {
    return Error{ErrorCode::input, "the terrain's coordinates are outside 1e-20 .. 1e30", "", "scale them"};
  }
  if (Status checked = check_cutter(cutter, extent); !checked) return checked.error();
  auto hierarchy = std::make_shared<const Hierarchy>(*terrain, context);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return DropCutter(std::move(terrain), std::move(hierarchy), cutter);
}

Result<DropCutter> DropCutter::with_radius(double radius) const {
  if (Status checked = check_radius(radius, hierarchy_->extent()); !checked) return checked.error();
  return with_cutter(*Cutter::ball(2 * radius));
}

Result<DropCutter> DropCutter::with_cutter(const Cutter& cutter) const {
  if (Status checked = check_cutter(cutter, hierarchy_->extent()); !checked) return checked.error();
  return DropCutter(terrain_, hierarchy_, cutter);
}

DropCutter::Contact DropCutter::at(Point place) const {
  Hierarchy::Trace none;
  return with_tools(
      [&](const auto& tree, const auto& tool) { return hierarchy_->touch(tree, Hierarchy::over(place, tool), none); });
}

Status DropCutter::at(std::span<const Point> places, std::span<Contact> contacts, const Context& context) const {
  if (contacts.size() != places.size()) {
    return Error{ErrorCode::usage, "there is not one contact for each place", "", ""};
  }
  std::vector<std::uint64_t> order;  // empty: as given
  if (is_sorting_worthwhile(*terrain_, radius()) && places.size() < most_sorted && is_scattered(places, radius()))
    order = along_curve(places, *terrain_, context);
  kernel::Progress progress(context, places.size());
  const bool done =
      kernel::parallel_blocks(context, places.size(), run_places, [&](std::size_t first, std::size_t last) {
        with_tools([&](const auto& tree, const auto& tool) {
          Hierarchy::Trace trace;
          for (std::size_t k = first; k < last; ++k) {
            const std::size_t i = order.empty() ? k : std::size_t(std::uint32_t(order[k]));
            contacts[i] = hierarchy_->touch(tree, Hierarchy::over(places[i], tool), trace);
          }
        });
        progress.add(last - first);
      });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return std::monostate{};
}

}  // namespace krepl
