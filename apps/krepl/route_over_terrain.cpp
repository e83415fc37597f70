// krepl route over rasters and meshes.
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "krepl/terrain_route.hpp"
#include "ogr/message_capture.hpp"
#include "output/terrain_route_file.hpp"
#include "output_target.hpp"
#include "route_options.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct Plan {
  input::TerrainRequest request;
  double radius = 0;
  TerrainRouteOptions route;
  output::RouteFormat format;
};

Status read_ends(const RouteVerbOptions& options, TerrainRouteOptions& route) {
  for (const auto& [name, text, end] :
       {std::tuple{"--from", &options.from, &route.from}, std::tuple{"--to", &options.to, &route.to}}) {
    const Result<std::vector<double>> numbers = parse_place(name, *text);
    if (!numbers) return numbers.error();
    end->place = {(*numbers)[0], (*numbers)[1]};
    if (numbers->size() == 3) end->height = (*numbers)[2];
  }
  return std::monostate{};
}

Status read_limits(const RouteVerbOptions& options, TerrainRouteOptions& route) {
  if (!options.ceiling.empty()) {
    const std::string& text = options.ceiling;
    const auto [last, status] = std::from_chars(text.data(), text.data() + text.size(), route.ceiling);
    if (status != std::errc{} || last != text.data() + text.size() || !std::isfinite(route.ceiling))
      return Error{ErrorCode::usage, "--ceiling '" + text + "' is not a finite number", "",
                   "give a height in the unit of the terrain"};
  }
  for (const auto& [name, text, value] : {std::tuple{"--max-slope", &options.max_slope, &route.max_slope},
                                          std::tuple{"--step", &options.step, &route.step}}) {
    if (text->empty()) continue;
    const Result<double> number = parse_positive(name, *text);
    if (!number) return number.error();
    *value = *number;
  }
  if (options.minimise == "climb") route.minimise = TerrainRouteOptions::Minimise::climb;
  if (!options.minimise.empty() && options.minimise != "climb" && options.minimise != "length")
    return Error{ErrorCode::usage, "--minimise '" + options.minimise + "' is unknown", "", "give length or climb"};
  return std::monostate{};
}

Result<Plan> make_plan(const RouteVerbOptions& options) {
  for (const auto& [name, text] :
       {std::pair{"--prefer", &options.prefer}, std::pair{"--layer", &options.input.layer},
        std::pair{"--where", &options.input.where}, std::pair{"--max-error", &options.max_error}})
    if (!text->empty())
      return Error{ErrorCode::usage, fmt::format("{} is for lines, polygons and points, but IN is a terrain", name), "",
                   "leave it out"};
  Plan plan;
  const Result<double> radius = parse_radius(options.radius);
  if (!radius) return radius.error();
  plan.radius = *radius;
  TerrainOptions terrain = options.terrain;
  terrain.request.path = options.input.path;
  terrain.request.crs = options.input.crs, terrain.request.to_crs = options.input.to_crs;
  Result<input::TerrainRequest> request = terrain_request(terrain);
  if (!request) return request.error();
  plan.request = *request;
  if (Status read = read_ends(options, plan.route); !read) return read.error();
  if (Status read = read_limits(options, plan.route); !read) return read.error();
  Result<output::RouteFormat> format = output::find_route_format(options.output, options.format);
  if (!format)
    return Error{format.error().code, options.output + ": " + format.error().what, "", format.error().remedy};
  plan.format = *format;
  return plan;
}

output::TerrainPicture picture_of(const DropCutter& cutter) {
  const Terrain& terrain = cutter.terrain();
  const Point3 origin = terrain.origin(), low = terrain.lowest(), high = terrain.highest();
  return {[&cutter, origin](Point p) {
            return cutter.at({p.x - origin.x, p.y - origin.y}).height + origin.z;
          },
          {low.x + origin.x, low.y + origin.y},
          {high.x + origin.x, high.y + origin.y}};
}

}  // namespace

bool is_terrain(const std::string& path) {
  std::filesystem::path name(path);
  const bool packed = name.extension() == ".gz";
  if (packed) name.replace_extension();
  std::string extension = name.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (!extension.empty() && input::is_mesh_extension(extension.substr(1))) return true;
  if (path == "-") return false;
  ogr::initialise();
  const ogr::MessageCapture messages;
  const std::string file = (packed ? "/vsigzip/" : "") + path;
  return GDALIdentifyDriverEx(file.c_str(), GDAL_OF_VECTOR, nullptr, nullptr) == nullptr &&
         GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr;
}

int run_terrain_route(const RouteVerbOptions& options, Session& session) {
  const Stopwatch total;
  const Result<Plan> plan = make_plan(options);
  if (!plan) return session.fail("", plan.error());
  if (Status target = check_target(options.output, {options.input.path}); !target)
    return session.fail(options.output, target.error());
  const std::string in_name = input_name(options.input.path), out_name = output_name(options.output);
  const Result<input::TerrainFile> file = input::read_terrain(plan->request, session.context("reading"));
  if (!file) return session.fail(in_name, file.error());
  tell_terrain(*file, in_name, total.seconds(), session);
  const Result<DropCutter> cutter = DropCutter::build(file->terrain, plan->radius, session.context("indexing"));
  if (!cutter) return session.fail(in_name, cutter.error());

  const Stopwatch searching;
  const Result<TerrainRoute> route = compute_terrain_route(*cutter, plan->route, session.context("searching"));
  if (!route) return session.fail(in_name, route.error());
  const TerrainRoute::Counters& c = route->counters;
  session.detail(
      fmt::format("search     {:.3f} s: lattice of {} places and {} levels, {} nodes visited; length there {:.10g}",
                  searching.seconds(), c.places, c.levels, c.visited, route->lattice_length));
  session.detail(fmt::format("proofs     {} stretches, {} lowered balls", c.proofs, c.drops));
  const auto report = output::write_terrain_route(options.output, *route, picture_of(*cutter), plan->format, file->crs,
                                                  session.context("writing"));
  if (!report) return session.fail(out_name, report.error());
  for (const std::string& note : report->notes) session.note(out_name, note);
  session.summary(
      fmt::format("length {:.10g}, climb {:.10g}, steepest {:.4g}, clearance {:.10g} proven; {} points; {:.3f} s",
                  route->length, route->climb, route->steepest, route->clearance, route->points.size(),
                  total.seconds()),
      options.output == "-");
  return 0;
}

}  // namespace krepl::app
