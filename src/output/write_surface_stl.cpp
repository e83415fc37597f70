// Binary STL: triangles of float coordinates.
#include <cmath>

#include "output/surface_mesh_file.hpp"

namespace krepl::output {

namespace {

using Corner = std::array<float, 3>;

Corner unit_normal(const Corner& a, const Corner& b, const Corner& c) {
  const double u[] = {double(b[0]) - a[0], double(b[1]) - a[1], double(b[2]) - a[2]};
  const double v[] = {double(c[0]) - a[0], double(c[1]) - a[1], double(c[2]) - a[2]};
  const double n[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  if (!(length > 0)) return {0, 0, 0};  // readers compute it themselves
  return {float(n[0] / length), float(n[1] / length), float(n[2] / length)};
}

Status put_triangles(OutputStream& stream, const Surface& surface, const SurfaceMesh& mesh, double max_error,
                     const Context& context, SurfaceFileReport& report) {
  if (mesh.triangles.size() > 0xffffffffu) {
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
  put_binary(count, std::uint32_t(mesh.triangles.size()));
  stream.write({count.data(), count.size()});
  const auto corner = [&](SurfaceMesh::Index v) -> Corner {
    const Point3 p = mesh.vertices[v];
    return {float(p.x + (origin.x - off.x)), float(p.y + (origin.y - off.y)), float(p.z + (origin.z - off.z))};
  };
  return write_items(stream, mesh.triangles.size(), context, [&](fmt::memory_buffer& bytes, std::size_t t) {
    const auto& v = mesh.triangles[t].vertex;
    const Corner a = corner(v[0]), b = corner(v[1]), c = corner(v[2]);
    for (const Corner& values : {unit_normal(a, b, c), a, b, c}) put_binary(bytes, values);
    put_binary(bytes, std::uint16_t{0});
  });
}

}  // namespace

SurfaceWriteResult write_surface_stl(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                     const Context& context) {
  const double max_error = surface_max_error(options, surface.radius());
  const auto put = [&](OutputStream& stream, const SurfaceMesh& mesh, SurfaceFileReport& report) {
    return put_triangles(stream, surface, mesh, max_error, context, report);
  };
  return write_mesh(path, surface, options, context, put);
}

}  // namespace krepl::output
