// Binary STL: triangles of float coordinates.
#include <cmath>

#include "output/surface_mesh_file.hpp"

namespace krepl::output {

namespace {

using Corner = std::array<float, 3>;

/// Of the corners before they are rounded: of a small triangle little may be left by that.
Corner unit_normal(Point3 a, Point3 b, Point3 c) {
  const double u[] = {b.x - a.x, b.y - a.y, b.z - a.z};
  const double v[] = {c.x - a.x, c.y - a.y, c.z - a.z};
  const double n[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  if (!(length > 0)) return {0, 0, 0};  // readers compute it themselves
  return {float(n[0] / length), float(n[1] / length), float(n[2] / length)};
}

Status put_triangles(OutputStream& stream, const SurfaceMesh& mesh, double max_error, const Context& context,
                     SurfaceFileReport& report) {
  const Surface& surface = mesh.surface();
  if (mesh.triangle_count() > 0xffffffffu) {
    return Error{ErrorCode::io, "STL holds 2^32 triangles at most", "", "give a larger --max-error"};
  }
  const Point3 origin = surface.terrain().origin();
  const Point3 off = float_origin(surface, max_error);
  std::string header = "krepl surface";
  if (!(off == Point3{})) {
    header = fmt::format("krepl surface, moved by {} {} {}", -off.x, -off.y, -off.z);
    report.notes.push_back(
        fmt::format("note: coordinates are relative to {} {} {}: STL has single precision only", off.x, off.y, off.z));
  }
  header.resize(80, ' ');
  stream.write(header);
  fmt::memory_buffer count;
  put_binary(count, std::uint32_t(mesh.triangle_count()));
  stream.write({count.data(), count.size()});
  const auto corner = [&](Point3 p) -> Corner {
    return {float(p.x + (origin.x - off.x)), float(p.y + (origin.y - off.y)), float(p.z + (origin.z - off.z))};
  };
  const auto put_face = [&](fmt::memory_buffer& bytes, const SurfaceMesh::Face& face) {
    const PatchMesh& triangles = face.triangles;
    for (std::size_t t = 0; t < triangles.triangle_count(); ++t) {
      const auto [i, j, k] = triangles.triangle(t);
      const Point3 a = triangles.points()[i], b = triangles.points()[j], c = triangles.points()[k];
      for (const Corner& values : {unit_normal(a, b, c), corner(a), corner(b), corner(c)}) put_binary(bytes, values);
      put_binary(bytes, std::uint16_t{0});
    }
  };
  const std::uint64_t size = 50 * mesh.triangle_count();
  return write_sections(stream, {&size, 1}, mesh.block_count(), context,
                        [&](std::span<fmt::memory_buffer> bytes, std::size_t b) {
                          mesh.visit(b, context, [&](const SurfaceMesh::Face& face) { put_face(bytes[0], face); });
                        });
}

}  // namespace

SurfaceWriteResult write_surface_stl(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                     const Context& context) {
  const double max_error = surface_max_error(options, surface.radius());
  const auto put = [&](OutputStream& stream, const SurfaceMesh& mesh, SurfaceFileReport& report) {
    return put_triangles(stream, mesh, max_error, context, report);
  };
  return write_mesh(path, surface, options, context, put);
}

}  // namespace krepl::output
