// krepl view of surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "input/geometry_source.hpp"
#include "input/subdivision_file.hpp"
#include "input/terrain_reader.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"
#include "view/surface/shape.hpp"
#include "view/surface/surface_page.hpp"
#include "view_page.hpp"

namespace krepl::app {

namespace {

/// A deviation of a pixel where the radius has 200.
constexpr double pixels_of_radius = 200;

Result<input::SubdivisionGeoPackage> read_surface(const std::string& path, const Context& context) {
  if (input::format_extension(path) == "gpkg") return input::read_subdivision_gpkg(path, context);
  auto file = input::read_subdivision(path, context);
  if (!file) return file.error();
  return input::SubdivisionGeoPackage{std::move(*file), ""};
}

Result<double> max_error(const ViewOptions& options, double radius) {
  if (options.max_error.empty()) return radius / pixels_of_radius;
  return parse_positive("--max-error", options.max_error);
}

Result<input::TerrainFile> read_input(const ViewOptions& options, const std::string& crs, Session& session) {
  TerrainOptions terrain = options.terrain;
  terrain.request.path = options.input.path;
  terrain.request.to_crs = options.input.to_crs;
  auto request = terrain_request(terrain);
  if (!request) return request.error();
  auto file = input::read_terrain(*request, session.context("reading"));
  // Degrees are projected to where the result lies.
  if (!file && request->to_crs.empty() && !crs.empty()) {
    request->to_crs = code_in(crs);
    auto projected = input::read_terrain(*request, session.context("reading"));
    if (projected) file = std::move(projected);
  }
  session.finish_progress();
  return file;
}

/// Whether two shapes have nothing in common, seen from above.
bool lie_apart(const view::Shape& a, const view::Shape& b) {
  const auto range = [](const view::Shape& shape, double Point3::*axis) {
    const auto [low, high] = std::minmax_element(shape.vertices.begin(), shape.vertices.end(),
                                                 [&](const Point3& p, const Point3& q) { return p.*axis < q.*axis; });
    return std::pair{(*low).*axis, (*high).*axis};
  };
  for (double Point3::*axis : {&Point3::x, &Point3::y}) {
    const auto p = range(a, axis), q = range(b, axis);
    if (p.first > q.second || q.first > p.second) return true;
  }
  return false;
}

}  // namespace

bool is_surface(const std::string& path) {
  const std::string extension = input::format_extension(path);
  if (extension == "json") return input::looks_like_subdivision(path);
  return extension == "gpkg" && input::is_subdivision_gpkg(path);
}

int run_surface_view(const ViewOptions& options, Session& session) {
  if (!options.input.layer.empty() || !options.input.where.empty())
    return session.fail(
        "", {ErrorCode::usage, "--layer and --where belong to zones", "", "a terrain has no features to choose"});
  Stopwatch watch;
  const auto lap = [&watch] { return std::exchange(watch, Stopwatch()).seconds(); };
  auto result = read_surface(options.result, session.context("reading"));
  if (!result) return session.fail(options.result, result.error());
  session.finish_progress();
  session.detail(fmt::format("read       {:.3f} s: {} faces", lap(), result->file.faces.size()));

  view::SurfacePageData page;
  const auto error = max_error(options, result->file.radius);
  if (!error) return session.fail("", error.error());
  page.max_error = *error;
  page.title = page_title(options);
  page.crs = result->crs;
  auto shape = view::surface_shape(result->file, page.max_error, session.context("patches"));
  if (!shape) return session.fail(options.result, shape.error());
  session.finish_progress();
  page.surface = std::move(*shape);
  const std::size_t faces = result->file.faces.size(), triangles = page.surface.triangles.size();
  session.detail(fmt::format("patches    {:.3f} s: {} triangles", lap(), triangles));
  *result = {};

  if (!options.input.path.empty()) {
    auto terrain = read_input(options, page.crs, session);
    if (!terrain) return session.fail(options.input.path, terrain.error());
    tell_terrain(*terrain, options.input.path, lap(), session);
    if (page.crs.empty()) page.crs = terrain->crs_name;
    page.terrain = view::terrain_shape(*terrain->terrain, page.surface.origin);
    if (lie_apart(page.surface, *page.terrain))
      session.note(options.input.path,
                   "note: lies beside the surface; give --to-crs as for krepl terrain, if it was given there");
  }
  page.unit = unit_of(page.crs);
  const auto html = view::render_surface_page(page, session.context("page"));
  if (!html) return session.fail(options.result, html.error());
  session.finish_progress();
  session.detail(fmt::format("page       {:.3f} s: {} tiles", lap(), html->tiles));
  return write_page(options, html->html,
                    fmt::format("{} faces, {} triangles in {} tiles", faces - 1, triangles, html->tiles), session);
}

}  // namespace krepl::app
