#include "input/profile_reader.hpp"

#include <charconv>
#include <cmath>
#include <limits>

#include "input/csv_table.hpp"
#include "input/geometry_source.hpp"

namespace krepl::input {

namespace {

std::string number_text(double x) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, x).ptr;
  return {text, end};
}

Error decreasing_error(double before, double x, const std::string& place) {
  return {ErrorCode::input, "x decreases from " + number_text(before) + " to " + number_text(x), place,
          "sort the points by x; a terrain has one height above each x, cliffs apart"};
}

Result<TerrainLine> read_csv(const std::string& path, const Context& context) {
  const PointCheck not_decreasing = [](std::span<const Point> before, Point p, const CsvTable& table) -> Status {
    if (!before.empty() && p.x < before.back().x) return decreasing_error(before.back().x, p.x, table.place());
    return std::monostate{};
  };
  Result<std::vector<Point>> points = read_points(path, "x", "z", "points", context, not_decreasing);
  if (!points) return points.error();
  return TerrainLine{std::move(*points), {}};
}

/// The only line in a geometry, or null.
const OGRSimpleCurve* only_line(const OGRGeometry& geometry) {
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbLineString:
      return geometry.toSimpleCurve();
    case wkbMultiLineString: {
      const OGRGeometryCollection& parts = *geometry.toGeometryCollection();
      return parts.getNumGeometries() == 1 ? only_line(*parts.getGeometryRef(0)) : nullptr;
    }
    default:
      return nullptr;
  }
}

Status take_line(const OGRSimpleCurve& line, const std::string& place, TerrainLine& data) {
  const bool heights = line.Is3D() != 0;
  double chainage = 0;
  for (int i = 0; i < line.getNumPoints(); ++i) {
    if (heights && i > 0) chainage += std::hypot(line.getX(i) - line.getX(i - 1), line.getY(i) - line.getY(i - 1));
    const Point p{heights ? chainage : line.getX(i), heights ? line.getZ(i) : line.getY(i)};
    const std::string vertex = place + ", vertex " + std::to_string(i);
    if (!std::isfinite(p.x) || !std::isfinite(p.y))
      return Error{ErrorCode::input, "a coordinate is not finite", vertex, "correct or remove the point"};
    if (i > 0 && p.x < data.points.back().x) return decreasing_error(data.points.back().x, p.x, vertex);
    data.points.push_back(p);
  }
  data.notes.push_back(heights ? "x is the length along the line, z its height" : "the line's x and y are taken as x and z");
  return std::monostate{};
}

Result<TerrainLine> read_line(const TerrainLineRequest& request, const Context& context) {
  auto source = open_geometry_source(request.path, {request.layer, request.where}, context);
  if (!source) return source.error();
  TerrainLine data;
  for (;;) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    auto item = (*source)->next();
    if (!item) return item.error();
    if (!item->has_value()) break;
    const GeometrySource::Item& record = **item;
    const std::string place = (*source)->place(record.number);
    if (record.geometry == nullptr || record.geometry->IsEmpty()) continue;
    const OGRSimpleCurve* line = only_line(*record.geometry);
    if (line == nullptr)
      return Error{ErrorCode::input, std::string("a ") + record.geometry->getGeometryName() + " is not one line", place,
                   "give a file with one LINESTRING"};
    if (!data.points.empty())
      return Error{ErrorCode::input, "has more than one line", place, "choose one with --where"};
    if (Status taken = take_line(*line, place, data); !taken) return taken.error();
  }
  if (data.points.empty()) return Error{ErrorCode::input, "has no line", "", "give a file with one LINESTRING"};
  if (const auto crs = (*source)->crs(); crs && crs->IsGeographic() != 0)
    return Error{ErrorCode::input, "coordinates are in degrees", "", "project the line first: ogr2ogr -t_srs EPSG:xxxx"};
  return data;
}

struct ProfileColumns {
  std::size_t kind, x0, y0, x1, y1, cx, cy, segment;
};

Result<ProfileColumns> profile_columns(const CsvTable& table) {
  ProfileColumns c{};
  const std::pair<const char*, std::size_t*> names[] = {{"kind", &c.kind}, {"x0", &c.x0}, {"y0", &c.y0},
                                                        {"x1", &c.x1},     {"y1", &c.y1}, {"cx", &c.cx},
                                                        {"cy", &c.cy},     {"segment", &c.segment}};
  for (const auto& [name, place] : names) {
    const Result<std::size_t> column = table.column(name);
    if (!column) return column.error();
    *place = *column;
  }
  return c;
}

Status take_cause(const CsvTable& table, std::string_view text, ProfileRecord& record) {
  const Error error{ErrorCode::input, "segment '" + std::string(text.substr(0, 40)) + "' is not s or v and a number",
                    table.place(), ""};
  if (text.size() < 2 || (text[0] != 's' && text[0] != 'v')) return error;
  record.by_segment = text[0] == 's';
  const auto [end, status] = std::from_chars(text.data() + 1, text.data() + text.size(), record.cause);
  if (status != std::errc{} || end != text.data() + text.size()) return error;
  return std::monostate{};
}

Result<ProfileRecord> profile_record(const CsvTable& table, const ProfileColumns& c) {
  ProfileRecord record;
  record.line = table.line();
  const std::string_view kind = table.field(c.kind);
  if (kind == "half_line") record.kind = ProfileRecord::Kind::half_line;
  else if (kind == "segment") record.kind = ProfileRecord::Kind::segment;
  else if (kind == "arc") record.kind = ProfileRecord::Kind::arc;
  else
    return Error{ErrorCode::input, "kind '" + std::string(kind.substr(0, 40)) + "' is not half_line, segment or arc",
                 table.place(), ""};
  const bool half_line = record.kind == ProfileRecord::Kind::half_line;
  const std::pair<std::size_t, double*> values[] = {{c.x0, &record.start.x},  {c.y0, &record.start.y},
                                                    {c.x1, &record.end.x},    {c.y1, &record.end.y},
                                                    {c.cx, &record.center.x}, {c.cy, &record.center.y}};
  for (const auto& [column, value] : values) {
    const bool center = column == c.cx || column == c.cy;
    if (center && record.kind != ProfileRecord::Kind::arc) continue;
    const bool may_be_infinite = half_line && (column == c.y0 || column == c.y1);
    const Result<double> number = may_be_infinite ? table.number(column) : table.finite(column);
    if (!number) return number.error();
    *value = *number;
  }
  if (Status cause = take_cause(table, table.field(c.segment), record); !cause) return cause.error();
  return record;
}

}  // namespace

Result<TerrainLine> read_terrain_line(const TerrainLineRequest& request, const Context& context) {
  if (request.path == "-" || format_extension(request.path) == "csv") {
    if (!request.layer.empty() || !request.where.empty())
      return Error{ErrorCode::usage, "--layer and --where are for vector files, not for CSV", "", "leave them out"};
    return read_csv(request.path, context);
  }
  return read_line(request, context);
}

Result<std::vector<ProfileRecord>> read_profile(const std::string& path) {
  Result<CsvTable> table = CsvTable::open(path);
  if (!table) return table.error();
  const Result<ProfileColumns> columns = profile_columns(*table);
  if (!columns) return columns.error();
  std::vector<ProfileRecord> records;
  while (table->next()) {
    Result<ProfileRecord> record = profile_record(*table, *columns);
    if (!record) return record.error();
    records.push_back(*record);
  }
  if (records.empty()) return Error{ErrorCode::input, "has no pieces", "", ""};
  return records;
}

}  // namespace krepl::input
