#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "krepl/profile.hpp"
#include "profile/contact.hpp"
#include "profile/element.hpp"
#include "profile/emission.hpp"
#include "profile/ladder.hpp"

namespace krepl::profile {

/// The stack of thesis section 2.3 over a run of consecutive segments: the boundary of the sum of what was appended so
/// far. The last entry is always the arc about the last vertex, ending at its rightmost point.
class Sweep {
 public:
  /// Segments taken at a time; settle() after each batch keeps the stack small.
  static constexpr std::size_t batch = 128;

  /// Begins anew with one point. `held`: keep the entries near the left end, for joining to what lies left of it.
  void start(double radius, Point first, std::uint32_t index, bool held);

  /// Appends points[0 .. count), count <= batch, vertices number index and following. Returns how many were taken before
  /// one that is not finite, too large, or left of the one before it.
  std::size_t append(const Point* points, std::size_t count, std::uint32_t index);

  /// Hands pieces that no later point can change to the writer: those that end left of (last x) - R.
  template <class Writer>
  void settle(Writer&& write) {
    const std::size_t top = size() - 1;
    while (emitted_ < top && final_start(stack_[emitted_ + 1])) {
      if (holding_ && !hold_ends_at(emitted_)) {
        ++emitted_;
        continue;
      }
      emission_.piece(stack_[emitted_], center_at_start(stack_[emitted_ + 1], radius_), write);
      ++emitted_;
    }
    compact();
  }

  /// Hands over the rest, with the half-line on the right.
  template <class Writer>
  void finish(Writer&& write) {
    const Point last = stack_[top_].a;
    for (; emitted_ < top_; ++emitted_)
      emission_.piece(stack_[emitted_], center_at_start(stack_[emitted_ + 1], radius_), write);
    emission_.piece(stack_[top_], {last.x + radius_, last.y}, write);
    emission_.right_half_line(stack_[top_], write);
  }

  /// Replaces the open boundary by that of this and `right`, which starts at this one's last vertex, where their one
  /// crossing can be found with certainty; pieces of `right` that it has emitted itself follow those written here.
  /// Returns false, with nothing changed, where it cannot: repeat `right`'s points with append() and join_repeated().
  template <class Writer>
  bool join(const Sweep& right, Writer&& write);
  /// After appending some of `right`'s points here: true if the two now agree, and `right`'s further boundary was taken over.
  template <class Writer>
  bool join_repeated(const Sweep& right, Writer&& write);
  /// Takes over the whole of `right`, which starts at the first vertex of all. Precondition: nothing appended here.
  template <class Writer>
  bool take(const Sweep& right, Writer&& write);

  std::size_t size() const { return top_ + 1; }
  const Point& last_vertex() const { return stack_[top_].a; }
  const ProfileCounters& counters() const { return counters_; }
  std::uint64_t dropped_pieces() const { return emission_.dropped(); }

 private:
  struct Edges {
    alignas(64) std::array<double, batch> nx, ny, length;
  };
  struct Top;
  struct Splice {
    std::size_t keep;   // entries of this that stay
    std::size_t from;   // entries of the right one from here on follow
    bool crossing;      // with this entry between them
    Entry entry;
  };

  std::size_t measure(const Point* points, std::size_t count);
  Start crossing(const Entry& p, Point v, Point w, Point n, double length, bool on_circle);
  double circle_turn_bound(float error) const { return double(error) / radius_ + 8 * epsilon<double>; }
  void compact();
  bool hold_ends_at(std::size_t entry);
  /// Entries not handed out, or kept for joining; those that only wait for being taken off do not count.
  std::size_t held() const { return holding_ ? size() : size() - (emitted_ - hold_); }

  /// No later point reaches this start: it lies left of (last x) - R by more than its error.
  bool final_start(const Entry& e) const {
    const double dx = e.a.x - stack_[top_].a.x;
    const double x = dx + (radius_ * e.n.x + e.t * e.n.y);
    return x + radius_ < -(double(e.error) + 0x1p-44 * (std::fabs(dx) + radius_ + e.t));
  }

  bool find_splice(const Sweep& right, Splice& splice);
  bool crossing_with(const Sweep& right, std::size_t mine, std::size_t theirs, Splice& splice);
  bool find_agreement(const Sweep& right, Splice& splice) const;
  int place_above(Vec<double> place, Point origin) const;
  Vec<double> start_from(std::size_t entry, Point origin) const;
  Vec<double> open_end_from(std::size_t entry, Point origin) const;
  bool seam_is_clean(const Sweep& right, const Splice& splice) const;
  void splice_entries(const Sweep& right, const Splice& splice);
  void continue_as(const Sweep& right);
  template <class Writer>
  bool splice_in(const Sweep& right, const Splice& splice, Writer&& write);
  /// Entries from the left end whose pieces have not been handed out; without holding, those after emitted_begin().
  std::size_t open_left_count() const { return holding_ || hold_ == 0 ? size() : hold_; }
  std::size_t emitted_begin() const { return holding_ || hold_ > 0 ? 1 : emitted_; }

  double radius_ = 0;
  std::vector<Entry> stack_;
  std::size_t top_ = 0;       // the arc about the last vertex
  std::size_t emitted_ = 0;   // entries below have been handed over (or, while holding, are final)
  bool tangent_ = true;       // the last arc continues the side before it smoothly
  double turn_bound_ = 0;     // rounding bound for the turn at the last vertex
  double last_length_ = 0;    // of the segment that ends at the last vertex
  Emission emission_;
  Edges edges_;
  ProfileCounters counters_;

  bool holding_ = false;
  std::size_t hold_ = 0;      // entries [0, hold_) are kept; pieces from there on were emitted
  double hold_limit_ = 0;     // x beyond which what lies left of the first vertex has no influence
  int beyond_limit_ = 0;
  Point seam_;                // where the first emitted piece starts
};

}  // namespace krepl::profile
