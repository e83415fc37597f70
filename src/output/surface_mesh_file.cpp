#include "output/surface_mesh_file.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::output {

namespace {

/// The triangles within the deviation asked for, and the report about them.
Result<SurfaceMesh> make_mesh(const Surface& surface, const SurfaceFileOptions& options, const Context& context,
                              SurfaceFileReport& report) {
  const double max_error = surface_max_error(options, surface.radius());
  if (max_error < 1e-9 * surface.radius()) {
    return Error{ErrorCode::usage, "--max-error is too small for the radius", "", "give at least 1e-9 of the radius"};
  }
  Result<SurfaceMesh> mesh = SurfaceMesh::make(surface, max_error, context);
  if (!mesh) return mesh;
  report.deviation = mesh->deviation();
  report.triangles = mesh->triangle_count();
  if (mesh->folded() > 0) {
    report.notes.push_back(
        fmt::format("note: {} triangles in faces narrower than the deviation are seen from below", mesh->folded()));
  }
  return mesh;
}

}  // namespace

std::array<std::uint8_t, 3> patch_colour(Terrain::FeatureKind kind) {
  switch (kind) {
    case Terrain::FeatureKind::face: return {232, 217, 179};
    case Terrain::FeatureKind::edge: return {120, 171, 214};
    case Terrain::FeatureKind::vertex: return {227, 115, 87};
  }
  return {};
}

SurfaceWriteResult write_mesh(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                              const Context& context,
                              const std::function<Status(OutputStream&, const SurfaceMesh&, SurfaceFileReport&)>& put) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  SurfaceFileReport report;
  const Result<SurfaceMesh> mesh = make_mesh(surface, options, context, report);
  if (!mesh) return mesh.error();
  if (Status written = put(*stream, *mesh, report); !written) return written.error();
  if (Status finished = stream->finish(); !finished) return finished.error();
  return report;
}

Point3 float_origin(const Surface& surface, double max_error) {
  const Point3 o = surface.terrain().origin(), low = surface.terrain().lowest(), high = surface.terrain().highest();
  double largest = surface.radius();
  for (const double value : {o.x + low.x, o.x + high.x, o.y + low.y, o.y + high.y, o.z + low.z, o.z + high.z})
    largest = std::max(largest, std::fabs(value));
  if (largest * 0x1p-24 <= max_error / 50) return {0, 0, 0};
  return {std::round(o.x + (low.x + high.x) / 2), std::round(o.y + (low.y + high.y) / 2),
          std::round(o.z + (low.z + high.z) / 2)};
}

}  // namespace krepl::output
