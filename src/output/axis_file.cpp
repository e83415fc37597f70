#include "output/axis_file.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <iterator>

#include "ogr/message_capture.hpp"
#include "output/atomic_file.hpp"
#include "output/ogr_options.hpp"
#include "output/output_stream.hpp"

namespace krepl::output {

namespace {

Error interrupted() { return {ErrorCode::cancelled, "interrupted while writing", "", ""}; }

void put_points(fmt::memory_buffer& text, const std::vector<Point>& points, std::string_view between,
                std::string_view pair) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) text.append(between);
    fmt::format_to(std::back_inserter(text), fmt::runtime(pair), points[i].x, points[i].y);
  }
}

void put_wkt(fmt::memory_buffer& text, const AxisLine& line) {
  text.append(std::string_view("LINESTRING ("));
  put_points(text, line.points, ", ", "{} {}");
  text.append(std::string_view(")\n"));
}

void put_geojson(fmt::memory_buffer& text, const AxisLine& line, bool first) {
  fmt::format_to(
      std::back_inserter(text),
      "{}{{\"type\":\"Feature\",\"properties\":{{\"kind\":\"{}\",\"start_clearance\":{},\"end_clearance\":{},"
      "\"min_clearance\":{},\"left_feature\":{},\"right_feature\":{},\"left_site\":\"{}\",\"right_site\":\"{}\"}},"
      "\"geometry\":{{\"type\":\"LineString\",\"coordinates\":[",
      first ? "" : ",\n", line.kind, line.start_clearance, line.end_clearance, line.minimum, line.left_feature,
      line.right_feature, line.left_site, line.right_site);
  put_points(text, line.points, ",", "[{},{}]");
  text.append(std::string_view("]}}"));
}

Status write_text(const std::string& path, const AxisSource& lines, bool geojson, const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  if (geojson) stream->write("{\"type\":\"FeatureCollection\",\"features\":[\n");
  bool first = true, stopped = false;
  lines([&](const AxisLine& line) {
    stopped = context.cancelled();
    if (stopped || stream->failed()) return false;
    fmt::memory_buffer text;
    if (geojson) {
      put_geojson(text, line, first);
    } else {
      put_wkt(text, line);
    }
    first = false;
    stream->write({text.data(), text.size()});
    return true;
  });
  if (stopped) return interrupted();
  if (geojson) stream->write("\n]}\n");
  return stream->finish();
}

struct Field {
  const char* name;
  OGRFieldType type;
};
// Ten characters at most, for Shapefile.
constexpr Field fields[] = {{"kind", OFTString},      {"start_clr", OFTReal},      {"end_clr", OFTReal},
                            {"min_clr", OFTReal},     {"left_feat", OFTInteger64}, {"right_feat", OFTInteger64},
                            {"left_site", OFTString}, {"right_site", OFTString}};

class AxisLayer {
 public:
  explicit AxisLayer(const Context& context) : context_(context) {}

  Status write(const std::string& path, const std::string& driver_name, const AxisSource& lines,
               const std::string& crs) {
    ScopedOption fixed_date("OGR_CURRENT_DATE", file_date("%Y-%m-%dT%H:%M:%S.000Z"));
    ScopedOption lazy("OGR_SQLITE_SYNCHRONOUS", "OFF");
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_name.c_str());
    if (driver == nullptr) return failure();
    dataset_.reset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (!dataset_) return failure();
    if (Status created = create_layer(driver_name, crs); !created) return created;
    const bool transaction = dataset_->TestCapability(ODsCTransactions) && dataset_->StartTransaction() == OGRERR_NONE;
    Status state = std::monostate{};
    lines([&](const AxisLine& line) {
      if (context_.cancelled()) state = interrupted();
      if (state) state = add(line);
      return state.ok();
    });
    if (!state) return state;
    if (transaction && dataset_->CommitTransaction() != OGRERR_NONE) return failure();
    dataset_->FlushCache(true);
    dataset_.reset();
    return messages_.failed() ? Status(failure()) : Status(std::monostate{});
  }

 private:
  Error failure() const {
    return messages_.error(ErrorCode::io, "cannot be written", "", "choose another place or format");
  }

  Status create_layer(const std::string& driver_name, const std::string& crs) {
    OGRSpatialReference reference;
    if (!crs.empty()) {
      reference.importFromWkt(crs.c_str());
      reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    } else if (driver_name == "GPKG") {
      reference.SetLocalCS("Undefined Cartesian SRS");
    }
    layer_ = dataset_->CreateLayer("axis", reference.IsEmpty() ? nullptr : &reference, wkbLineString, nullptr);
    if (layer_ == nullptr) return failure();
    for (const Field& f : fields) {
      OGRFieldDefn field(f.name, f.type);
      if (layer_->CreateField(&field) != OGRERR_NONE) return failure();
    }
    return std::monostate{};
  }

  Status add(const AxisLine& line) {
    OGRFeature feature(layer_->GetLayerDefn());
    feature.SetField(0, line.kind.c_str());
    feature.SetField(1, line.start_clearance);
    feature.SetField(2, line.end_clearance);
    feature.SetField(3, line.minimum);
    feature.SetField(4, static_cast<GIntBig>(line.left_feature));
    feature.SetField(5, static_cast<GIntBig>(line.right_feature));
    feature.SetField(6, line.left_site.c_str());
    feature.SetField(7, line.right_site.c_str());
    auto geometry = std::make_unique<OGRLineString>();
    for (const Point& p : line.points) geometry->addPoint(p.x, p.y);
    feature.SetGeometryDirectly(geometry.release());
    messages_.clear();
    if (layer_->CreateFeature(&feature) != OGRERR_NONE || messages_.failed()) return failure();
    return std::monostate{};
  }

  const Context& context_;
  ogr::MessageCapture messages_;
  std::unique_ptr<GDALDataset> dataset_;
  OGRLayer* layer_ = nullptr;
};

}  // namespace

Status write_axis(const std::string& path, const AxisSource& lines, const ZoneFormat& format, const std::string& crs,
                  const Context& context) {
  using Kind = ZoneFormat::Kind;
  if (format.kind == Kind::wkt || format.kind == Kind::geojson) {
    return write_text(path, lines, format.kind == Kind::geojson, context);
  }
  if (format.kind != Kind::ogr) {
    return Error{ErrorCode::usage, "an axis cannot go to format " + format.name, "",
                 "choose gpkg, fgb, wkt, geojson, svg, shp or the name of a GDAL vector driver"};
  }
  ogr::initialise();
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (Status written = AxisLayer(context).write(file->temporary_path(), format.driver, lines, crs); !written)
    return written;
  return file->commit();
}

}  // namespace krepl::output
