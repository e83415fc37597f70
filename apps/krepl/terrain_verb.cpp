// krepl terrain: terrain or part (+) ball.
#include <fmt/format.h>

#include <memory>

#include "krepl/incremental.hpp"
#include "krepl/surface.hpp"
#include "output/surface_file.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "terrain/surface_counts.hpp"
#include "terrain_options.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct TerrainVerbOptions {
  TerrainOptions terrain;
  std::string output, radius, format, engine = "auto", max_error, cell, unit;
  int curve_points = 0, width = 0;
  bool solid = false;
};

/// What the options mean once they are checked; made before anything is read.
struct TerrainPlan {
  double radius = 0;
  input::TerrainRequest request;
  output::SurfaceFormat format;
  output::SurfaceFileOptions file;
};

Status check_engine(const std::string& engine) {
  if (engine == "auto" || engine == "incremental") return std::monostate{};
  return Error{ErrorCode::usage, "engine '" + engine + "' is unknown", "", "give --engine auto or incremental"};
}

/// An option that has no meaning for the format would be ignored in silence.
Status check_meaning(const TerrainVerbOptions& options, const output::SurfaceFormat& format) {
  using Kind = output::SurfaceFormat::Kind;
  const auto refuse = [&](const char* option, const char* formats) {
    return Error{ErrorCode::usage, fmt::format("{} has no meaning for format {}", option, format.name), "",
                 fmt::format("it belongs to {}", formats)};
  };
  if (options.engine != "auto" && !format.needs_subdivision())
    return Error{ErrorCode::usage, fmt::format("--engine has no meaning for format {}", format.name), "",
                 "its heights come from the drop cutter; leave --engine out"};
  if (options.curve_points != 0 && format.kind != Kind::json) return refuse("--curve-points", "json");
  if (!options.max_error.empty() && !format.is_mesh() && format.kind != Kind::gpkg)
    return refuse("--max-error", "stl, ply, glb and gpkg");
  if (!options.cell.empty() && format.kind != Kind::tif) return refuse("--cell", "tif");
  if (options.width != 0 && format.kind != Kind::png) return refuse("--width", "png");
  if (options.solid && format.kind != Kind::step) return refuse("--solid", "step");
  if (!options.unit.empty() && format.kind != Kind::step) return refuse("--unit", "step");
  return std::monostate{};
}

Status take_length(const char* option, const std::string& text, double& value) {
  if (text.empty()) return std::monostate{};
  const Result<double> parsed = parse_positive(option, text);
  if (!parsed) return parsed.error();
  value = *parsed;
  return std::monostate{};
}

Result<TerrainPlan> make_plan(const TerrainVerbOptions& options) {
  TerrainPlan plan;
  if (Status engine = check_engine(options.engine); !engine) return engine.error();
  const Result<double> radius = parse_radius(options.radius);
  if (!radius) return radius.error();
  plan.radius = *radius;
  const Result<output::SurfaceFormat> format = output::find_surface_format(options.output, options.format);
  if (!format) return format.error();
  plan.format = *format;
  if (Status meaning = check_meaning(options, plan.format); !meaning) return meaning.error();
  if (Status taken = take_length("--max-error", options.max_error, plan.file.max_error); !taken) return taken.error();
  if (Status taken = take_length("--cell", options.cell, plan.file.cell); !taken) return taken.error();
  if (options.curve_points != 0) plan.file.curve_points = options.curve_points;
  if (options.width != 0) plan.file.width = options.width;
  plan.file.solid = options.solid;
  plan.file.unit = options.unit;
  const Result<input::TerrainRequest> request = terrain_request(options.terrain);
  if (!request) return request.error();
  plan.request = *request;
  return plan;
}

void tell_counters(const Surface& surface, double seconds, Session& session) {
  if (!session.verbose) return;  // counting takes time
  const SurfaceCounters& c = surface.counters();
  session.detail(fmt::format("surface    {:.3f} s: radius {}, {} patches looked at", seconds, surface.radius(), c.patches));
  const terrain::SurfaceCounts faces = terrain::count_surface(surface);
  session.detail(fmt::format("faces      {} of planes, {} of cylinders, {} of spheres", faces.planes, faces.cylinders,
                             faces.spheres));
  if (c.unions > 0) {
    session.detail(fmt::format("unions     {} semi-kreplach added, {} curves looked along", c.unions, c.curves_traced));
    session.detail(
        fmt::format("intersections {} components, {} of them closed; {} unions had several, {} at most, the last one "
                    "{} ({} closed)",
                    c.intersection_components, c.closed_components, c.unions_with_several, c.most_components,
                    c.last_components, c.last_closed));
    return;
  }
  session.detail(fmt::format("cells      {} examined, {} settled, {} of them as small as the coordinates tell", c.cells,
                             c.leaves, c.smallest_cells));
  session.detail(fmt::format("sections   {} along cell sides, {} heights evaluated", c.lines, c.height_evaluations));
}

Result<Surface> compute(const TerrainVerbOptions& options, const TerrainPlan& plan, const input::TerrainFile& file,
                        Session& session) {
  if (options.engine != "incremental")
    return compute_surface(file.terrain, {plan.radius}, session.context("computing"));
  IncrementalOptions incremental;
  incremental.radius = plan.radius;
  return compute_surface_incremental(file.terrain, incremental, session.context("computing"));
}

std::string surface_summary(const Surface& surface) {
  const terrain::SurfaceCounts counts = terrain::count_surface(surface);
  return fmt::format("{} vertices, {} edges ({} seams, {} valleys, {} rims), {} faces", counts.vertices, counts.edges,
                     counts.seams, counts.valleys, counts.rims, counts.faces);
}

std::string summary_line(const Terrain& terrain, const std::string& surface, const output::SurfaceFileReport& report) {
  std::string text = fmt::format("{} triangles", terrain.triangle_count());
  if (!surface.empty()) text += "; " + surface;
  if (report.columns > 0) {
    text += fmt::format("; {} x {} cells", report.columns, report.rows);
    if (report.cells_without_data > 0) text += fmt::format(", {} without data", report.cells_without_data);
  }
  if (!report.faces.empty()) text += "; " + report.faces;
  if (report.triangles > 0) text += fmt::format("; {} triangles written", report.triangles);
  if (report.deviation) text += fmt::format(", within {:.3g}", *report.deviation);
  return text;
}

/// Computes what the format needs, and writes it.
Result<output::SurfaceFileReport> compute_and_write(const TerrainVerbOptions& options, const TerrainPlan& plan,
                                                    const input::TerrainFile& file, std::string& surface_text,
                                                    std::string& failed_file, Session& session) {
  failed_file = output_name(options.output);
  if (!plan.format.needs_subdivision())
    return output::write_heights(options.output, file.terrain, plan.radius, plan.file, session.context("writing"));
  const Stopwatch computing;
  const Result<Surface> surface = compute(options, plan, file, session);
  if (!surface) {
    failed_file = options.terrain.name();
    return surface.error();
  }
  tell_counters(*surface, computing.seconds(), session);
  surface_text = surface_summary(*surface);
  if (const auto warning = output::size_warning(*surface, plan.format)) session.note(failed_file, *warning);
  return output::write_surface(options.output, *surface, plan.format, plan.file, session.context("writing"));
}

int run_terrain(const TerrainVerbOptions& options, Session& session) {
  const Stopwatch total;
  Result<TerrainPlan> plan = make_plan(options);
  if (!plan) return session.fail("", plan.error());
  if (Status target = check_target(options.output, {options.terrain.request.path}); !target)
    return session.fail(options.output, target.error());

  const Result<input::TerrainFile> file = input::read_terrain(plan->request, session.context("reading"));
  if (!file) return session.fail(options.terrain.name(), file.error());
  tell_terrain(*file, options.terrain.name(), total.seconds(), session);
  plan->file.crs = file->crs;

  const Stopwatch computing;
  std::string surface_text, failed_file;
  const auto report = compute_and_write(options, *plan, *file, surface_text, failed_file, session);
  if (!report) return session.fail(failed_file, report.error());
  for (const std::string& note : report->notes) session.note(output_name(options.output), note);
  session.detail(fmt::format("total      {:.3f} s to compute and write", computing.seconds()));
  session.summary(fmt::format("{}; {:.3f} s", summary_line(*file->terrain, surface_text, *report), total.seconds()),
                  options.output == "-");
  return 0;
}

void add_output_options(Verb& verb, TerrainVerbOptions& options) {
  verb.add_option("--format", options.format, "Format of the result, in place of what its extension says")
      .type_name("NAME");
  verb.add_option("--curve-points", options.curve_points, "JSON: points of each edge, ends included (default: 5)")
      .within(3, 1000000).type_name("N");
  verb.add_option("--max-error", options.max_error,
                  "Meshes and GeoPackage: largest deviation from the surface (default: radius / 1000)").type_name("LENGTH");
  verb.add_option("--cell", options.cell,
                  "GeoTIFF: distance of the heights (default: that of the input raster, or extent / 1000)")
      .type_name("LENGTH");
  verb.add_flag("--solid", options.solid, "STEP: a solid, closed by vertical walls and a floor");
  verb.add_option("--unit", options.unit,
                  "STEP: unit of the coordinates (default: that of the coordinate system, else mm)")
      .one_of({"mm", "cm", "m", "km", "in", "ft"})
      .type_name("UNIT");
  verb.add_option("--width", options.width, "PNG: columns of the picture (default: 1600)")
      .within(16, 30000).type_name("N");
  verb.add_option("--engine", options.engine,
                  "Algorithm: auto, or incremental (a second one, to check by, for up to 1000 triangles)")
      .type_name("NAME");
}

}  // namespace

void add_terrain_verb(Verb& program, Session& session) {
  auto options = std::make_shared<TerrainVerbOptions>();
  Verb verb = program.add_verb("terrain", "Surface of a ball's centre over a terrain or part, of true patches");
  add_terrain_options(verb, options->terrain);
  verb.add_option(
          "OUT", options->output,
          "Result: .json .gpkg (subdivision), .step (faces of CAD), .stl .ply .glb (triangles), .tif (heights), "
          ".png (picture), or - (JSON)")
      .required();
  verb.add_option("--radius", options->radius, "Radius of the ball, in the unit of the coordinates")
      .required().type_name("R");
  add_output_options(verb, *options);
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_terrain(*options, session); });
}

}  // namespace krepl::app
