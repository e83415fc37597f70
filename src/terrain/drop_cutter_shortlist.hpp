#pragma once

#include "terrain/drop_cutter_search.hpp"

namespace krepl::drop {

/// All triangles that may hold the highest touch over some place of a rectangle: few, so that every place looks at the list
/// instead of the hierarchy.
class Shortlist {
 public:
  static constexpr std::size_t capacity = 128;

  bool overflowed() const { return overflowed_; }

  /// The triangles at the lanes of a mask, with their bounds and numbers.
  template <class Number>
  void add(const FourTriangles& four, unsigned lanes, const float*, const Number& number) {
    if (lanes == 0) return;
    if (count_ + 4 > capacity) {
      overflowed_ = true;
      return;
    }
    const Float4* from[fields] = {&four.top, &four.z, &four.slope_x, &four.slope_y, &four.ax, &four.ay, &four.bx, &four.by, &four.cx, &four.cy};
    float value[fields][4];
    for (std::size_t f = 0; f < fields; ++f) from[f]->store(value[f]);
    for (; lanes != 0; lanes &= lanes - 1) {
      const unsigned lane = unsigned(__builtin_ctz(lanes));
      for (std::size_t f = 0; f < fields; ++f) field_[f][count_] = value[f][lane];
      number_[count_++] = number(lane);
    }
  }
  /// To be called once after the last add(): fills up the last four.
  void close() {
    for (std::size_t i = count_; i % 4 != 0; ++i) {
      for (auto& field : field_) field[i] = 0;
      field_[top][i] = field_[z][i] = -float_infinity;
    }
  }

  /// Looks at the triangles by tree.touch(), the place being (dx, dy) off the centre of the list.
  template <class Tree>
  void run(const Tree& tree, Search& search, float dx, float dy) const {
    Candidates<capacity> found;
    for (std::size_t i = 0; i < count_; i += 4) {
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
  std::size_t count_ = 0;
  bool overflowed_ = false;
  alignas(16) float field_[fields][capacity];
  Index number_[capacity];
};

}  // namespace krepl::drop
