#pragma once

#include <vector>

#include "terrain/drop_cutter_search.hpp"

namespace krepl::drop {

/// The numbers of all triangles that may hold the highest touch over some place of a rectangle, however many.
class LongList {
 public:
  bool overflowed() const { return false; }
  const std::vector<Index>& numbers() const { return numbers_; }
  void clear() { numbers_.clear(); }
  template <class Number>
  void add(const FourTriangles&, unsigned lanes, const float*, const Number& number) {
    for (; lanes != 0; lanes &= lanes - 1) numbers_.push_back(number(unsigned(__builtin_ctz(lanes))));
  }
  void close() {}

 private:
  std::vector<Index> numbers_;
};

/// All triangles that may hold the highest touch over some place of a rectangle: few, so that every place looks at the list
/// instead of the hierarchy.
class Shortlist {
 public:
  static constexpr std::size_t capacity = 128;

  bool overflowed() const { return overflowed_; }
  std::size_t size() const { return count_; }
  /// Of the triangle at a place of the list, in the order that they were added in.
  Index number(std::size_t i) const { return entry_[i].number; }

  /// The triangles at the lanes of a mask, with their bounds and numbers.
  template <class Number>
  void add(const FourTriangles& four, unsigned lanes, const float* bounds, const Number& number) {
    if (lanes == 0) return;
    if (count_ + 4 > capacity) {
      overflowed_ = true;
      return;
    }
    const Float4* from[fields] = {&four.top, &four.z,  &four.slope_x, &four.slope_y, &four.ax,
                                  &four.ay,  &four.bx, &four.by,      &four.cx,      &four.cy};
    float value[fields][4];
    for (std::size_t f = 0; f < fields; ++f) from[f]->store(value[f]);
    for (; lanes != 0; lanes &= lanes - 1) {
      const unsigned lane = unsigned(__builtin_ctz(lanes));
      Entry& entry = entry_[count_++];
      entry.bound = bounds[lane], entry.number = number(lane);
      for (std::size_t f = 0; f < fields; ++f) entry.field[f] = value[f][lane];
    }
  }

  /// To be called once after the last add(): puts the most promising first.
  void close() {
    std::array<std::uint8_t, capacity> order;
    for (std::size_t i = 0; i < count_; ++i) order[i] = std::uint8_t(i);
    std::sort(order.begin(), order.begin() + std::ptrdiff_t(count_), [&](std::size_t a, std::size_t b) {
      return entry_[a].bound != entry_[b].bound ? entry_[a].bound > entry_[b].bound : entry_[a].number < entry_[b].number;
    });
    for (std::size_t i = 0; i < (count_ + 3) / 4 * 4; ++i) {
      const Entry& entry = i < count_ ? entry_[order[i]] : nobody();
      bound_[i] = entry.bound, number_[i] = entry.number;
      for (std::size_t f = 0; f < fields; ++f) field_[f][i] = entry.field[f];
    }
  }

  /// Looks at the triangles by tree.touch(), the place being (dx, dy) off the centre of the list, where the plane of the
  /// survey is `rise` higher than there.
  template <class Tree, class Search>
  void run(const Tree& tree, Search& search, float dx, float dy, float rise) const {
    Candidates<capacity> found;
    for (std::size_t i = 0; i < count_ && bound_[i] + rise >= search.threshold_of_triangles(); i += 4) {
      const auto load = [&](Field f) { return Float4::load(&field_[f][i]); };
      const FourTriangles four{load(top),     load(z),       load(slope_x), load(slope_y), load(ax) - dx,
                               load(ay) - dy, load(bx) - dx, load(by) - dy, load(cx) - dx, load(cy) - dy};
      float bounds[4];
      for (unsigned lanes = search.worth(four, bounds); lanes != 0; lanes &= lanes - 1) {
        const unsigned lane = unsigned(__builtin_ctz(lanes));
        found.add(bounds[lane], number_[i + lane]);
      }
    }
    for (const auto& entry : found) {
      if (entry.bound < search.threshold_of_triangles()) return;
      tree.touch(search, entry.column);
    }
  }

 private:
  enum Field { top, z, slope_x, slope_y, ax, ay, bx, by, cx, cy, fields };
  struct Entry {
    float bound;
    Index number;
    float field[fields];
  };
  static const Entry& nobody() {
    static constexpr Entry entry{-float_infinity, Terrain::none, {-float_infinity, -float_infinity}};
    return entry;
  }

  std::size_t count_ = 0;
  bool overflowed_ = false;
  std::array<Entry, capacity> entry_;  // as they came
  // In order, by fields.
  float bound_[capacity], field_[fields][capacity];
  Index number_[capacity];
};

}  // namespace krepl::drop
