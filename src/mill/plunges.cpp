#include "mill/plunges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "kernel/parallel.hpp"

namespace krepl::mill {
namespace {

constexpr int most_rounds = 32;
constexpr int most_drops = 1 << 16;  // for one place
constexpr double of_height = 1.0 / 8;  // the smallest cubes, so that a place serves all cubes about it

/// A block of the lattice, ends included.
struct Block {
  std::int64_t i0, i1, j0, j1;
  bool is_place() const { return i0 == i1 && j0 == j1; }
};

/// Blocks of lattice places around a place, the nearest first as far as that goes, without those in which all places are in the part.
class LatticeSearch {
 public:
  LatticeSearch(const DropCutter& cutter, double unit, Point3 place, double top)
      : cutter_(cutter), unit_(unit), origin_(cutter.terrain().origin()), place_(place), top_(top) {}

  void look(const Block& b) {
    if (drops_ >= most_drops) return;
    const double away = std::hypot(off(b.i0, b.i1, place_.x + origin_.x), off(b.j0, b.j1, place_.y + origin_.y));
    if (found_ && away >= nearest_) return;
    const Point middle{double(b.i0 + b.i1) / 2 * unit_ - origin_.x, double(b.j0 + b.j1) / 2 * unit_ - origin_.y};
    ++drops_;
    if (b.is_place()) {
      const double height = cutter_.at(middle).height;
      if (height <= top_) found_ = Point3{middle.x, middle.y, height}, nearest_ = away;
      return;
    }
    // A ball within all of those at the block's places.
    const double half = unit_ / 2 * std::hypot(double(b.i1 - b.i0), double(b.j1 - b.j0));
    if (const auto smaller = cutter_.with_radius(cutter_.radius() - half); smaller && smaller->at(middle).height > top_) return;
    divide(b);
  }

  const std::optional<Point3>& found() const { return found_; }
  bool gave_up() const { return drops_ >= most_drops; }

 private:
  double off(std::int64_t first, std::int64_t last, double x) const {
    return std::max({0.0, double(first) * unit_ - x, x - double(last) * unit_});
  }
  void divide(const Block& b) {
    Block parts[2] = {b, b};
    if (b.i1 - b.i0 >= b.j1 - b.j0)
      parts[0].i1 = b.i0 + (b.i1 - b.i0) / 2, parts[1].i0 = parts[0].i1 + 1;
    else
      parts[0].j1 = b.j0 + (b.j1 - b.j0) / 2, parts[1].j0 = parts[0].j1 + 1;
    const double x = place_.x + origin_.x, y = place_.y + origin_.y;
    const auto away = [&](const Block& p) { return std::hypot(off(p.i0, p.i1, x), off(p.j0, p.j1, y)); };
    if (away(parts[1]) < away(parts[0])) std::swap(parts[0], parts[1]);
    for (const Block& p : parts) look(p);
  }

  const DropCutter& cutter_;
  const double unit_;
  const Point3 origin_, place_;
  const double top_;
  std::optional<Point3> found_;
  double nearest_ = 0;
  int drops_ = 0;
};

}  // namespace

Plunges::Found Plunges::find(Point3 place, double within) const {
  const Point3 origin = cutter_.terrain().origin();
  // Whatever is free of the contact ball has a free place of the lattice nearer than a unit.
  const auto first = [&](double x) { return std::int64_t(std::floor((x - within) / unit_)); };
  const auto last = [&](double x) { return std::int64_t(std::ceil((x + within) / unit_)); };
  LatticeSearch search(cutter_, unit_, place, place.z + within);
  search.look({first(place.x + origin.x), last(place.x + origin.x), first(place.y + origin.y), last(place.y + origin.y)});
  if (!search.found()) return {std::nullopt, !search.gave_up()};
  const Point3 p = *search.found();
  const double z = std::max(p.z, plan_.floor);
  return {Point3{p.x + origin.x, p.y + origin.y, std::ceil((z - plan_.z0) / unit_) * unit_ + plan_.tip}, false};
}

/// Cuts at places, few where these are near each other: a cut serves what is beside and above it.
bool Plunges::add(const std::vector<Point3>& found, std::vector<Cut>& plunges) const {
  const auto is_served = [](const Cut& cut, Point3 p, double near) {
    return cut.start.z <= p.z && std::hypot(cut.start.x - p.x, cut.start.y - p.y) <= near;
  };
  std::vector<Point3> lowest = found;
  std::sort(lowest.begin(), lowest.end(), [](Point3 a, Point3 b) { return std::tie(a.z, a.x, a.y) < std::tie(b.z, b.x, b.y); });
  const std::size_t before = plunges.size();
  for (const Point3 p : lowest) {
    bool served = false;
    for (std::size_t k = 0; k < plunges.size() && !served; ++k)
      served = is_served(plunges[k], p, k < before ? 0 : cover_.height / 2);
    if (!served) plunges.push_back({p, {}});
  }
  return plunges.size() > before;
}

bool Plunges::serve(const std::function<void(CoverProof&)>& add_cuts, std::vector<std::size_t> tiles,
                    const std::function<bool(Point3, double)>& is_of_interest, const Context& context,
                    std::vector<Cut>& plunges, std::vector<Point3>& open) const {
  CoverOptions finer = cover_;
  finer.smallest = cover_.height * of_height;
  CoverProof proof(contact_, finer);
  add_cuts(proof);
  std::size_t proven = 0;
  for (int round = 0;; ++round) {
    for (; proven < plunges.size(); ++proven) proof.add(plunges[proven]);
    std::vector<std::size_t> open_tiles;
    if (!proof.run(tiles, is_of_interest, context, open, open_tiles)) return false;
    std::vector<Found> found(open.size());
    const double within = proof.smallest_side() / 2 + unit_;
    if (!kernel::parallel_blocks(context, open.size(), 16, [&](std::size_t first, std::size_t last) {
          for (std::size_t k = first; k < last; ++k) found[k] = find(open[k], within);
        }))
      return false;
    std::vector<Point3> places;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (found[k].at) places.push_back(*found[k].at);
      if (!found[k].is_empty) open[kept++] = open[k];
    }
    open.resize(kept);
    if (round == most_rounds || !add(places, plunges)) return true;
    tiles = open_tiles;
  }
}

}  // namespace krepl::mill
