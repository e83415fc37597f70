#pragma once

#include <vector>

#include "zone/cover.hpp"

namespace krepl::zone {

/// An uncovered stretch of a boundary element: a piece of the zone's boundary, between the elements it comes from and
/// continues on. A pair (from, to) of elements occurs once along the whole boundary, so pieces are linked by their labels.
struct Piece {
  Index element, from, to;
  friend bool operator==(const Piece&, const Piece&) = default;
};

/// Subtracts covered intervals from one element and finds what stays uncovered, with the labels at its ends.
template <class Real>
class Gaps {
 public:
  enum class Outcome { covered, found, uncertain };

  /// Starts with the element [0, end], its neighbours along the boundary (`none` where it must be covered) and the error
  /// of its ends' parameters.
  void start(Index element, Real end, Real error, Index start_label, Index end_label);
  /// Subtracts one interval; returns true when nothing can be left.
  bool subtract(const Cover<Real>& cover);

  /// The uncovered pieces, appended to `out` if they are certain within the error bounds.
  Outcome find(const Instance& instance, std::vector<Piece>& out) const;
  /// The uncovered pieces by the values as they are, equal ones ordered by their label: the last rung.
  void find_by_value(const Instance& instance, std::vector<Piece>& out) const;
  /// The smallest distance between two ends that a decision of find() rested on.
  Real margin() const;

  const std::vector<Cover<Real>>& covers() const { return covers_; }
  /// Where something may be left: parameters between its ends, precondition: subtract() has not returned true.
  Real open_low() const { return open_.front().low; }
  Real open_high() const { return open_.back().high; }

 private:
  struct Stretch {
    Real low, high;
  };
  enum class Side { left, right };
  /// Of the ends met at one side of a gap, the one that is the boundary; none if that is uncertain.
  Index boundary_label(const Instance& instance, Side side) const;

  Index element_ = none;
  std::vector<Cover<Real>> covers_;     // first two: what lies before and after the element
  std::vector<Stretch> open_;           // what is not certainly covered
  mutable std::vector<const Cover<Real>*> left_, right_;
};

extern template class Gaps<double>;
extern template class Gaps<quad>;

}  // namespace krepl::zone
