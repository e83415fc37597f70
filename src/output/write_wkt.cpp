// WKT text: one geometry a line, true curves (ISO 13249-3), numbers in the shortest form that reads back the same.
#include <fmt/format.h>

#include <iterator>

#include "output/output_stream.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

using Text = fmt::memory_buffer;

void put(Text& text, std::string_view s) { text.append(s.data(), s.data() + s.size()); }

void put_points(Text& text, const std::vector<Point>& points) {
  auto out = std::back_inserter(text);
  put(text, "(");
  for (std::size_t i = 0; i < points.size(); ++i) fmt::format_to(out, "{}{} {}", i == 0 ? "" : ", ", points[i].x, points[i].y);
  put(text, ")");
}

void put_run(Text& text, const CurveRun& run) {
  if (run.arc) put(text, "CIRCULARSTRING ");
  put_points(text, run.points);
}

void put_ring(Text& text, const Zone& zone, std::uint32_t ring) {
  std::vector<CurveRun> runs = ring_runs(zone, ring);
  if (runs.size() == 1) return put_run(text, runs.front());
  put(text, "COMPOUNDCURVE (");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i > 0) put(text, ", ");
    put_run(text, runs[i]);
  }
  put(text, ")");
}

void put_polygon(Text& text, const Zone& zone, std::uint32_t p) {
  Zone::Polygon polygon = zone.polygon(p);
  put(text, "CURVEPOLYGON (");
  put_ring(text, zone, polygon.outer);
  for (std::uint32_t hole : polygon.holes) {
    put(text, ", ");
    put_ring(text, zone, hole);
  }
  put(text, ")");
}

}  // namespace

WriteResult write_wkt(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions& options,
                      const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  Text text;
  for (const Zone& zone : zones) {
    for (const ZoneFeature& feature : zone_features(zone, options.separate)) {
      bool many = feature.polygon_count > 1;
      if (many) put(text, "MULTISURFACE (");
      if (feature.polygon_count == 0) put(text, "MULTISURFACE EMPTY");
      for (std::uint32_t i = 0; i < feature.polygon_count; ++i) {
        if (context.cancelled()) return interrupted_while_writing();
        if (i > 0) put(text, ", ");
        put_polygon(text, zone, feature.first_polygon + i);
        stream->write({text.data(), text.size()});
        text.clear();
      }
      put(text, many ? ")\n" : "\n");
    }
    stream->write({text.data(), text.size()});
    text.clear();
  }
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

}  // namespace krepl::output
