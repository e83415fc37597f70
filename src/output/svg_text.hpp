#pragma once

#include <fmt/format.h>

#include <iterator>
#include <numbers>
#include <string_view>

#include "krepl/point.hpp"
#include "output/output_stream.hpp"

namespace krepl::output {

// The centre of an SVG arc follows from its ends and radius, which is ill-conditioned near half a turn; up to a third
// of a turn rounding is not amplified.
inline constexpr double largest_svg_arc = 2 * std::numbers::pi / 3;

/// Text of an SVG whose coordinates are relative to an origin, with y downwards.
class SvgText {
 public:
  explicit SvgText(Point origin) : origin_(origin) {}

  void put(std::string_view s) { text_.append(s.data(), s.data() + s.size()); }
  void put_absolute(char command, Point p) { put_relative(command, {p.x - origin_.x, p.y - origin_.y}); }
  /// `p` relative to the origin, y upwards. Adding zero turns -0 into 0.
  void put_relative(char command, Point p) {
    fmt::format_to(std::back_inserter(text_), "{}{} {}", command, p.x, 0.0 - p.y);
  }
  void put_arc(double radius, Point end, bool clockwise = false) {
    // Counter-clockwise with y upwards is against the direction of increasing angles with y downwards: sweep flag 0.
    fmt::format_to(std::back_inserter(text_), "A{0} {0} 0 0 {1} {2} {3}", radius, clockwise ? 1 : 0, end.x - origin_.x,
                   0.0 - (end.y - origin_.y));
  }
  template <class... T>
  void format(fmt::format_string<T...> pattern, T&&... values) {
    fmt::format_to(std::back_inserter(text_), pattern, std::forward<T>(values)...);
  }
  void flush(OutputStream& stream) {
    stream.write({text_.data(), text_.size()});
    text_.clear();
  }

 private:
  Point origin_;
  fmt::memory_buffer text_;
};

}  // namespace krepl::output
