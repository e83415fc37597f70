// Wavefront OBJ: vertices and faces. Groups, materials, normals, lines and points have no part in a terrain; curved
// surfaces cannot be read and are noted.
#include "input/mesh_reader.hpp"
#include "input/text_scanner.hpp"

namespace krepl::input {

namespace {

Status read_vertex(TextScanner& scanner, PolygonMesh& mesh) {
  const Result<Point3> vertex = scanner.point();
  if (!vertex) return vertex.error();
  mesh.vertices.push_back(*vertex);
  return std::monostate{};
}

/// A corner is VERTEX, VERTEX/TEXTURE, VERTEX//NORMAL or VERTEX/TEXTURE/NORMAL, each counted from 1, or back from -1.
Status read_face(TextScanner& scanner, PolygonMesh& mesh) {
  const std::size_t line = scanner.line();
  for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word()) {
    const Result<std::int64_t> v = scanner.integer(word.substr(0, word.find('/')), "a corner");
    if (!v) return v.error();
    if (*v == 0) return scanner.error("a face has corner 0, and vertices are counted from 1");
    if (*v < 0 && std::uint64_t(-(*v + 1)) >= mesh.vertices.size()) {
      return scanner.error("a face has a vertex that does not exist");
    }
    mesh.corners.push_back(*v > 0 ? *v - 1 : std::int64_t(mesh.vertices.size()) + *v);
  }
  mesh.close_polygon(line);
  return std::monostate{};
}

}  // namespace

Result<PolygonMesh> read_obj(std::string_view text, const Context& context) {
  TextScanner scanner(text, {'#', '\\'}, context);
  PolygonMesh mesh;
  std::size_t surfaces = 0;
  while (scanner.next()) {
    const std::string_view keyword = scanner.word();
    Status read = std::monostate{};
    if (keyword == "v")
      read = read_vertex(scanner, mesh);
    else if (keyword == "f" || keyword == "fo")
      read = read_face(scanner, mesh);
    else if (keyword == "surf")
      ++surfaces;
    if (!read) return read.error();
  }
  if (scanner.cancelled()) return scanner.end_error("");
  if (surfaces > 0) mesh.notes.push_back("note: " + std::to_string(surfaces) + " curved surfaces left out");
  return mesh;
}

}  // namespace krepl::input
