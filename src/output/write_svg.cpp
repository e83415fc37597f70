// SVG: the zones as paths of lines and true arcs, the networks they belong to above them.
//
// Coordinates are relative to the (first) network's origin (viewers compute in single precision) and y points down:
// x_svg = x - origin_x, y_svg = origin_y - y; the root element's data-origin tells the origin.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>

#include "krepl/curve_network.hpp"
#include "output/output_stream.hpp"
#include "output/svg_text.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

void put_ring(SvgText& text, const Zone& zone, std::uint32_t ring) {
  text.put_absolute('M', zone.piece(zone.ring_begin(ring)).start);
  for (std::uint32_t e = zone.ring_begin(ring); e < zone.ring_begin(ring + 1); ++e) {
    Zone::Piece piece = zone.piece(e);
    if (piece.kind != Zone::Kind::arc || is_negligible(piece)) {
      text.put_absolute('L', piece.end);
      continue;
    }
    std::vector<Point> ends = arc_ends(piece, largest_svg_arc);
    for (std::size_t i = 1; i < ends.size(); ++i) text.put_arc(piece.radius, ends[i], piece.clockwise);
  }
  text.put("Z");
}

Status put_zone(SvgText& text, OutputStream& stream, const Zone& zone, bool band, const Context& context) {
  text.format("<g class=\"zone\" data-radius=\"{}\"{} data-area=\"{}\">\n", zone.signed_radius(),
              band ? fmt::format(" data-inner=\"{}\"", zone.inner_radius()) : "", zone.area());
  for (std::uint32_t p = 0; p < zone.polygon_count(); ++p) {
    if (context.cancelled()) return interrupted_while_writing();
    Zone::Polygon polygon = zone.polygon(p);
    text.put("<path d=\"");
    put_ring(text, zone, polygon.outer);
    for (std::uint32_t hole : polygon.holes) put_ring(text, zone, hole);
    text.put("\"/>\n");
    text.flush(stream);
  }
  text.put("</g>\n");
  return std::monostate{};
}

Status put_network(SvgText& text, OutputStream& stream, const Zone& zone, const Context& context) {
  const Network& network = zone.network();
  text.put("<g class=\"input\">\n");
  for (std::uint32_t part = 0; part < network.part_count(); ++part) {
    if (context.cancelled()) return interrupted_while_writing();
    text.put("<path d=\"");
    std::span<const std::uint32_t> chain = network.part(part);
    const auto at = [&](std::size_t i) {
      const Point local = network.vertices()[chain[i]], origin = network.origin();
      return Point{origin.x + local.x, origin.y + local.y};
    };
    std::span<const std::uint32_t> middles;
    if (zone.curves() != nullptr) middles = zone.curves()->part_middles(part);
    for (std::size_t i = 0; i < chain.size(); ++i) {
      std::optional<Zone::Piece> arc;
      if (!middles.empty() && middles.front() == i) {
        middles = middles.subspan(1);
        arc = arc_of_input(at(i - 1), at(i), at(i + 1));
      }
      if (!arc) {
        text.put_absolute(i == 0 ? 'M' : 'L', at(i));
        continue;
      }
      const std::vector<Point> ends = arc_ends(*arc, largest_svg_arc);
      for (std::size_t k = 1; k < ends.size(); ++k) text.put_arc(arc->radius, ends[k], arc->clockwise);
      ++i;
    }
    // A stroke of no length with round caps shows as a dot.
    text.put(chain.size() == 1 ? "h0" : network.part_is_ring(part) ? "Z" : "");
    text.put("\"/>\n");
    text.flush(stream);
  }
  text.put("</g>\n");
  return std::monostate{};
}

/// The extent of all zones' networks, grown by the largest radius, relative to the origin.
struct Box {
  double west = 0, south = 0, east = 0, north = 0;
};
Box box_of(std::span<const Zone> zones, Point origin) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Box box{far, far, -far, -far};
  for (const Zone& zone : zones) {
    for (std::uint32_t e = 0; zone.curves() != nullptr && e < zone.piece_count(); ++e) {
      const Zone::Piece piece = zone.piece(e);
      if (piece.kind != Zone::Kind::arc) continue;
      for (const Point& p : arc_ends(piece, std::numbers::pi / 16)) {  // hardly off what arcs reach
        box = {std::min(box.west, p.x - origin.x), std::min(box.south, p.y - origin.y), std::max(box.east, p.x - origin.x),
               std::max(box.north, p.y - origin.y)};
      }
    }
    const double x = zone.network().origin().x - origin.x, y = zone.network().origin().y - origin.y, r = zone.radius();
    for (const Point& v : zone.network().vertices()) {
      box = {std::min(box.west, x + v.x - r), std::min(box.south, y + v.y - r), std::max(box.east, x + v.x + r),
             std::max(box.north, y + v.y + r)};
    }
  }
  return box;
}

void put_head(SvgText& text, std::span<const Zone> zones, Point origin) {
  Box box = box_of(zones, origin);
  double width = box.east - box.west, height = box.north - box.south, margin = 0.02 * std::max(width, height);
  width += 2 * margin;
  height += 2 * margin;
  double scale = 1000 / std::max(width, height);
  text.put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  text.format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" viewBox=\"{} {} {} {}\" "
              "data-origin=\"{} {}\">\n",
              std::max(1.0, width * scale), std::max(1.0, height * scale), box.west - margin, 0.0 - box.north - margin,
              width, height, origin.x, origin.y);
  text.put("<style>path{vector-effect:non-scaling-stroke;stroke-linejoin:round;stroke-linecap:round}"
           ".zone path{fill:#3b82c4;fill-opacity:.3;fill-rule:evenodd;stroke:#1d4e7e;stroke-width:1}"
           ".input path{fill:none;stroke:#b3261e;stroke-width:1}</style>\n");
}

}  // namespace

WriteResult write_svg(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions& options,
                      const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  // The widest first, so that it does not cover the others.
  std::vector<const Zone*> order;
  for (const Zone& zone : zones) order.push_back(&zone);
  std::stable_sort(order.begin(), order.end(), [](const Zone* a, const Zone* b) { return a->signed_radius() > b->signed_radius(); });

  const Point origin = order.front()->network().origin();
  SvgText text(origin);
  put_head(text, zones, origin);
  for (const Zone* zone : order) {
    if (Status put = put_zone(text, *stream, *zone, options.bands, context); !put) return put.error();
  }
  std::vector<const Network*> drawn;  // zones of one network follow each other
  for (const Zone& zone : zones) {
    if (!drawn.empty() && drawn.back() == &zone.network()) continue;
    drawn.push_back(&zone.network());
    if (Status put = put_network(text, *stream, zone, context); !put) return put.error();
  }
  text.put("</svg>\n");
  text.flush(*stream);
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

}  // namespace krepl::output
