#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// Zones as found in a file, for verification and viewing: plain coordinates, nothing computed by an engine.
struct ResultPiece {
  bool arc = false;
  Point start;
  Point middle;  ///< arcs only: a point of the arc strictly between its ends (for a full circle: opposite to start)
  Point end;
  /// Provenance, where the file has it (layer `pieces` of a GeoPackage); -1 where it has not.
  std::int64_t source_feature = -1;
  std::int64_t source_part = -1;
  std::int64_t source_vertex = -1;
};
struct ResultRing {
  std::vector<ResultPiece> pieces;
};
struct ResultPolygon {
  ResultRing outer;
  std::vector<ResultRing> holes;
};
struct ResultZone {
  std::optional<double> radius;  ///< from the file's field `radius`, where it has one
  std::vector<ResultPolygon> polygons;
  std::string crs;               ///< name of the coordinate system, empty if unknown
  std::optional<double> inner = {};  ///< of bands: from the field `inner`
};

/// Reads the zones in a vector file that krepl (or other software) wrote: one per feature, true curves kept; features of equal
/// radius make one zone. Zones without polygons are left out unless they are asked for.
enum class EmptyZones { drop, keep };
Result<std::vector<ResultZone>> read_zones(const std::string& path, EmptyZones empty = EmptyZones::drop);

/// The same with each feature a zone of its own, in the file's order; without the provenance of pieces. Where the input
/// of the result had a field `radius`, the zone's is read from `zone_radius`.
Result<std::vector<ResultZone>> read_zone_features(const std::string& path, EmptyZones empty = EmptyZones::drop);

}  // namespace krepl::input
