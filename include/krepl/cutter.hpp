#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "krepl/error.hpp"

namespace krepl {

/// A milling tool: a body of revolution about the vertical axis, seen from below. Its lower side rises from the axis
/// outwards as a flat disk, then a quarter of a circle or less that joins it smoothly (the corner), then a straight
/// flank, up to its largest radius, where the shank goes straight up. Each part may be missing:
///
///   kind        text                       flat    corner        flank
///   ball        ball:D                     -       radius D/2    -
///   flat        flat:D                     D/2     -             -
///   bull_nose   bull:D:CORNER_RADIUS       the rest CORNER_RADIUS -
///   cone        cone:D:ANGLE               -       -             from the tip to the diameter D
///   taper       taper:D:ANGLE:TIP_RADIUS   -       TIP_RADIUS    tangent to the tip's ball, to the diameter D
///
/// D is the largest diameter. ANGLE is always the included one, between opposite flanks, in degrees: a V-bit of 60
/// degrees is cone:6:60, a ball mill that tapers by 3 degrees a side has 6. Lengths are in the unit of the part.
class Cutter {
 public:
  enum class Kind { ball, flat, bull_nose, cone, taper };

  /// Errors (usage) of all that follow: a length that is not finite and positive; a corner radius above D/2; an angle
  /// outside 1 .. 179 degrees; a tip whose tangent flank would begin beyond the diameter.
  static Result<Cutter> ball(double diameter);
  static Result<Cutter> flat(double diameter);
  static Result<Cutter> bull_nose(double diameter, double corner_radius);
  static Result<Cutter> cone(double diameter, double angle);
  static Result<Cutter> taper(double diameter, double angle, double tip_radius);

  /// From the text of the table above, as `--tool` has it. Besides the errors above (usage): another word, another
  /// number of numbers; the message gives the grammar.
  static Result<Cutter> parse(std::string_view text);
  /// The text from which parse() makes the same cutter.
  std::string text() const;

  Kind kind() const { return kind_; }
  double diameter() const { return diameter_; }
  double radius() const { return diameter_ / 2; }
  double flat_radius() const { return flat_; }      ///< of the disk at the tip; 0 if there is none
  double corner_radius() const { return corner_; }  ///< of the ball, corner or tip; 0 if there is none
  double angle() const { return angle_; }           ///< included, in degrees; 0 if there is no flank
  /// Rise of the flank for a unit outwards; infinity if there is none.
  double slope() const { return slope_; }
  /// How far from the axis the corner ends and the flank or the shank begins.
  double corner_end() const;

  /// How much the tool's lower side at the given distance from the axis is above its tip, 0 at the axis; a convex
  /// function. Infinity beyond radius().
  double height(double distance) const;
  /// Where the point that paths and drops speak of is above the tip: the radius for a ball (its centre), 0 for all
  /// others.
  double control_height() const { return kind_ == Kind::ball ? radius() : 0; }

  friend bool operator==(const Cutter&, const Cutter&) = default;

 private:
  Cutter(Kind kind, double diameter, double flat, double corner)
      : kind_(kind), diameter_(diameter), flat_(flat), corner_(corner) {}
  void set_angle(double degrees);

  Kind kind_;
  double diameter_, flat_, corner_;
  double angle_ = 0;
  double slope_ = std::numeric_limits<double>::infinity();
};

}  // namespace krepl
