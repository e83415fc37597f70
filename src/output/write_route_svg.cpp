// SVG of a route: coordinates relative to the network's origin, y downwards, as in write_svg.cpp.
#include "output/route_svg.hpp"

#include <algorithm>

#include "output/curve_pieces.hpp"
#include "output/output_stream.hpp"
#include "output/svg_text.hpp"
#include "output/zone_curves.hpp"

namespace krepl::output {

namespace {

struct Frame {
  double west, south, width, height;
};

/// About the obstacles' zone and the route, relative to the origin.
Frame frame_of(const Route& route, const Network& network) {
  const Point origin = network.origin();
  double west = 1e300, east = -west, south = west, north = -west;
  const auto add = [&](double x, double y) {
    const double r = route.radius;
    west = std::min(west, x - r), east = std::max(east, x + r), south = std::min(south, y - r),
    north = std::max(north, y + r);
  };
  for (const Point v : network.vertices()) add(v.x, v.y);
  for (const Route::Piece& piece : route.pieces) {
    add(piece.start.x - origin.x, piece.start.y - origin.y), add(piece.end.x - origin.x, piece.end.y - origin.y);
  }
  const double margin = 0.02 * std::max(east - west, north - south);
  return {west - margin, south - margin, east - west + 2 * margin, north - south + 2 * margin};
}

void put_head(SvgText& text, const Frame& frame, const Network& network) {
  const double scale = 1000 / std::max(frame.width, frame.height);
  text.put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  text.format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" viewBox=\"{} {} {} {}\" "
      "data-origin=\"{} {}\">\n",
      std::max(1.0, frame.width * scale), std::max(1.0, frame.height * scale), frame.west,
      0.0 - frame.south - frame.height, frame.width, frame.height, network.origin().x, network.origin().y);
  text.put(
      "<style>path,circle{fill:none;vector-effect:non-scaling-stroke;stroke-linejoin:round;stroke-linecap:round}"
      ".zone path{fill:#3b82c4;fill-opacity:.22;fill-rule:evenodd;stroke:#1d4e7e;stroke-width:.6}"
      ".input path{stroke:#4a4a4a;stroke-width:1.2}.input path.polygon{fill:#4a4a4a;fill-opacity:.35;fill-rule:evenodd}"
      ".route path{stroke:#c8321e;stroke-width:2.4}.ends circle{stroke:#c8321e;stroke-width:1;fill:#c8321e;"
      "fill-opacity:.25}</style>\n");
}

void put_ring(SvgText& text, const Zone& zone, std::uint32_t ring) {
  text.put_absolute('M', zone.piece(zone.ring_begin(ring)).start);
  for (std::uint32_t e = zone.ring_begin(ring); e < zone.ring_begin(ring + 1); ++e) {
    const Zone::Piece piece = zone.piece(e);
    if (piece.kind != Zone::Kind::arc || is_negligible(piece)) {
      text.put_absolute('L', piece.end);
      continue;
    }
    const std::vector<Point> ends = arc_ends(piece, largest_svg_arc);
    for (std::size_t i = 1; i < ends.size(); ++i) text.put_arc(zone.radius(), ends[i]);
  }
  text.put("Z");
}

void put_zone(SvgText& text, OutputStream& stream, const Zone& zone) {
  text.put("<g class=\"zone\">\n<path d=\"");
  for (std::uint32_t ring = 0; ring < zone.ring_count(); ++ring) {
    put_ring(text, zone, ring);
    text.flush(stream);
  }
  text.put("\"/>\n</g>\n");
}

/// Rings of one feature are one path, for they count by the even-odd rule.
void put_obstacles(SvgText& text, OutputStream& stream, const Network& network) {
  text.put("<g class=\"input\">\n");
  for (std::uint32_t part = 0; part < network.part_count(); ++part) {
    const bool ring = network.part_is_ring(part);
    const bool goes_on = ring && part > 0 && network.part_is_ring(part - 1) &&
                         network.part_feature(part) == network.part_feature(part - 1);
    if (!goes_on) text.put(ring ? "<path class=\"polygon\" d=\"" : "<path d=\"");
    const std::span<const std::uint32_t> chain = network.part(part);
    for (std::size_t i = 0; i < chain.size(); ++i) text.put_relative(i == 0 ? 'M' : 'L', network.vertices()[chain[i]]);
    text.put(chain.size() == 1 ? "h0" : ring ? "Z" : "");
    const bool more = ring && part + 1 < network.part_count() && network.part_is_ring(part + 1) &&
                      network.part_feature(part) == network.part_feature(part + 1);
    if (!more) text.put("\"/>\n");
    text.flush(stream);
  }
  text.put("</g>\n");
}

void put_route(SvgText& text, const Route& route, Point origin) {
  text.format("<g class=\"route\" data-length=\"{}\" data-clearance=\"{}\">\n<path d=\"", route.length,
              route.clearance);
  text.put_absolute('M', route.pieces.front().start);
  for (const Route::Piece& piece : route.pieces) {
    if (piece.kind == Route::Kind::parabola) {
      text.put_absolute('Q', piece.control);
      text.put_absolute(' ', piece.end);
      continue;
    }
    const CurvePiece curve{piece.kind == Route::Kind::arc, piece.clockwise, piece.start, piece.end, piece.center};
    if (!is_arc(curve)) {
      text.put_absolute('L', piece.end);
      continue;
    }
    const std::vector<Point> ends = in_sense(curve, arc_ends(as_zone_piece(curve), largest_svg_arc));
    for (std::size_t i = 1; i < ends.size(); ++i) text.put_arc(route.turn_radius, ends[i], piece.clockwise);
  }
  text.put("\"/>\n</g>\n<g class=\"ends\">\n");
  for (const Point p : {route.pieces.front().start, route.pieces.back().end})
    text.format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", p.x - origin.x, origin.y - p.y, route.radius);
  text.put("</g>\n");
}

}  // namespace

Result<ZoneFileReport> write_route_svg(const std::string& path, const Route& route, const Network& network,
                                       const Zone* zone, const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  SvgText text(network.origin());
  put_head(text, frame_of(route, network), network);
  if (zone != nullptr) put_zone(text, *stream, *zone);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while writing", "", ""};
  put_obstacles(text, *stream, network);
  put_route(text, route, network.origin());
  text.put("</svg>\n");
  text.flush(*stream);
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

}  // namespace krepl::output
