// OFF as in Geomview's manual: text, with any of the prefixes for texture, colour and normals, whose numbers are
// skipped.
#include <algorithm>

#include "input/mesh_reader.hpp"
#include "input/text_scanner.hpp"

namespace krepl::input {

namespace {

struct Counts {
  std::int64_t vertices = 0, faces = 0;
};

/// Takes the keyword, if there is one, and the counts of vertices and faces.
Result<Counts> read_header(TextScanner& scanner) {
  std::string_view word = scanner.flowing_word();
  if (word.empty()) return scanner.end_error("is empty");
  if (word.ends_with("OFF")) {
    std::string_view prefix = word.substr(0, word.size() - 3);
    for (const std::string_view known : {"ST", "C", "N"})
      if (prefix.starts_with(known)) prefix.remove_prefix(known.size());
    if (!prefix.empty())
      return scanner.error(quoted(word) + " is not read, its points are not in space", "write it as OFF");
    word = scanner.flowing_word();
  } else if (word.front() < '0' || word.front() > '9') {
    return scanner.error(quoted(word) + " instead of OFF", "give a file in the format of its extension");
  }
  if (word == "BINARY") return scanner.error("binary OFF is not read", "write it as text");
  Counts counts;
  Result<std::int64_t> number = scanner.integer(word, "the number of vertices");
  if (!number) return number.error();
  counts.vertices = *number;
  number = scanner.integer(scanner.flowing_word(), "the number of faces");
  if (!number) return number.error();
  counts.faces = *number;
  if (counts.vertices < 0 || counts.faces < 0) return scanner.error("a count is negative");
  return counts;  // the number of edges is of no use, and some leave it out
}

Status read_vertices(TextScanner& scanner, std::int64_t count, PolygonMesh& mesh) {
  for (std::int64_t i = 0; i < count; ++i) {
    if (!scanner.next()) {
      return scanner.end_error("ends after " + std::to_string(i) + " of " + std::to_string(count) + " vertices");
    }
    const Result<Point3> vertex = scanner.point();
    if (!vertex) return vertex.error();
    mesh.vertices.push_back(*vertex);
  }
  return std::monostate{};
}

Status read_faces(TextScanner& scanner, std::int64_t count, PolygonMesh& mesh) {
  for (std::int64_t i = 0; i < count; ++i) {
    if (!scanner.next()) {
      return scanner.end_error("ends after " + std::to_string(i) + " of " + std::to_string(count) + " faces");
    }
    const std::size_t line = scanner.line();
    const Result<std::int64_t> corners = scanner.integer(scanner.word(), "the number of corners");
    if (!corners) return corners.error();
    if (*corners < 0) return scanner.error("the number of corners is negative");
    for (std::int64_t k = 0; k < *corners; ++k) {
      const Result<std::int64_t> v = scanner.integer(scanner.flowing_word(), "a corner");
      if (!v) return v.error();
      mesh.corners.push_back(*v);
    }
    mesh.close_polygon(line);
  }
  return std::monostate{};
}

}  // namespace

Result<PolygonMesh> read_off(std::string_view text, const Context& context) {
  TextScanner scanner(text, {'#', 0}, context);
  const Result<Counts> counts = read_header(scanner);
  if (!counts) return counts.error();
  PolygonMesh mesh;
  // No more than the text can hold, whatever the counts say.
  mesh.vertices.reserve(std::min<std::size_t>(std::size_t(counts->vertices), text.size() / 6));
  mesh.corners.reserve(std::min<std::size_t>(3 * std::size_t(counts->faces), text.size() / 2));
  if (Status read = read_vertices(scanner, counts->vertices, mesh); !read) return read.error();
  if (Status read = read_faces(scanner, counts->faces, mesh); !read) return read.error();
  return mesh;
}

}  // namespace krepl::input
