// Formats written by OGR drivers: GeoPackage and FlatGeobuf with true curves, Shapefile and the rest with chords.
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <filesystem>

#include "krepl/curve_network.hpp"
#include "ogr/message_capture.hpp"
#include "output/atomic_file.hpp"
#include "output/ogr_dataset.hpp"
#include "output/ogr_geometry.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

/// Number of coordinates in a geometry: what is compared after reading a file back.
std::size_t coordinate_count(const OGRGeometry& geometry) {
  OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  std::size_t count = 0;
  if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
    for (const OGRGeometry* member : *geometry.toGeometryCollection()) count += coordinate_count(*member);
  } else if (OGR_GT_IsSubClassOf(type, wkbCurvePolygon)) {
    for (const OGRCurve* ring : *geometry.toCurvePolygon()) count += static_cast<std::size_t>(ring->getNumPoints());
  }
  return count;
}

class OgrWriter {
 public:
  OgrWriter(const std::string& driver, const ZoneFileOptions& options, const Context& context)
      : driver_(driver), options_(options), context_(context), dataset_(driver, options.crs) {}

  Status write(const std::string& path, std::span<const Zone> zones);
  const ZoneFileReport& report() const { return report_; }

 private:
  Status write_zone_layer(std::span<const Zone> zones);
  Status write_zone(OGRLayer& layer, const Zone& zone, bool curves);
  Status write_pieces(std::span<const Zone> zones);
  Status add_piece(OGRLayer& layer, const Zone& zone, std::uint32_t piece);
  Status read_back(const std::string& path);
  static Error failure(const ogr::MessageCapture& messages, const std::string& what) {
    return messages.error(ErrorCode::io, what, "", "free some space, or choose another place or format");
  }

  const std::string& driver_;
  const ZoneFileOptions& options_;
  const Context& context_;
  OgrDataset dataset_;
  ZoneFileReport report_;
  std::size_t features_ = 0, coordinates_ = 0;
};

Status OgrWriter::write_zone(OGRLayer& layer, const Zone& zone, bool curves) {
  Linearizer linearizer(zone.radius(), max_error_for(options_, zone.radius()));
  OuterSense sense = driver_ == "ESRI Shapefile" ? OuterSense::clockwise : OuterSense::counter_clockwise;
  for (const ZoneFeature& from : zone_features(zone, options_.separate)) {
    if (context_.cancelled()) return interrupted_while_writing();
    OGRFeature feature(layer.GetLayerDefn());
    if (dataset_.has_fields()) {
      if (from.radius) feature.SetField("radius", *from.radius);
      if (options_.bands) feature.SetField("inner", from.inner_radius);
      feature.SetField("area", from.area);
      feature.SetField("perimeter", from.perimeter);
      feature.SetField("polygons", static_cast<int>(from.polygon_count));
      feature.SetField("holes", static_cast<int>(from.holes));
    }
    auto geometry = curves ? curve_geometry(zone, from, options_.separate)
                           : linear_geometry(zone, from, options_.separate, linearizer, sense);
    ++features_;
    coordinates_ += coordinate_count(*geometry);
    feature.SetGeometryDirectly(geometry.release());
    if (Status added = dataset_.add(layer, feature); !added) return added;
  }
  if (!curves) report_.deviation = std::max(report_.deviation.value_or(0), linearizer.deviation());
  return std::monostate{};
}

Status OgrWriter::write_zone_layer(std::span<const Zone> zones) {
  const bool curves = dataset_.can(ODsCCurveGeometries);
  OGRwkbGeometryType type = curves ? (options_.separate ? wkbCurvePolygon : wkbMultiSurface)
                                   : (options_.separate ? wkbPolygon : wkbMultiPolygon);
  std::vector<std::string> layer_options;
  // Its index would reorder the features; with a feature per radius there is nothing to search.
  if (driver_ == "FlatGeobuf" && !options_.separate) layer_options = {"SPATIAL_INDEX=NO"};
  OgrDataset::Fields fields{
      {"radius", OFTReal}, {"area", OFTReal}, {"perimeter", OFTReal}, {"polygons", OFTInteger}, {"holes", OFTInteger}};
  if (options_.bands) fields.insert(fields.begin() + 1, {"inner", OFTReal});
  Result<OGRLayer*> layer = dataset_.create_layer("zone", type, fields, layer_options);
  if (!layer) return layer.error();
  for (const Zone& zone : zones) {
    if (Status written = write_zone(**layer, zone, curves); !written) return written;
  }
  return std::monostate{};
}

/// What a piece is: offsets by their form, others by their role.
static const char* kind_of(const Zone::Piece& piece) {
  switch (piece.role) {
    case Zone::Role::offset: break;
    case Zone::Role::input: return "input";
    case Zone::Role::end: return "end";
    case Zone::Role::bevel: return "bevel";
    case Zone::Role::between: return "between";
  }
  return piece.kind == Zone::Kind::arc ? "arc" : "segment";
}

static Network::Source source_of(const Zone& zone, const Zone::Piece& piece) {
  if (piece.from_arc) return zone.curves()->arc_source(piece.source);
  return piece.from_vertex ? zone.network().vertex_source(piece.source) : zone.network().segment_source(piece.source);
}

Status OgrWriter::add_piece(OGRLayer& layer, const Zone& zone, std::uint32_t piece) {
  Zone::Piece from = zone.piece(piece);
  const Network::Source source = source_of(zone, from);
  OGRFeature feature(layer.GetLayerDefn());
  feature.SetField("radius", zone.signed_radius() < 0 ? -from.radius
                             : zone.is_inner(piece)   ? zone.inner_radius()
                             : from.from_arc          ? zone.radius()
                                                      : from.radius);
  feature.SetField("kind", kind_of(from));
  feature.SetField("source_feature", static_cast<GIntBig>(source.feature));
  feature.SetField("source_part", static_cast<GIntBig>(source.part));
  feature.SetField("source_vertex", static_cast<GIntBig>(source.vertex));
  feature.SetField("length", piece_length(from));
  feature.SetGeometryDirectly(piece_geometry(zone, piece).release());
  return dataset_.add(layer, feature);
}

Status OgrWriter::write_pieces(std::span<const Zone> zones) {
  Result<OGRLayer*> layer = dataset_.create_layer("pieces", wkbCompoundCurve,
                                                  {{"radius", OFTReal}, {"kind", OFTString}, {"source_feature", OFTInteger64},
                                                   {"source_part", OFTInteger64}, {"source_vertex", OFTInteger64},
                                                   {"length", OFTReal}});
  if (!layer) return layer.error();
  std::size_t total = 0, done = 0;
  for (const Zone& zone : zones) total += zone.piece_count();
  for (const Zone& zone : zones) {
    for (std::uint32_t e = 0; e < zone.piece_count(); ++e, ++done) {
      if (context_.cancelled()) return interrupted_while_writing();
      if (context_.progress && done % 1024 == 0) context_.progress(static_cast<double>(done) / static_cast<double>(total));
      if (Status added = add_piece(**layer, zone, e); !added) return added;
    }
  }
  return std::monostate{};
}

Status OgrWriter::read_back(const std::string& path) {
  ogr::MessageCapture messages;
  // Only the coordinates are counted: which ring belongs to which polygon would cost quadratic time.
  ScopedOption unsorted("OGR_ORGANIZE_POLYGONS", "SKIP");
  std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset || dataset->GetLayerCount() == 0) return failure(messages, "cannot be read back after writing");
  std::size_t features = 0, coordinates = 0;
  for (const auto& feature : *dataset->GetLayer(0)) {
    if (context_.cancelled()) return interrupted_while_writing();
    ++features;
    if (const OGRGeometry* geometry = feature->GetGeometryRef()) coordinates += coordinate_count(*geometry);
  }
  if (messages.failed() || features != features_ || coordinates != coordinates_) {
    return failure(messages, "is not complete after writing");
  }
  return std::monostate{};
}

Status OgrWriter::write(const std::string& path, std::span<const Zone> zones) {
  // The driver would find out again, in quadratic time, which ring is a hole; write_zone gives rings their right sense.
  ScopedOption as_given("SHAPE_REWIND_ON_WRITE", "NO");
  if (Status created = dataset_.create(path); !created) return created;
  if (Status written = write_zone_layer(zones); !written) return written;
  if (driver_ == "GPKG" && options_.pieces) {
    if (Status written = write_pieces(zones); !written) return written;
  }
  if (Status closed = dataset_.close(); !closed) return closed;
  // SQLite tells of every failed write. Other drivers do not always.
  return driver_ == "GPKG" ? Status(std::monostate{}) : read_back(path);
}

/// What an old Shapefile has beside it and a new one has not: an index of other shapes, a coordinate system.
std::vector<std::filesystem::path> stale_side_files(const std::string& path, const std::string& driver,
                                                    const std::filesystem::path& temporary) {
  std::vector<std::filesystem::path> stale;
  if (driver != "ESRI Shapefile") return stale;
  for (const char* extension : {".qix", ".sbn", ".sbx", ".cpg", ".prj"}) {
    if (std::filesystem::exists(std::filesystem::path(temporary).replace_extension(extension))) continue;
    stale.push_back(std::filesystem::path(path).replace_extension(extension));
  }
  return stale;
}

}  // namespace

WriteResult write_ogr(const std::string& path, const std::string& driver, std::span<const Zone> zones,
                      const ZoneFileOptions& options, const Context& context) {
  ogr::initialise();
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  ZoneFileReport report;
  {
    OgrWriter writer(driver, options, context);
    if (Status written = writer.write(file->temporary_path(), zones); !written) return written.error();
    report = writer.report();
  }
  auto stale = stale_side_files(path, driver, file->temporary_path());
  if (Status committed = file->commit(); !committed) return committed.error();
  for (const std::filesystem::path& side_file : stale) {
    std::error_code ignored;
    std::filesystem::remove(side_file, ignored);
  }
  return report;
}

}  // namespace krepl::output
