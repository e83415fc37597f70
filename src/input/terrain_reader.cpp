#include "input/terrain_reader.hpp"

#include <cmath>
#include <string_view>

#include "input/geometry_source.hpp"
#include "input/memory_file.hpp"
#include "input/mesh_reader.hpp"
#include "input/projection.hpp"
#include "input/raster_reader.hpp"
#include "input/text_scanner.hpp"
#include "input/whole_file.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

std::optional<MeshFormat> mesh_format(std::string_view extension) {
  if (extension == "off") return MeshFormat::off;
  if (extension == "obj") return MeshFormat::obj;
  if (extension == "ply") return MeshFormat::ply;
  if (extension == "stl") return MeshFormat::stl;
  return std::nullopt;
}

/// What a text without a name is, by its first word; nothing if it is no mesh.
std::optional<MeshFormat> recognised(std::string_view text) {
  const Context context;
  TextScanner scanner(text.substr(0, 4096), {'#', 0}, context);
  if (!scanner.next()) return std::nullopt;
  const std::string_view word = scanner.word();
  if (word.ends_with("OFF")) return MeshFormat::off;
  if (word == "ply") return MeshFormat::ply;
  if (lower_case(word) == "solid") return MeshFormat::stl;
  for (const std::string_view keyword : {"v", "vn", "vt", "o", "g", "mtllib"})
    if (word == keyword) return MeshFormat::obj;
  return std::nullopt;
}

Status check_request(const TerrainRequest& request, bool mesh) {
  if (!std::isfinite(request.z_scale) || request.z_scale == 0) {
    return Error{ErrorCode::usage, "the factor of the heights is not a finite number other than zero", "", ""};
  }
  if (!mesh && request.up != Axis::z)
    return Error{ErrorCode::usage, "--up is for meshes, not for rasters", "", "leave it out"};
  if (!mesh) return std::monostate{};
  const char* option = request.split             ? "--split"
                       : request.band != 0       ? "--band"
                       : !request.to_crs.empty() ? "--to-crs"
                                                 : nullptr;
  if (option == nullptr) return std::monostate{};
  return Error{ErrorCode::usage, std::string(option) + " is for rasters, not for meshes", "", "leave it out"};
}

/// By a quarter or half turn. Subtracting from zero makes no negative zeros.
Point3 turned(Point3 p, Axis up) {
  switch (up) {
    case Axis::x: return {0 - p.z, p.y, p.x};
    case Axis::y: return {p.x, 0 - p.z, p.y};
    case Axis::minus_x: return {p.z, p.y, 0 - p.x};
    case Axis::minus_y: return {p.x, p.z, 0 - p.y};
    case Axis::minus_z: return {p.x, 0 - p.y, 0 - p.z};
    case Axis::z: break;
  }
  return p;
}

/// A mesh is in a plane of unknown place unless --crs names one, which must not be in degrees.
Result<std::optional<OGRSpatialReference>> crs_of_mesh(const std::string& given) {
  std::optional<OGRSpatialReference> crs;
  if (given.empty()) return crs;
  Result<OGRSpatialReference> parsed = ogr::parse_crs(given);
  if (!parsed) return parsed.error();
  if (parsed->IsGeographic() != 0 || parsed->IsGeocentric() != 0) {
    return Error{ErrorCode::input, "coordinates are in degrees (" + ogr::crs_name(*parsed) + "), not in a plane", "",
                 "project the mesh first"};
  }
  crs = *parsed;
  return crs;
}

Result<TerrainFile> finish(Result<Terrain> terrain, const std::optional<OGRSpatialReference>& crs,
                           std::vector<std::string> notes) {
  if (!terrain) return terrain.error();
  TerrainFile file;
  file.terrain = std::make_shared<const Terrain>(std::move(*terrain));
  file.notes = std::move(notes);
  if (crs) file.crs = ogr::crs_definition(*crs), file.crs_name = ogr::crs_name(*crs);
  return file;
}

Result<TerrainFile> from_mesh(std::vector<char> text, MeshFormat format, const TerrainRequest& request,
                              const Context& context) {
  if (Status checked = check_request(request, true); !checked) return checked.error();
  const auto crs = crs_of_mesh(request.crs);
  if (!crs) return crs.error();
  Result<TriangleMesh> mesh = read_mesh({text.data(), text.size()}, format, context);
  if (!mesh) return mesh.error();
  text = {};
  if (request.up != Axis::z)
    for (Point3& p : mesh->vertices) p = turned(p, request.up);
  if (request.z_scale != 1)
    for (Point3& p : mesh->vertices) p.z *= request.z_scale;
  return finish(Terrain::from_triangles(std::move(mesh->vertices), std::move(mesh->triangles), context), *crs,
                std::move(mesh->notes));
}

Result<TerrainFile> from_raster(const std::string& vsi_path, const TerrainRequest& request, const Context& context) {
  if (Status checked = check_request(request, false); !checked) return checked.error();
  Result<RasterData> raster = read_raster(vsi_path, request, context);
  if (!raster) return raster.error();
  raster->grid.split = request.split.value_or(Terrain::Split::rising);
  return finish(Terrain::from_grid(raster->grid, std::move(raster->heights), context), raster->crs,
                std::move(raster->notes));
}

Result<TerrainFile> from_stream(const TerrainRequest& request, const Context& context) {
  Result<std::vector<char>> text = read_whole_file(request.path, context);
  if (!text) return text.error();
  if (text->empty()) return Error{ErrorCode::input, "is empty", "", "give a raster or mesh as text"};
  if (const auto format = recognised({text->data(), text->size()}))
    return from_mesh(std::move(*text), *format, request, context);
  ogr::initialise();
  const MemoryFile file(std::move(*text), "txt");
  return from_raster(file.path(), request, context);
}

}  // namespace

bool is_mesh_extension(const std::string& extension) { return mesh_format(extension).has_value(); }

Result<TerrainFile> read_terrain(const TerrainRequest& request, const Context& context) {
  if (is_stream(request.path)) return from_stream(request, context);
  const auto format = mesh_format(format_extension(request.path));
  if (format) {
    Result<std::vector<char>> text = read_whole_file(request.path, context);
    if (!text) return text.error();
    return from_mesh(std::move(*text), *format, request, context);
  }
  const Result<std::string> vsi_path = checked_path(request.path);
  if (!vsi_path) return vsi_path.error();
  return from_raster(*vsi_path, request, context);
}

}  // namespace krepl::input
