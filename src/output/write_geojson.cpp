// GeoJSON: polygons with chords, in the zone's own coordinate system (as the 2008 specification names it).
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <iterator>

#include "ogr/message_capture.hpp"
#include "output/output_stream.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

/// The member `crs`, or nothing with a note where the system has no code.
std::string crs_member(const std::string& definition, std::vector<std::string>& notes) {
  if (definition.empty()) return {};
  ogr::MessageCapture ignored;
  OGRSpatialReference crs;
  crs.importFromWkt(definition.c_str());
  const char* authority = crs.GetAuthorityName(nullptr);
  const char* code = crs.GetAuthorityCode(nullptr);
  if (authority == nullptr || code == nullptr) {
    notes.emplace_back("note: GeoJSON cannot name a coordinate system without a code, so it is left out");
    return {};
  }
  return fmt::format("\"crs\": {{\"type\": \"name\", \"properties\": {{\"name\": \"urn:ogc:def:crs:{}::{}\"}}}},\n",
                     authority, code);
}

void put_ring(fmt::memory_buffer& text, const std::vector<Point>& ring) {
  auto out = std::back_inserter(text);
  text.push_back('[');
  for (std::size_t i = 0; i < ring.size(); ++i) fmt::format_to(out, "{}[{},{}]", i == 0 ? "" : ",", ring[i].x, ring[i].y);
  text.push_back(']');
}

void put_polygon(fmt::memory_buffer& text, const Zone& zone, std::uint32_t p, Linearizer& linearizer) {
  Zone::Polygon polygon = zone.polygon(p);
  text.push_back('[');
  put_ring(text, linearizer.ring(zone, polygon.outer));
  for (std::uint32_t hole : polygon.holes) {
    text.push_back(',');
    put_ring(text, linearizer.ring(zone, hole));
  }
  text.push_back(']');
}

Status write_feature(OutputStream& stream, const Zone& zone, const ZoneFeature& feature, const ZoneFileOptions& options,
                     Linearizer& linearizer, const Context& context) {
  const bool single = options.separate;
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text),
                 "{{\"type\": \"Feature\", \"properties\": {{\"radius\": {}, {}\"area\": {}, \"perimeter\": {}, "
                 "\"polygons\": {}, \"holes\": {}}}, \"geometry\": {{\"type\": \"{}\", \"coordinates\": ",
                 feature.radius ? fmt::format("{}", *feature.radius) : "null",
                 options.bands ? fmt::format("\"inner\": {}, ", feature.inner_radius) : "", feature.area, feature.perimeter, feature.polygon_count, feature.holes,
                 single ? "Polygon" : "MultiPolygon");
  if (!single) text.push_back('[');
  for (std::uint32_t i = 0; i < feature.polygon_count; ++i) {
    if (context.cancelled()) return interrupted_while_writing();
    if (i > 0) text.push_back(',');
    put_polygon(text, zone, feature.first_polygon + i, linearizer);
    stream.write({text.data(), text.size()});
    text.clear();
  }
  stream.write(single ? "}}" : "]}}");
  return std::monostate{};
}

}  // namespace

WriteResult write_geojson(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions& options,
                          const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  ZoneFileReport report;
  report.deviation = 0;
  stream->write("{\n\"type\": \"FeatureCollection\",\n\"name\": \"zone\",\n");
  stream->write(crs_member(options.crs, report.notes));
  stream->write("\"features\": [\n");
  bool first = true;
  for (const Zone& zone : zones) {
    Linearizer linearizer(zone.radius(), max_error_for(options, zone.radius()));
    for (const ZoneFeature& feature : zone_features(zone, options.separate)) {
      if (!first) stream->write(",\n");
      first = false;
      Status written = write_feature(*stream, zone, feature, options, linearizer, context);
      if (!written) return written.error();
    }
    report.deviation = std::max(*report.deviation, linearizer.deviation());
  }
  stream->write("\n]\n}\n");
  if (Status finished = stream->finish(); !finished) return finished.error();
  return report;
}

}  // namespace krepl::output
