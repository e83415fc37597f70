#include "input/mesh_reader.hpp"

namespace krepl::input {

namespace {

Result<PolygonMesh> read_polygons(std::string_view text, MeshFormat format, const Context& context) {
  switch (format) {
    case MeshFormat::off:
      return read_off(text, context);
    case MeshFormat::obj:
      return read_obj(text, context);
    case MeshFormat::ply:
      return read_ply(text, context);
    case MeshFormat::stl:
      break;
  }
  return read_stl(text, context);
}

}  // namespace

Result<TriangleMesh> read_mesh(std::string_view text, MeshFormat format, const Context& context) {
  Result<PolygonMesh> polygons = read_polygons(text, format, context);
  if (!polygons) return polygons.error();
  return cut_into_triangles(std::move(*polygons), context);
}

}  // namespace krepl::input
