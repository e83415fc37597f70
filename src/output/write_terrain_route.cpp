// A route over a terrain as a polyline in space.
#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "output/ogr_dataset.hpp"
#include "output/output_stream.hpp"
#include "output/terrain_route_file.hpp"

namespace krepl::output {

namespace {

Status write_text(const std::string& path, const fmt::memory_buffer& text) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  stream->write({text.data(), text.size()});
  return stream->finish();
}

Status write_csv(const std::string& path, const TerrainRoute& route, const TerrainPicture& picture) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "x,y,z,along,rest\n");
  double along = 0;
  for (std::size_t i = 0; i < route.points.size(); ++i) {
    const Point3 p = route.points[i];
    if (i > 0) {
      const Point3 q = route.points[i - 1];
      along += std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
    }
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", p.x, p.y, p.z, along, picture.rest({p.x, p.y}));
  }
  return write_text(path, text);
}

Status write_wkt(const std::string& path, const TerrainRoute& route) {
  fmt::memory_buffer text;
  const char* before = "LINESTRING Z (";
  for (const Point3& p : route.points) {
    fmt::format_to(std::back_inserter(text), "{}{} {} {}", before, p.x, p.y, p.z);
    before = ", ";
  }
  fmt::format_to(std::back_inserter(text), ")\n");
  return write_text(path, text);
}

Status write_layer(OgrDataset& dataset, const TerrainRoute& route) {
  Result<OGRLayer*> layer = dataset.create_layer(
      "route", wkbLineString25D,
      {{"radius", OFTReal}, {"length", OFTReal}, {"climb", OFTReal}, {"steepest", OFTReal}, {"clearance", OFTReal}});
  if (!layer) return layer.error();
  OGRFeature row((*layer)->GetLayerDefn());
  if (dataset.has_fields()) {
    row.SetField("radius", route.radius);
    row.SetField("length", route.length);
    row.SetField("climb", route.climb);
    if (std::isfinite(route.steepest)) row.SetField("steepest", route.steepest);
    row.SetField("clearance", route.clearance);
  }
  auto line = std::make_unique<OGRLineString>();
  for (const Point3& p : route.points) line->addPoint(p.x, p.y, p.z);
  row.SetGeometryDirectly(line.release());
  return dataset.add(**layer, row);
}

}  // namespace

Result<ZoneFileReport> write_terrain_route(const std::string& path, const TerrainRoute& route,
                                           const TerrainPicture& picture, const RouteFormat& format,
                                           const std::string& crs, const Context& context) {
  using Kind = ZoneFormat::Kind;
  ZoneFileReport report;
  Status written = std::monostate{};
  if (format.csv) {
    written = write_csv(path, route, picture);
  } else if (format.curves.kind == Kind::wkt) {
    written = write_wkt(path, route);
  } else if (format.curves.kind == Kind::svg) {
    written = write_terrain_route_svg(path, route, picture, context);
  } else if (format.curves.kind == Kind::wkb || format.curves.kind == Kind::dxf) {
    written = Error{ErrorCode::usage, "a route over a terrain cannot go to format " + format.curves.name, "",
                    "choose gpkg, geojson, fgb, wkt, csv or svg"};
  } else {
    const bool geojson = format.curves.kind == Kind::geojson;
    written = write_dataset(path, geojson ? "GeoJSON" : format.curves.driver, crs, report.notes,
                            [&](OgrDataset& dataset) { return write_layer(dataset, route); });
  }
  if (!written) return written.error();
  return report;
}

}  // namespace krepl::output
