// WKB: ISO geometries, little-endian, one after the other.
#include "output/ogr_geometry.hpp"
#include "output/output_stream.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

WriteResult write_wkb(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions& options,
                      const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  std::vector<unsigned char> bytes;
  for (const Zone& zone : zones) {
    for (const ZoneFeature& feature : zone_features(zone, options.separate)) {
      if (context.cancelled()) return interrupted_while_writing();
      auto geometry = curve_geometry(zone, feature, feature.polygon_count == 1);
      bytes.resize(geometry->WkbSize());
      if (geometry->exportToWkb(wkbNDR, bytes.data(), wkbVariantIso) != OGRERR_NONE) {
        return Error{ErrorCode::io, "geometry cannot be written as WKB", "", ""};
      }
      stream->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
  }
  if (Status finished = stream->finish(); !finished) return finished.error();
  return ZoneFileReport{};
}

}  // namespace krepl::output
