#pragma once

#include <array>
#include <memory>
#include <optional>

#include "route/obstacles.hpp"
#include "route/tangent.hpp"

namespace krepl::route {

/// Where a route may still lead: to `goal`, no longer than it would be if it went straight there and `budget` more.
struct Reach {
  Point goal;
  double budget;  ///< infinite: anywhere
};

/// How far one can see from a wheel: the straight ways that leave it, told by where on it they leave, cut into equal
/// bins, and for each bin a length beyond which all its ways are blocked by one obstacle. Where bins are wider than what is
/// in them there are finer ones. Conservative: what it calls hidden is so.
class Horizon {
 public:
  /// The wheel's ways leave where the angle (of the wheel's radius to the place they leave from; of the way itself, if
  /// the wheel is a place) is between `from` and `from + span`. `radius`: of the disk that travels. What is out of
  /// reach counts as hidden, and obstacles there are not looked at.
  Horizon(const Obstacles& obstacles, const Wheel& wheel, double from, double span, double radius, double slack,
          const Reach& reach);

  /// True if no way leads from the wheel to a place in the box.
  bool hides(const Box& box) const;
  /// True if the way that leaves at an angle is blocked before it is so long.
  bool hides(double angle, double length) const;

 private:
  static constexpr int bins = 256;
  /// Angle at which the way to another wheel leaves; nothing if there is none.
  std::optional<double> leaving(Point center, double radius) const;
  double ahead() const;
  void block(Point a, Point b);
  void limit(const Reach& reach);
  void look(const Obstacles& obstacles, const Reach& reach);
  template <class Hides>
  bool bins_hide(double from, double width, double length, const Hides& finer_hides) const;
  bool done(double distance) const;
  /// Ranges of bins that an interval of angles touches, or covers: at most two, for angles go round.
  template <class Take>
  void each_range(double from, double width, const Take& take) const;

  Wheel wheel_;
  double from_, span_, radius_, slack_;
  std::array<double, bins> blocked_;
  int first_open_ = 0, last_open_ = -1;  // bins that no single obstacle blocks are between
  std::unique_ptr<Horizon> finer_;       // of these
};

}  // namespace krepl::route
