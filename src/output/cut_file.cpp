#include "output/cut_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "output/cut_lines.hpp"
#include "output/output_stream.hpp"

namespace krepl::output {

namespace {

bool is_csv(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return name == "csv";
}

Result<CutFileReport> write(const std::string& path, const CutDrawing& drawing, const CutFormat& format,
                            const Context& context) {
  using Kind = ZoneFormat::Kind;
  CutFileReport report;
  Status written = std::monostate{};
  if (format.csv)
    written = write_cut_csv(path, drawing, context);
  else if (format.vector.kind == Kind::svg)
    written = write_cut_svg(path, drawing, report, context);
  else if (format.vector.kind == Kind::dxf)
    written = write_cut_dxf(path, drawing, report, context);
  else if (format.vector.kind == Kind::wkt)
    written = write_cut_wkt(path, drawing, report, context);
  else
    written = write_cut_layer(path, format.vector.kind == Kind::geojson ? "GeoJSON" : format.vector.driver, drawing,
                              report, context);
  if (!written) return written.error();
  return report;
}

}  // namespace

Result<CutFormat> find_cut_format(const std::string& path, const std::string& asked) {
  const std::size_t dot = path.rfind('.');
  if (asked.empty() ? path == "-" || (dot != std::string::npos && is_csv(path.substr(dot + 1))) : is_csv(asked)) {
    CutFormat format;
    format.csv = true;
    format.vector.name = "csv";
    return format;
  }
  const Result<ZoneFormat> vector = find_zone_format(path, asked);
  if (!vector)
    return Error{vector.error().code, vector.error().what, vector.error().where,
                 "choose csv, gpkg, fgb, wkt, geojson, shp, svg, dxf or the name of a GDAL vector driver"};
  if (vector->kind == ZoneFormat::Kind::wkb)
    return Error{ErrorCode::usage, "lines cannot go to format wkb", "",
                 "choose csv, gpkg, fgb, wkt, geojson, shp, svg or dxf"};
  return CutFormat{false, *vector};
}

Result<CutFileReport> write_contours(const std::string& path, std::span<const Contour> contours, const Terrain& terrain,
                                     const CutFormat& format, const CutFileOptions& options, const Context& context) {
  CutDrawing drawing;
  drawing.of_contours = true;
  drawing.origin = terrain.origin();
  drawing.terrain = &terrain;
  drawing.options = options;
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const Contour& contour = contours[c];
    for (std::size_t r = 0; r < contour.ring_count(); ++r) {
      const std::ptrdiff_t parent =
          contour.ring_parent[r] == Contour::none ? -1 : std::ptrdiff_t(contour.ring_parent[r]);
      drawing.lines.push_back(
          {c, r, contour.level + terrain.origin().z, true, contour.ring_is_hole[r], parent, contour.ring(r)});
    }
  }
  return write(path, drawing, format, context);
}

Result<CutFileReport> write_sections(const std::string& path, std::span<const Section> sections, const Terrain& terrain,
                                     const CutFormat& format, const CutFileOptions& options, const Context& context) {
  CutDrawing drawing;
  drawing.origin = terrain.origin();
  drawing.terrain = &terrain;
  drawing.sections = sections;
  drawing.options = options;
  for (std::size_t s = 0; s < sections.size(); ++s) {
    for (std::size_t c = 0; c < sections[s].chain_count(); ++c)
      drawing.lines.push_back({s, c, 0, false, false, -1, sections[s].chain(c)});
  }
  return write(path, drawing, format, context);
}

PlanePiece in_plane(const CutDrawing& drawing, const CutLine& line, const CutPiece& piece) {
  const auto map = [&](auto&& along) {
    return PlanePiece{piece.kind,
                      along(piece.start, true),
                      along(piece.end, true),
                      along(piece.centre, true),
                      {along(piece.axis[0], false), along(piece.axis[1], false)},
                      piece.from,
                      piece.to};
  };
  if (drawing.of_contours) return map([](Point3 p, bool) { return Point{p.x, p.y}; });
  const Section& section = drawing.sections[line.cut];
  const double dx = section.to.x - section.from.x, dy = section.to.y - section.from.y, length = std::hypot(dx, dy);
  return map([&](Point3 p, bool is_place) {
    const double x = is_place ? p.x - section.from.x : p.x, y = is_place ? p.y - section.from.y : p.y;
    return Point{(x * dx + y * dy) / length, p.z};
  });
}

EllipseAxes main_axes(const PlanePiece& piece) {
  const Point a = piece.axis[0], b = piece.axis[1];
  // Where the squared distance from the centre is greatest.
  const double t = std::atan2(2 * (a.x * b.x + a.y * b.y), a.x * a.x + a.y * a.y - b.x * b.x - b.y * b.y) / 2;
  const Point p{std::cos(t) * a.x + std::sin(t) * b.x, std::cos(t) * a.y + std::sin(t) * b.y};
  const double longer = std::hypot(p.x, p.y);
  return {longer, longer > 0 ? std::abs(a.x * b.y - a.y * b.x) / longer : 0, std::atan2(p.y, p.x)};
}

std::vector<Point> plane_points(const CutDrawing& drawing, const CutLine& line, const CutPiece& piece) {
  std::vector<Point3> points;
  piece.append_points(drawing.options.max_error, points);
  std::vector<Point> result;
  CutPiece one;
  for (const Point3 p : points) {
    one.end = p;
    result.push_back(in_plane(drawing, line, one).end);
  }
  return result;
}

}  // namespace krepl::output
