// What all verbs that read a terrain have in common.
#include "terrain_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "verbs.hpp"

namespace krepl::app {

namespace {

Result<double> parse_scale(const std::string& text) {
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || value == 0) {
    return Error{ErrorCode::usage, "--z-scale '" + text + "' is not a finite number other than zero", "", ""};
  }
  return value;
}

Result<Terrain::Split> parse_split(const std::string& text) {
  if (text == "rising") return Terrain::Split::rising;
  if (text == "falling") return Terrain::Split::falling;
  if (text == "shorter") return Terrain::Split::shorter;
  return Error{ErrorCode::usage, "--split '" + text + "' is unknown", "", "give rising, falling or shorter"};
}

Result<input::Axis> parse_axis(const std::string& text) {
  using input::Axis;
  for (const auto& [name, axis] : {std::pair{"x", Axis::x}, std::pair{"y", Axis::y}, std::pair{"z", Axis::z},
                                   std::pair{"-x", Axis::minus_x}, std::pair{"-y", Axis::minus_y}, std::pair{"-z", Axis::minus_z}})
    if (text == name) return axis;
  return Error{ErrorCode::usage, "--up '" + text + "' is unknown", "", "give x, y, z, -x, -y or -z (as --up=-x)"};
}

}  // namespace

const char* TerrainOptions::given_reading_option() const {
  if (!z_scale.empty()) return "--z-scale";
  if (!split.empty()) return "--split";
  if (request.band != 0) return "--band";
  return up.empty() ? nullptr : "--up";
}

std::string TerrainOptions::name() const { return input_name(request.path); }

void add_terrain_options(Verb& verb, TerrainOptions& options, const std::string& name) {
  Option in = verb.add_option(name, options.request.path,
                              "Terrain or part: any GDAL raster, .stl .obj .ply .off, .gz of them, or -")
                  .required();
  if (name != "IN") in.type_name("IN");
  verb.add_option("--crs", options.request.crs, "Coordinate system of the data, in place of what the file says")
      .type_name("EPSG:n");
  verb.add_option("--to-crs", options.request.to_crs,
                  "Raster: plane coordinate system to resample the heights to; auto chooses one")
      .type_name("EPSG:n|auto");
  add_reading_options(verb, options);
}

void add_reading_options(Verb& verb, TerrainOptions& options, const std::string& where) {
  const std::string raster = where.empty() ? "Raster" : where;
  const std::string heights = where.empty() ? "Multiply heights" : where + ": multiply heights";
  verb.add_option("--z-scale", options.z_scale, heights + " by this number (default: 1)").type_name("FACTOR");
  verb.add_option("--split", options.split, raster + ": diagonal that splits a cell: rising (default), falling, shorter")
      .type_name("NAME");
  verb.add_option("--band", options.request.band, raster + ": band to read (default: 1)").type_name("N").positive();
  verb.add_option("--up", options.up, (where.empty() ? "Mesh" : where) + ": its axis that points upwards, x, y, z (default), -x, -y, -z")
      .type_name("AXIS");
}

Error for_terrains_only(const char* option) {
  return {ErrorCode::usage, std::string(option) + " is for terrains, but IN is neither a raster nor a mesh", "", "leave it out"};
}

Result<input::TerrainRequest> terrain_request(const TerrainOptions& options) {
  input::TerrainRequest request = options.request;
  if (!options.z_scale.empty()) {
    const Result<double> scale = parse_scale(options.z_scale);
    if (!scale) return scale.error();
    request.z_scale = *scale;
  }
  if (!options.split.empty()) {
    const Result<Terrain::Split> split = parse_split(options.split);
    if (!split) return split.error();
    request.split = *split;
  }
  if (!options.up.empty()) {
    const Result<input::Axis> up = parse_axis(options.up);
    if (!up) return up.error();
    request.up = *up;
  }
  return request;
}

void tell_terrain(const input::TerrainFile& file, const std::string& name, double seconds, Session& session) {
  for (const std::string& note : file.notes) session.note(name, note);
  const Terrain& terrain = *file.terrain;
  const Terrain::Report& report = terrain.report();
  if (terrain.is_grid()) {
    session.detail(fmt::format("read       {:.3f} s: {} x {} samples ({} without data), {} triangles", seconds,
                               terrain.grid().columns, terrain.grid().rows, report.missing_samples,
                               terrain.triangle_count()));
    return;
  }
  session.detail(fmt::format("read       {:.3f} s: {} triangles, {} kept ({} vertical)", seconds, report.triangles,
                             terrain.triangle_count(), report.vertical_triangles));
  session.detail(
      fmt::format("cleaning   {} coinciding vertices welded, {} triangles without area and {} repeated ones dropped",
                  report.welded_vertices, report.zero_area_triangles, report.repeated_triangles));
  session.detail(fmt::format("edges      {} at the border, {} of three triangles or more", report.border_edges,
                             report.non_manifold_edges));
}

}  // namespace krepl::app
