// STL, binary and text. Normals and attributes are skipped: the triangles say all that counts.
#include <bit>
#include <cmath>

#include "input/mesh_reader.hpp"
#include "input/text_scanner.hpp"

namespace krepl::input {

namespace {

constexpr std::size_t header_size = 84, record_size = 50;

std::uint32_t little_endian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

double single_precision(const char* bytes) { return double(std::bit_cast<float>(little_endian(bytes))); }

/// Many binary files begin with "solid" too; a size that fits the count says more.
bool is_binary(std::string_view text) {
  if (text.size() >= header_size &&
      text.size() == header_size + record_size * std::uint64_t{little_endian(text.data() + 80)})
    return true;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || lower_case(text.substr(first, 5)) != "solid") return true;
  return text.substr(0, 1024).find('\0') != std::string_view::npos;
}

Result<PolygonMesh> read_binary(std::string_view text, const Context& context) {
  const std::string cut_off = "the file seems to be cut off: get it again";
  if (text.size() < header_size) return Error{ErrorCode::input, "is too short for STL", "", cut_off};
  const std::uint64_t count = little_endian(text.data() + 80), held = (text.size() - header_size) / record_size;
  if (count > held) {
    return Error{ErrorCode::input, "ends after " + std::to_string(held) + " of " + std::to_string(count) + " triangles",
                 "", cut_off};
  }
  PolygonMesh mesh;
  mesh.place_name = "triangle";
  mesh.vertices.reserve(3 * count);
  mesh.corners.reserve(3 * count);
  for (std::uint64_t t = 0; t < count; ++t) {
    if (t % 65536 == 0 && context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    const char* record = text.data() + header_size + record_size * t + 12;
    for (int k = 0; k < 3; ++k, record += 12) {
      const Point3 p{single_precision(record), single_precision(record + 4), single_precision(record + 8)};
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        return Error{ErrorCode::input, "a coordinate is not finite", "triangle " + std::to_string(t),
                     "repair the mesh"};
      }
      mesh.corners.push_back(std::int64_t(mesh.vertices.size()));
      mesh.vertices.push_back(p);
    }
    mesh.close_polygon(t);
  }
  if (text.size() > header_size + record_size * count)
    mesh.notes.emplace_back("note: bytes after the last triangle ignored");
  return mesh;
}

Status read_vertex(TextScanner& scanner, PolygonMesh& mesh) {
  const Result<Point3> vertex = scanner.point();
  if (!vertex) return vertex.error();
  mesh.corners.push_back(std::int64_t(mesh.vertices.size()));
  mesh.vertices.push_back(*vertex);
  return std::monostate{};
}

Result<PolygonMesh> read_text(std::string_view text, const Context& context) {
  TextScanner scanner(text, {}, context);
  PolygonMesh mesh;
  bool in_solid = false, in_facet = false;
  while (scanner.next()) {
    const std::string keyword = lower_case(scanner.word());
    if (keyword == "vertex" && in_facet) {
      if (Status read = read_vertex(scanner, mesh); !read) return read.error();
    } else if (keyword == "facet" && in_solid && !in_facet) {
      in_facet = true;
    } else if (keyword == "endfacet" && in_facet) {
      if (mesh.corners.size() - mesh.begin.back() != 3) return scanner.error("a facet has not three vertices");
      mesh.close_polygon(scanner.line());
      in_facet = false;
    } else if (keyword == "solid" && !in_solid) {
      in_solid = true;
    } else if (keyword == "endsolid" && in_solid && !in_facet) {
      in_solid = false;
    } else if (!in_facet || (keyword != "outer" && keyword != "endloop")) {
      return scanner.error(quoted(keyword) + " is out of place");
    }
  }
  if (in_solid || scanner.cancelled()) return scanner.end_error("ends before its endsolid");
  return mesh;
}

}  // namespace

Result<PolygonMesh> read_stl(std::string_view text, const Context& context) {
  return is_binary(text) ? read_binary(text, context) : read_text(text, context);
}

}  // namespace krepl::input
