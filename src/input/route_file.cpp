#include "input/route_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "input/csv_table.hpp"
#include "input/geometry_source.hpp"
#include "input/ogr_curve.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

bool is_line(const OGRGeometry& geometry) {
  const auto type = wkbFlatten(geometry.getGeometryType());
  return type == wkbLineString || type == wkbCompoundCurve || type == wkbCircularString;
}

/// The layer `route` where there is one; nothing is chosen where there is one layer only.
Result<std::unique_ptr<GeometrySource>> open_route(const std::string& path) {
  SourceSelection selection;
  const std::string extension = format_extension(path);
  if (path != "-" && extension != "wkt" && extension != "wkb") {
    const Result<std::vector<std::string>> layers = geometry_layers(path);
    if (!layers) return layers.error();
    if (layers->size() > 1 && std::find(layers->begin(), layers->end(), "route") != layers->end())
      selection.layer = "route";
  }
  return open_geometry_source(path, selection);
}

Status append_points(const OGRGeometry& geometry, const std::string& place, std::vector<Point3>& points) {
  if (wkbFlatten(geometry.getGeometryType()) != wkbLineString)
    return Error{ErrorCode::input, "a route with heights has arcs", place, "give a line of straight pieces"};
  const OGRLineString& line = *geometry.toLineString();
  for (int i = 0; i < line.getNumPoints(); ++i) points.push_back({line.getX(i), line.getY(i), line.getZ(i)});
  return std::monostate{};
}

bool finite(const ResultPiece& piece) {
  const auto ok = [](Point p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  return ok(piece.start) && ok(piece.end) && (!piece.arc || ok(piece.middle));
}

Result<RouteRecord> checked(RouteRecord route) {
  if (route.pieces.empty())
    return Error{ErrorCode::input, "holds no route", "", "give a line of two points or more, as krepl route writes it"};
  bool ok = std::all_of(route.pieces.begin(), route.pieces.end(), finite);
  for (const Point3& p : route.points) ok = ok && std::isfinite(p.z);
  if (!ok) return Error{ErrorCode::input, "has a coordinate that is not finite", "", ""};
  return route;
}

Result<RouteRecord> read_geometry(const std::string& path) {
  auto source = open_route(path);
  if (!source) return source.error();
  RouteRecord route;
  for (;;) {
    auto item = (*source)->next();
    if (!item) return item.error();
    if (!item->has_value()) break;
    const GeometrySource::Item& record = **item;
    if (record.geometry == nullptr || record.geometry->IsEmpty()) continue;
    const std::string place = (*source)->place(record.number);
    if (!is_line(*record.geometry))
      return Error{ErrorCode::input, std::string("geometry of type ") + record.geometry->getGeometryName() + " is not a route",
                   place, "give a line"};
    if (!route.pieces.empty()) return Error{ErrorCode::input, "holds more than one route", place, "give one line"};
    if (record.geometry->Is3D())
      if (Status added = append_points(*record.geometry, place, route.points); !added) return added.error();
    append_pieces(*record.geometry->toCurve(), route.pieces);
    route.radius = number_field(record.feature, "radius");
    route.clearance = number_field(record.feature, "clearance");
  }
  if (const auto crs = (*source)->crs()) route.crs = ogr::crs_name(*crs);
  return checked(std::move(route));
}

/// Half-way along an arc about a centre; for a full circle opposite to its start.
Point middle_of(Point start, Point end, Point center, bool clockwise) {
  const double from = std::atan2(start.y - center.y, start.x - center.x), to = std::atan2(end.y - center.y, end.x - center.x);
  double span = clockwise ? from - to : to - from;
  if (span <= 0) span += 2 * std::numbers::pi;
  const double angle = from + (clockwise ? -span : span) / 2, radius = std::hypot(start.x - center.x, start.y - center.y);
  return {center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)};
}

Result<std::vector<std::size_t>> columns_of(const CsvTable& table, std::initializer_list<const char*> names) {
  std::vector<std::size_t> columns;
  for (const char* name : names) {
    const Result<std::size_t> column = table.column(name);
    if (!column) return column.error();
    columns.push_back(*column);
  }
  return columns;
}

Result<std::vector<double>> numbers_of(const CsvTable& table, const std::vector<std::size_t>& columns, std::size_t first,
                                       std::size_t last) {
  std::vector<double> numbers;
  for (std::size_t k = first; k < last; ++k) {
    const Result<double> number = table.finite(columns[k]);
    if (!number) return number.error();
    numbers.push_back(*number);
  }
  return numbers;
}

Result<RouteRecord> read_pieces(CsvTable table) {
  const auto columns = columns_of(table, {"x0", "y0", "x1", "y1", "cx", "cy", "kind", "sense"});
  if (!columns) return columns.error();
  RouteRecord route;
  while (table.next()) {
    const auto ends = numbers_of(table, *columns, 0, 4);
    if (!ends) return ends.error();
    const Point start{(*ends)[0], (*ends)[1]}, end{(*ends)[2], (*ends)[3]};
    const std::string_view kind = table.field((*columns)[6]), sense = table.field((*columns)[7]);
    if (kind == "parabola")
      return Error{ErrorCode::input, "a parabola does not tell its directrix here", table.place(),
                   "write the route to .gpkg, .wkt or .geojson"};
    if (kind != "line" && (kind != "arc" || (sense != "cw" && sense != "ccw")))
      return Error{ErrorCode::input, "is neither a line nor an arc with the sense cw or ccw", table.place(), ""};
    ResultPiece piece{kind == "arc", start, {}, end};
    if (piece.arc) {
      const auto center = numbers_of(table, *columns, 4, 6);
      if (!center) return center.error();
      piece.middle = middle_of(start, end, {(*center)[0], (*center)[1]}, sense == "cw");
    }
    route.pieces.push_back(piece);
  }
  return checked(std::move(route));
}

Result<RouteRecord> read_places(CsvTable table) {
  const auto columns = columns_of(table, {"x", "y", "z"});
  if (!columns) return columns.error();
  RouteRecord route;
  while (table.next()) {
    const auto p = numbers_of(table, *columns, 0, 3);
    if (!p) return p.error();
    route.points.push_back({(*p)[0], (*p)[1], (*p)[2]});
    if (route.points.size() < 2) continue;
    const Point3 a = route.points[route.points.size() - 2], b = route.points.back();
    route.pieces.push_back({false, {a.x, a.y}, {}, {b.x, b.y}});
  }
  return checked(std::move(route));
}

}  // namespace

bool looks_like_route(const std::string& path) {
  if (format_extension(path) == "csv") {
    const Result<CsvTable> table = CsvTable::open(path);
    return table && (table->column("sense") || (table->column("x") && table->column("y") && table->column("z")));
  }
  auto source = open_route(path);
  if (!source) return false;
  for (;;) {
    auto item = (*source)->next();
    if (!item || !item->has_value()) return false;
    if ((*item)->geometry != nullptr && !(*item)->geometry->IsEmpty()) return is_line(*(*item)->geometry);
  }
}

Result<RouteRecord> read_route(const std::string& path) {
  if (format_extension(path) != "csv") return read_geometry(path);
  Result<CsvTable> table = CsvTable::open(path);
  if (!table) return table.error();
  return table->column("sense") ? read_pieces(std::move(*table)) : read_places(std::move(*table));
}

}  // namespace krepl::input
