#include "lab/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace krepl::lab {

namespace {

constexpr double width = 720, height = 440, left = 80, right = 190, top = 44, bottom = 58;
// Told apart by people who see few colours too (Okabe and Ito), and by the marks' shapes.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#444444"};

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '<' ? std::string("&lt;") : c == '&' ? std::string("&amp;") : std::string(1, c);
  return safe;
}

/// One axis: from data to the picture, and where it is marked.
struct Axis {
  double from = 1, to = 10;  // data
  double begin, end;         // picture

  double at(double x) const {
    return begin + (end - begin) * (std::log10(x) - std::log10(from)) / (std::log10(to) - std::log10(from));
  }
  /// Powers of ten; with 2 and 5 of them where the axis is short.
  std::vector<double> marks() const {
    const bool few = to / from < 300;
    std::vector<double> marks;
    for (int power = int(std::floor(std::log10(from))); power <= int(std::ceil(std::log10(to))); ++power) {
      for (const double step : {1.0, 2.0, 5.0}) {
        const double x = step * std::pow(10.0, power);
        if ((step == 1 || few) && x >= from * (1 - 1e-9) && x <= to * (1 + 1e-9)) marks.push_back(x);
      }
    }
    return marks;
  }
};

bool shown(Point p) { return p.x > 0 && p.y > 0 && std::isfinite(p.x) && std::isfinite(p.y); }

/// A bit more than the data reach.
Axis axis_over(const Chart& chart, double Point::*part, double begin, double end) {
  double low = 1e300, high = 0;
  for (const auto& s : chart.series) {
    for (const Point& p : s.points) {
      if (shown(p)) low = std::min(low, p.*part), high = std::max(high, p.*part);
    }
  }
  if (!(high > 0)) low = 1, high = 10;
  const double room = std::max(1.15, std::pow(high / low, 0.05));
  return {low / room, high * room, begin, end};
}

void put_mark(std::string& text, std::size_t shape, double x, double y, const char* colour) {
  const auto out = std::back_inserter(text);
  switch (shape % 4) {
    case 0:
      fmt::format_to(out, "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", x, y, colour);
      break;
    case 1:
      fmt::format_to(out, "<path d=\"M{:.1f} {:.1f}h7v7h-7Z\" fill=\"{}\"/>\n", x - 3.5, y - 3.5, colour);
      break;
    case 2:
      fmt::format_to(out, "<path d=\"M{:.1f} {:.1f}l4.5 8h-9Z\" fill=\"{}\"/>\n", x, y - 5, colour);
      break;
    default:
      fmt::format_to(out, "<path d=\"M{:.1f} {:.1f}l5 5l-5 5l-5 -5Z\" fill=\"{}\"/>\n", x, y - 5, colour);
  }
}

void put_axes(std::string& text, const Chart& chart, const Axis& x, const Axis& y) {
  const auto out = std::back_inserter(text);
  for (const double mark : x.marks()) {
    const double at = x.at(mark);
    fmt::format_to(out,
                   "<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text x=\"{0:.1f}\" y=\"{3}\" "
                   "text-anchor=\"middle\">{4:g}</text>\n",
                   at, top, height - bottom, height - bottom + 18, mark);
  }
  for (const double mark : y.marks()) {
    const double at = y.at(mark);
    fmt::format_to(
        out,
        "<path class=\"grid\" d=\"M{1} {0:.1f}H{2}\"/><text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
        at, left, width - right, left - 8, at + 4, mark);
  }
  fmt::format_to(out, "<path class=\"axis\" d=\"M{} {}V{}H{}\"/>\n", left, top, height - bottom, width - right);
  fmt::format_to(out, "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + width - right) / 2,
                 height - 16, escaped(chart.x_name));
  fmt::format_to(out, "<text transform=\"translate(20 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                 (top + height - bottom) / 2, escaped(chart.y_name));
  fmt::format_to(out, "<text class=\"title\" x=\"{}\" y=\"26\">{}</text>\n", left, escaped(chart.title));
}

void put_series(std::string& text, const Chart::Series& series, std::size_t k, const Axis& x, const Axis& y) {
  const auto out = std::back_inserter(text);
  const char* colour = colours[k % std::size(colours)];
  std::string path;
  for (const Point& p : series.points) {
    if (!shown(p)) continue;
    fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', x.at(p.x), y.at(p.y));
  }
  if (series.line && !path.empty()) {
    fmt::format_to(out, "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"{}/>\n", path, colour,
                   series.dashed ? " stroke-dasharray=\"6 4\"" : "");
  }
  for (const Point& p : series.points) {
    if (shown(p) && !series.dashed) put_mark(text, k, x.at(p.x), y.at(p.y), colour);
  }
  const double at = top + 10 + 20 * double(k), begin = width - right + 16;
  if (series.dashed)
    fmt::format_to(out, "<path d=\"M{} {}h14\" stroke=\"{}\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"/>\n",
                   begin - 7, at, colour);
  else
    put_mark(text, k, begin, at, colour);
  fmt::format_to(out, "<text x=\"{}\" y=\"{}\">{}</text>\n", begin + 14, at + 4, escaped(series.name));
}

}  // namespace

std::string svg_of(const Chart& chart) {
  const Axis x = axis_over(chart, &Point::x, left, width - right);
  const Axis y = axis_over(chart, &Point::y, height - bottom, top);
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" "
      "height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\">\n<style>text{{font:12px sans-serif;fill:#222}}.title{{font-weight:bold;font-size:14px}}"
      ".grid{{stroke:#ddd;fill:none}}.axis{{stroke:#222;fill:none}}</style>\n<rect width=\"{0}\" height=\"{1}\" "
      "fill=\"#fff\"/>\n",
      width, height);
  put_axes(text, chart, x, y);
  for (std::size_t k = 0; k < chart.series.size(); ++k) put_series(text, chart.series[k], k, x, y);
  return text + "</svg>\n";
}

}  // namespace krepl::lab
