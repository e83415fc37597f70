#include "input/result_file.hpp"

#include <algorithm>
#include <bit>
#include <unordered_map>

#include "input/geometry_source.hpp"
#include "input/ogr_curve.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

ResultRing ring_of(const OGRCurve& curve) {
  ResultRing ring;
  append_pieces(curve, ring.pieces);
  return ring;
}

void append_polygon(const OGRCurvePolygon& polygon, std::vector<ResultPolygon>& polygons) {
  if (polygon.getExteriorRingCurve() == nullptr) return;
  ResultPolygon result;
  result.outer = ring_of(*polygon.getExteriorRingCurve());
  for (int i = 0; i < polygon.getNumInteriorRings(); ++i) {
    result.holes.push_back(ring_of(*polygon.getInteriorRingCurve(i)));
  }
  polygons.push_back(std::move(result));
}

Status append_polygons(const OGRGeometry& geometry, const std::string& place, std::vector<ResultPolygon>& polygons) {
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbPolygon:
    case wkbCurvePolygon:
      append_polygon(*geometry.toCurvePolygon(), polygons);
      return std::monostate{};
    case wkbMultiPolygon:
    case wkbMultiSurface:
    case wkbGeometryCollection:
      for (const OGRGeometry* member : *geometry.toGeometryCollection()) {
        if (Status appended = append_polygons(*member, place, polygons); !appended) return appended;
      }
      return std::monostate{};
    default:
      return Error{ErrorCode::input, std::string("geometry of type ") + geometry.getGeometryName() + " is not a zone", place,
                   "give polygons"};
  }
}

std::int64_t integer_field(const OGRFeature& feature, const char* name) {
  int index = feature.GetFieldIndex(name);
  return index < 0 || !feature.IsFieldSetAndNotNull(index) ? -1 : feature.GetFieldAsInteger64(index);
}

/// With --separate a zone is several features, one a polygon, which agree in their radius.
bool continues(const ResultZone& zone, std::optional<double> radius) { return radius && zone.radius == radius; }

Result<std::vector<ResultZone>> collect_zones(GeometrySource& source, bool merge, EmptyZones empty) {
  std::vector<ResultZone> zones;
  for (;;) {
    auto item = source.next();
    if (!item) return item.error();
    if (!item->has_value()) break;
    const GeometrySource::Item& record = **item;
    const bool is_none = record.geometry == nullptr;  // what Shapefile makes of an empty one
    if ((is_none && merge) || ((is_none || record.geometry->IsEmpty()) && empty == EmptyZones::drop)) continue;
    std::optional<double> radius = merge ? std::nullopt : number_field(record.feature, "zone_radius");
    if (!radius) radius = number_field(record.feature, "radius");
    auto known =
        std::find_if(zones.begin(), zones.end(), [&](const ResultZone& z) { return merge && continues(z, radius); });
    if (known == zones.end()) {
      zones.push_back({radius, {}, {}, merge ? number_field(record.feature, "inner") : std::nullopt});
      known = zones.end() - 1;
    }
    if (is_none) continue;
    Status appended = append_polygons(*record.geometry, source.place(record.number), known->polygons);
    if (!appended) return appended.error();
  }
  if (zones.empty()) return Error{ErrorCode::input, "has no zones", "", "give polygons"};
  if (std::optional<OGRSpatialReference> crs = source.crs()) {
    for (ResultZone& zone : zones) zone.crs = ogr::crs_name(*crs);
  }
  return zones;
}

struct PieceEnds {
  Point start, end;
  friend bool operator==(const PieceEnds&, const PieceEnds&) = default;
};
struct HashEnds {
  std::size_t operator()(const PieceEnds& ends) const {
    std::uint64_t hash = 0;
    for (double value : {ends.start.x, ends.start.y, ends.end.x, ends.end.y}) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15ull;
      hash ^= hash >> 32;
    }
    return hash;
  }
};
struct Provenance {
  std::int64_t feature, part, vertex;
};
using ProvenanceMap = std::unordered_map<PieceEnds, Provenance, HashEnds>;

Result<ProvenanceMap> read_provenance(const std::string& path) {
  auto source = open_geometry_source(path, {"pieces", ""});
  if (!source) return source.error();
  ProvenanceMap map;
  std::vector<ResultPiece> pieces;
  for (;;) {
    auto item = (*source)->next();
    if (!item) return item.error();
    if (!item->has_value()) return map;
    const GeometrySource::Item& record = **item;
    if (record.geometry == nullptr || !OGR_GT_IsCurve(record.geometry->getGeometryType())) continue;
    pieces.clear();
    append_pieces(*record.geometry->toCurve(), pieces);
    Provenance provenance{integer_field(*record.feature, "source_feature"), integer_field(*record.feature, "source_part"),
                          integer_field(*record.feature, "source_vertex")};
    for (const ResultPiece& piece : pieces) map[{piece.start, piece.end}] = provenance;
  }
}

void apply_provenance(const ProvenanceMap& map, ResultRing& ring) {
  for (ResultPiece& piece : ring.pieces) {
    auto found = map.find({piece.start, piece.end});
    if (found == map.end()) continue;
    piece.source_feature = found->second.feature;
    piece.source_part = found->second.part;
    piece.source_vertex = found->second.vertex;
  }
}

/// The layer that holds the zones: `zone` where there is one, else the only one besides `pieces`.
Result<std::string> zone_layer(const std::vector<std::string>& layers) {
  std::vector<std::string> others;
  for (const std::string& layer : layers) {
    if (layer == "zone") return layer;
    if (layer != "pieces") others.push_back(layer);
  }
  if (others.size() == 1) return others.front();
  if (others.empty()) return Error{ErrorCode::input, "has no layer of zones", "", "give a file that holds polygons"};
  return Error{ErrorCode::input, "has more than one layer and none is called zone", "", "extract one with ogr2ogr"};
}

/// Chooses the layer of zones; `has_pieces` tells if there is one of pieces beside it.
Result<std::unique_ptr<GeometrySource>> open_zones(const std::string& path, bool& has_pieces) {
  SourceSelection selection;
  std::string extension = format_extension(path);
  if (path != "-" && extension != "wkt" && extension != "wkb") {
    Result<std::vector<std::string>> layers = geometry_layers(path);
    if (!layers) return layers.error();
    has_pieces = std::find(layers->begin(), layers->end(), "pieces") != layers->end();
    Result<std::string> layer = zone_layer(*layers);
    if (!layer) return layer.error();
    selection.layer = *layer;
  }
  return open_geometry_source(path, selection);
}

}  // namespace

Result<std::vector<ResultZone>> read_zone_features(const std::string& path, EmptyZones empty) {
  bool has_pieces = false;
  auto source = open_zones(path, has_pieces);
  if (!source) return source.error();
  return collect_zones(**source, false, empty);
}

Result<std::vector<ResultZone>> read_zones(const std::string& path, EmptyZones empty) {
  bool has_pieces = false;
  auto source = open_zones(path, has_pieces);
  if (!source) return source.error();
  Result<std::vector<ResultZone>> zones = collect_zones(**source, true, empty);
  if (!zones || !has_pieces) return zones;

  Result<ProvenanceMap> provenance = read_provenance(path);
  if (!provenance) return provenance.error();
  for (ResultZone& zone : *zones) {
    for (ResultPolygon& polygon : zone.polygons) {
      apply_provenance(*provenance, polygon.outer);
      for (ResultRing& hole : polygon.holes) apply_provenance(*provenance, hole);
    }
  }
  return zones;
}

}  // namespace krepl::input
