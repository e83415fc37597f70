#pragma once

#include "profile/sweep.hpp"

// Joining two sweeps at their one crossing: the parts that hand out pieces. The search is in join.cpp.
namespace krepl::profile {

template <class Writer>
bool Sweep::join(const Sweep& right, Writer&& write) {
  Splice splice;
  return find_splice(right, splice) && splice_in(right, splice, write);
}

template <class Writer>
bool Sweep::join_repeated(const Sweep& right, Writer&& write) {
  Splice splice;
  return find_agreement(right, splice) && splice_in(right, splice, write);
}

template <class Writer>
bool Sweep::take(const Sweep& right, Writer&& write) {
  return splice_in(right, {0, 0, false, {}}, write);
}

template <class Writer>
bool Sweep::splice_in(const Sweep& right, const Splice& splice, Writer&& write) {
  if (splice.keep < emitted_ || !seam_is_clean(right, splice)) return false;
  splice_entries(right, splice);
  if (!right.holding_) {
    for (; emitted_ < top_; ++emitted_)
      emission_.piece(stack_[emitted_], center_at_start(stack_[emitted_ + 1], radius_), write);
    emission_.piece(stack_[top_], right.seam_, write);
    continue_as(right);
  }
  tangent_ = right.tangent_;
  turn_bound_ = right.turn_bound_;
  last_length_ = right.last_length_;
  if (splice.crossing && splice.from == right.open_left_count()) {  // the last arc itself starts at the crossing
    tangent_ = false;
    turn_bound_ = circle_turn_bound(splice.entry.error);
  }
  return true;
}

}  // namespace krepl::profile
