#include "lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string_view>

namespace bench {
namespace {

void end_line(Lines& lines) {
  if (lines.points.size() == lines.begin.back() + 1) lines.points.pop_back();
  if (lines.points.size() > lines.begin.back()) lines.begin.push_back(lines.points.size());
}

void add_point(Lines& lines, krepl::Point p) {
  const bool first = lines.points.size() == lines.begin.back();
  if (first || !(lines.points.back() == p)) lines.points.push_back(p);
}

/// All numbers in the text, two a point.
template <class Take>
void each_point(std::string_view text, Take take) {
  double number[2];
  int filled = 0;
  for (const char *p = text.data(), *end = p + text.size(); p < end;) {
    const auto [after, error] = std::from_chars(p, end, number[filled]);
    if (error != std::errc()) {
      ++p;
      continue;
    }
    p = after;
    if (++filled == 2) take(krepl::Point{number[0], number[1]}), filled = 0;
  }
}

krepl::Point projected(krepl::Point degrees) {
  constexpr double metres_per_degree = 6371007.2 * std::numbers::pi / 180;
  return {metres_per_degree * std::numbers::sqrt2 / 2 * degrees.x, metres_per_degree * degrees.y};
}

}  // namespace

std::optional<Lines> read_lines(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Lines lines;
  const bool gmt = text.starts_with('>');
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t line_end = std::min(text.find('\n', at), text.size());
    const std::string_view line(text.data() + at, line_end - at);
    at = line_end + 1;
    if (gmt && line.starts_with('>')) {
      end_line(lines);
    } else if (gmt) {
      each_point(line, [&](krepl::Point p) { add_point(lines, projected(p)); });
    } else if (line.starts_with("LINESTRING")) {
      each_point(line, [&](krepl::Point p) { add_point(lines, p); });
      end_line(lines);
    }
  }
  end_line(lines);
  return lines;
}

Lines resized(const Lines& lines, std::size_t segments) {
  const auto [left, right] = std::ranges::minmax(lines.points, {}, &krepl::Point::x);
  const auto [low, high] = std::ranges::minmax(lines.points, {}, &krepl::Point::y);
  const double width = 1.01 * (right.x - left.x), height = 1.01 * (high.y - low.y);
  const std::size_t copies = (segments + lines.segments() - 1) / lines.segments();
  const auto columns = std::size_t(std::ceil(std::sqrt(double(copies))));
  Lines result;
  for (std::size_t copy = 0, left_over = segments; left_over > 0; ++copy) {
    const krepl::Point shift{width * double(copy % columns), height * double(copy / columns)};
    for (std::size_t i = 0; i < lines.count() && left_over > 0; ++i) {
      const std::size_t taken = std::min(lines.begin[i + 1] - lines.begin[i], left_over + 1);
      for (std::size_t j = lines.begin[i]; j < lines.begin[i] + taken; ++j)
        result.points.push_back({lines.points[j].x + shift.x, lines.points[j].y + shift.y});
      result.begin.push_back(result.points.size());
      left_over -= taken - 1;
    }
  }
  return result;
}

double mean_segment_length(const Lines& lines) {
  double length = 0;
  for (std::size_t i = 0; i < lines.count(); ++i)
    for (std::size_t j = lines.begin[i]; j + 1 < lines.begin[i + 1]; ++j)
      length += std::hypot(lines.points[j + 1].x - lines.points[j].x, lines.points[j + 1].y - lines.points[j].y);
  return length / double(lines.segments());
}

}  // namespace bench
