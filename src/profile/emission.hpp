#pragma once

#include <limits>

#include "krepl/profile.hpp"
#include "profile/element.hpp"

namespace krepl::profile {

/// The start of an entry as a point: rounded once, from the input's own coordinates.
inline Point center_at_start(const Entry& e, double radius) {
  return {e.a.x + (radius * e.n.x + e.t * e.n.y), e.a.y + (radius * e.n.y - e.t * e.n.x)};
}

/// True if the piece goes forward in the rounded coordinates that the user gets: an arc whose end lies (by rounding) before
/// its start would be read as nearly a full circle.
inline bool runs_forward(const Entry& e, Point start, Point end) {
  if (is_side(e.label)) return (end.x - start.x) * (e.b.x - e.a.x) + (end.y - start.y) * (e.b.y - e.a.y) > 0;
  const Point s{start.x - e.a.x, start.y - e.a.y}, q{end.x - e.a.x, end.y - e.a.y};
  const double turn = s.x * q.y - s.y * q.x;
  return turn < 0 || s.x * q.x + s.y * q.y < 0;
}

/// Turns entries into pieces and drops those that have no length in double precision; what follows then starts where the
/// dropped one did.
class Emission {
 public:
  void begin(Point start) { start_ = start, carried_ = false; }

  /// write(kind, index, center, start, end) for each piece that stays.
  template <class Writer>
  void piece(const Entry& e, Point end, Writer&& write) {
    if (e.label == left_half_line) {
      write(Kind::half_line, 0u, e.a, below(end), end);
    } else if (runs_forward(e, start_, end)) {
      write(is_side(e.label) ? Kind::segment : Kind::arc, e.label >> 1, e.a, start_, end);
    } else {
      ++dropped_;
      carried_ = true;
      return;
    }
    begin(end);
  }
  /// The half-line down from the end of the last arc.
  template <class Writer>
  void right_half_line(const Entry& last_arc, Writer&& write) {
    write(Kind::half_line, last_arc.label >> 1, last_arc.a, start_, below(start_));
  }

  /// True if the next piece starts elsewhere than its entry says.
  bool carried() const { return carried_; }
  std::uint64_t dropped() const { return dropped_; }
  void set_dropped(std::uint64_t count) { dropped_ = count; }

 private:
  using Kind = ProfilePiece::Kind;
  static Point below(Point p) { return {p.x, -std::numeric_limits<double>::infinity()}; }

  Point start_;
  bool carried_ = false;
  std::uint64_t dropped_ = 0;
};

}  // namespace krepl::profile
