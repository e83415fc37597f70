// SVG: the input in grey, edges as lines and quadratic Bezier curves, the more solid the wider they run.
//
// Coordinates are relative to the middle (viewers compute in single precision) and y points down; the root element's
// data-origin tells the middle.
#include <algorithm>

#include "output/axis_file.hpp"
#include "output/svg_text.hpp"

namespace krepl::output {

namespace {

void put_network(SvgText& text, const Network& network, double dot) {
  const Point o = network.origin();
  const auto absolute = [&](std::uint32_t v) { return Point{network.vertices()[v].x + o.x, network.vertices()[v].y + o.y}; };
  for (std::uint32_t p = 0; p < network.part_count(); ++p) {
    const auto part = network.part(p);
    text.put("<path class=\"input\" d=\"");
    for (std::size_t i = 0; i < part.size(); ++i) text.put_absolute(i == 0 ? 'M' : 'L', absolute(part[i]));
    if (network.part_is_ring(p)) text.put("Z");
    if (part.size() == 1) text.format("h{}", dot);  // the round cap makes it a dot
    text.put("\"/>\n");
  }
}

void put_line(SvgText& text, const AxisLine& line) {
  text.format("<path class=\"{}\" data-clearance=\"{:.6g}\" d=\"", line.kind, line.minimum);
  text.put_absolute('M', line.points.front());
  if (line.control) {
    text.put_absolute('Q', *line.control);
    text.put_absolute(' ', line.points.back());
  } else {
    text.put_absolute('L', line.points.back());
  }
  text.put("\"/>\n");
}

}  // namespace

Status write_axis_svg(const std::string& path, const AxisSource& lines, const Network& network, const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  const auto [west, east] = std::ranges::minmax(network.vertices(), {}, &Point::x);
  const auto [south, north] = std::ranges::minmax(network.vertices(), {}, &Point::y);
  const double largest = std::max(east.x - west.x, north.y - south.y), margin = largest > 0 ? largest / 10 : 1;
  const double width = east.x - west.x + 2 * margin, height = north.y - south.y + 2 * margin;
  const double scale = 1000 / std::max(width, height);
  const Point middle{(west.x + east.x) / 2, (south.y + north.y) / 2};
  const Point origin{middle.x + network.origin().x, middle.y + network.origin().y};
  SvgText text(origin);
  text.format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" "
              "height=\"{:.0f}\" viewBox=\"{} {} {} {}\" data-origin=\"{} {}\">\n",
              std::max(1.0, width * scale), std::max(1.0, height * scale), -width / 2, -height / 2, width, height, origin.x,
              origin.y);
  text.put("<style>path{fill:none;vector-effect:non-scaling-stroke;stroke-linecap:round;stroke-linejoin:round}"
           ".input{stroke:#222;stroke-width:2.5}.line{stroke:#1d6fb8}.parabola{stroke:#c2410c}</style>\n");
  put_network(text, network, largest / 1e6);
  bool stopped = false;
  lines([&](const AxisLine& line) {
    stopped = context.cancelled();
    if (stopped || stream->failed()) return false;
    put_line(text, line);
    text.flush(*stream);
    return true;
  });
  if (stopped) return Error{ErrorCode::cancelled, "interrupted while writing", "", ""};
  text.put("</svg>\n");
  text.flush(*stream);
  return stream->finish();
}

}  // namespace krepl::output
