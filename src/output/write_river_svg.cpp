// SVG: sub-rivers as lines, the wider the higher their order; each main stem and what comes to it in a colour of its
// own.
//
// Coordinates are relative to the middle (viewers compute in single precision) and y points down; the root element's
// data-origin tells the middle. Seven digits, for it is a drawing.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "output/output_stream.hpp"
#include "output/river_writers.hpp"

namespace krepl::output {

namespace {

using Index = RiverNetwork::Index;
constexpr const char* colours[] = {"#1d4e7e", "#a8480a", "#2b7a3d", "#7b3fa0",
                                   "#8a6d00", "#b3265e", "#0f7f86", "#555555"};

struct Extent {
  double west = std::numeric_limits<double>::infinity(), south = west, east = -west, north = -west;
};

Extent extent_of(const RiverNetwork& rivers) {
  Extent box;
  for (Index r = 0; r < rivers.reaches().size(); ++r) {
    for (Point p : rivers.reach_line(r)) {
      box = {std::min(box.west, p.x), std::min(box.south, p.y), std::max(box.east, p.x), std::max(box.north, p.y)};
    }
  }
  return box;
}

}  // namespace

Result<std::vector<std::string>> write_river_svg(const std::string& path, const RiverNetwork& rivers,
                                                 const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  const Extent box = extent_of(rivers);
  const Point origin{(box.west + box.east) / 2, (box.south + box.north) / 2};
  const double width = box.east - box.west, height = box.north - box.south, margin = 0.02 * std::max(width, height);
  const double scale = 1000 / (std::max(width, height) + 2 * margin);
  stream->write(fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" "
      "height=\"{:.0f}\" viewBox=\"{} {} {} {}\" data-origin=\"{} {}\">\n",
      std::max(1.0, (width + 2 * margin) * scale), std::max(1.0, (height + 2 * margin) * scale), -width / 2 - margin,
      -height / 2 - margin, width + 2 * margin, height + 2 * margin, origin.x, origin.y));
  stream->write(
      "<style>path{fill:none;vector-effect:non-scaling-stroke;stroke-linejoin:round;stroke-linecap:round}"
      ".main{stroke-opacity:1}.tributary{stroke-opacity:.55}.fusion{fill:#111}</style>\n");
  std::vector<std::size_t> stem_number(rivers.sub_rivers().size(), 0);
  std::size_t stems = 0;
  for (Index s = 0; s < stem_number.size(); ++s) stem_number[s] = rivers.sub_rivers()[s].is_stem ? stems++ : 0;
  fmt::memory_buffer text;
  for (Index s = Index(rivers.sub_rivers().size()); s-- > 0;) {  // the longest on top
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while writing", "", ""};
    const RiverNetwork::SubRiver& river = rivers.sub_rivers()[s];
    for (Index r : rivers.reaches_of(s)) {
      text.clear();
      fmt::format_to(std::back_inserter(text),
                     "<path class=\"{}\" stroke=\"{}\" stroke-width=\"{}\" data-sub-river=\"{}\" d=\"",
                     river.is_stem ? "main" : "tributary", colours[stem_number[river.stem] % std::size(colours)],
                     0.6 + 0.7 * std::min<unsigned>(rivers.reaches()[r].order, 10), s + 1);
      char command = 'M';
      for (Point p : rivers.reach_line(r)) {
        fmt::format_to(std::back_inserter(text), "{}{:.7g} {:.7g}", command, p.x - origin.x, 0.0 - (p.y - origin.y));
        command = 'L';
      }
      stream->write({text.data(), text.size()});
      stream->write("\"/>\n");
    }
  }
  for (const RiverNetwork::Node& node : rivers.nodes()) {
    if (!node.is_fusion()) continue;
    stream->write(fmt::format("<circle class=\"fusion\" cx=\"{}\" cy=\"{}\" r=\"{:.6g}\"/>\n", node.at.x - origin.x,
                              0.0 - (node.at.y - origin.y), 2 / scale));
  }
  stream->write("</svg>\n");
  if (Status finished = stream->finish(); !finished) return finished.error();
  return std::vector<std::string>{};
}

}  // namespace krepl::output
