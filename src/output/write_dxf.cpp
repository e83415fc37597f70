// DXF: every ring a closed LWPOLYLINE with true arcs, on layers ZONE_<radius> and ZONE_<radius>_HOLES; of bands
// BAND_<inner radius>_<radius>.
#include <fmt/format.h>

#include "output/dxf_document.hpp"
#include "output/output_stream.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

std::vector<DxfDocument::Vertex> ring_vertices(const Zone& zone, std::uint32_t ring) {
  std::vector<DxfDocument::Vertex> vertices;
  for (std::uint32_t e = zone.ring_begin(ring); e < zone.ring_begin(ring + 1); ++e) {
    const Zone::Piece piece = zone.piece(e);
    if (piece.kind != Zone::Kind::arc || is_negligible(piece)) {
      vertices.push_back({piece.start, 0});
      continue;
    }
    const auto arc = DxfDocument::arc_vertices(piece);
    vertices.insert(vertices.end(), arc.begin(), arc.end());
  }
  return vertices;
}

std::string layer_name(const Zone& zone, bool band, bool hole) {
  if (zone.least_radius() < zone.radius()) return hole ? "ZONE_HOLES" : "ZONE";
  if (band) return fmt::format("BAND_{}_{}{}", zone.inner_radius(), zone.radius(), hole ? "_HOLES" : "");
  return fmt::format("ZONE_{}{}", zone.signed_radius(), hole ? "_HOLES" : "");
}

}  // namespace

WriteResult write_dxf(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions& options,
                      const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  std::vector<std::string> layers;
  std::size_t rings = 0;
  for (const Zone& zone : zones) {
    layers.push_back(layer_name(zone, options.bands, false));
    layers.push_back(layer_name(zone, options.bands, true));
    rings += zone.ring_count();
  }
  DxfDocument document(*stream, layers, rings);
  for (const Zone& zone : zones) {
    for (std::uint32_t ring = 0; ring < zone.ring_count(); ++ring) {
      if (context.cancelled()) return interrupted_while_writing();
      document.put(ring_vertices(zone, ring), true, layer_name(zone, options.bands, zone.ring_is_hole(ring)));
    }
  }
  document.finish();
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

}  // namespace krepl::output
