// Zones of sub-rivers, of main stems with all that comes to them, or of everything, with the attributes of what they
// belong to.
#include <algorithm>

#include "output/ogr_geometry.hpp"
#include "output/river_file.hpp"
#include "output/river_writers.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

using Index = RiverNetwork::Index;

class RiverZones {
 public:
  RiverZones(const RiverNetwork& rivers, RiverPart part, const RiverFileOptions& options, std::vector<std::string>& notes,
             const Context& context)
      : rivers_(rivers), part_(part), options_(options), notes_(notes), source_(options.attributes), context_(context) {
    for (Index s = 0; s < rivers.sub_rivers().size(); ++s) {
      if (part == RiverPart::sub_river || (part == RiverPart::stem && rivers.sub_rivers()[s].is_stem))
        owner_.push_back(s);
    }
  }

  Status write(OgrDataset& dataset, std::span<const Zone> zones) {
    const bool curves = dataset.can(ODsCCurveGeometries);
    Result<OGRLayer*> layer = make_layer(dataset, curves ? wkbMultiSurface : wkbMultiPolygon);
    if (!layer) return layer.error();
    const OuterSense sense =
        dataset.driver() == "ESRI Shapefile" ? OuterSense::clockwise : OuterSense::counter_clockwise;
    for (std::size_t i = 0; i < zones.size(); ++i) {
      if (context_.cancelled()) return interrupted_while_writing();
      if (context_.progress) context_.progress(double(i) / double(zones.size()));
      const Zone& zone = zones[i];
      OGRFeature row((*layer)->GetLayerDefn());
      if (dataset.has_fields()) set_fields(row, zone, i);
      const ZoneFeature feature = zone_features(zone, false).front();
      Linearizer linearizer(zone.radius(), options_.max_error > 0 ? options_.max_error : zone.radius() / 1000);
      auto geometry =
          curves ? curve_geometry(zone, feature, false) : linear_geometry(zone, feature, false, linearizer, sense);
      row.SetGeometryDirectly(geometry.release());
      if (Status added = dataset.add(**layer, row); !added) return added;
      if (!curves) deviation_ = std::max(deviation_.value_or(0), linearizer.deviation());
    }
    return std::monostate{};
  }

  std::optional<double> deviation() const { return deviation_; }

 private:
  Result<OGRLayer*> make_layer(OgrDataset& dataset, OGRwkbGeometryType type) {
    Result<OGRLayer*> layer =
        dataset.create_layer("zones", type, part_ == RiverPart::whole ? OgrDataset::Fields{} : sub_river_fields());
    if (!layer || !dataset.has_fields()) return layer;
    for (const auto& [name, field_type] : {std::pair{"radius", OFTReal},
                                           {"area", OFTReal},
                                           {"perimeter", OFTReal},
                                           {"polygons", OFTInteger},
                                           {"holes", OFTInteger}}) {
      OGRFieldDefn field(name, field_type);
      if ((*layer)->CreateField(&field) != OGRERR_NONE) {
        return Error{ErrorCode::io, std::string("field ") + name + " cannot be written", "", "choose another format"};
      }
    }
    if (part_ == RiverPart::whole) return layer;
    if (Status made = source_.create(**layer, dataset, notes_); !made) return made.error();
    return layer;
  }

  void set_fields(OGRFeature& row, const Zone& zone, std::size_t i) const {
    if (part_ != RiverPart::whole) {
      set_sub_river(row, rivers_, owner_[i]);
      source_.set(row, rivers_.sub_rivers()[owner_[i]].feature);
    }
    row.SetField("radius", zone.radius());
    row.SetField("area", zone.area());
    row.SetField("perimeter", zone.perimeter());
    row.SetField("polygons", int(zone.polygon_count()));
    row.SetField("holes", int(zone.hole_count()));
  }

  const RiverNetwork& rivers_;
  const RiverPart part_;
  const RiverFileOptions& options_;
  std::vector<std::string>& notes_;
  SourceAttributes source_;
  const Context& context_;
  std::vector<Index> owner_;  // per zone: the sub-river whose attributes it has
  std::optional<double> deviation_;
};

}  // namespace

Result<ZoneFileReport> write_river_zones(const std::string& path, const RiverNetwork& rivers, RiverPart part,
                                         std::span<const Zone> zones, const ZoneFormat& format,
                                         const RiverFileOptions& options, const Context& context) {
  if (format.kind != ZoneFormat::Kind::ogr && format.kind != ZoneFormat::Kind::geojson) {
    ZoneFileOptions plain;
    plain.crs = options.crs;
    plain.max_error = options.max_error;
    return write_zones(path, zones, format, plain, context);
  }
  ZoneFileReport report;
  RiverZones writer(rivers, part, options, report.notes, context);
  const std::string driver = format.kind == ZoneFormat::Kind::geojson ? "GeoJSON" : format.driver;
  Status written = write_dataset(path, driver, options.crs, report.notes,
                                 [&](OgrDataset& dataset) { return writer.write(dataset, zones); });
  if (!written) return written.error();
  report.deviation = writer.deviation();
  return report;
}

}  // namespace krepl::output
