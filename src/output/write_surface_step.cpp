// STEP: the surface as faces on true planes, cylinders and spheres.
#include <ogr_spatialref.h>

#include <cmath>
#include <filesystem>

#include "output/atomic_file.hpp"
#include "output/ogr_options.hpp"
#include "output/surface_writers.hpp"
#include "solid/step_file.hpp"

namespace krepl::output {

namespace {

/// The unit of a coordinate system as STEP has it; parts have none, and are in millimetres as a rule.
std::string unit_of(const std::string& crs_text) {
  OGRSpatialReference crs;
  if (crs_text.empty() || crs.importFromWkt(crs_text.c_str()) != OGRERR_NONE) return "mm";
  constexpr double foot = 0.3048, same = 1e-5;  // whichever foot
  return std::fabs(crs.GetLinearUnits() - foot) < same ? "ft" : "m";
}

SurfaceFileReport report_of(const solid::StepReport& step, double radius) {
  SurfaceFileReport report;
  report.deviation = step.deviation;
  report.faces =
      fmt::format("{} planes, {} cylinders and {} spheres written", step.planes, step.cylinders, step.spheres);
  if (step.walls > 0) report.faces += fmt::format(", {} walls", step.walls);
  if (step.floors > 0) report.faces += step.floors == 1 ? ", a floor" : fmt::format(", {} floors", step.floors);
  if (step.shells > 1) report.faces += fmt::format(", in {} parts", step.shells);
  if (step.narrow_faces > 0) {
    report.notes.push_back(
        fmt::format("note: {} faces narrower than {:.2g} are left out", step.narrow_faces, step.tolerance));
  }
  if (step.deviation > 1e-6 * radius) {
    report.notes.push_back(
        fmt::format("note: edges are within {:.2g} of the surface, more than a millionth of the radius: the "
                    "terrain has details hardly larger than its rounding",
                    step.deviation));
  }
  return report;
}

}  // namespace

SurfaceWriteResult write_surface_step(const std::string& path, const Surface& surface,
                                      const SurfaceFileOptions& options, const Context& context) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const solid::StepOptions step{options.solid, options.unit.empty() ? unit_of(options.crs) : options.unit,
                                std::filesystem::path(path).stem().string(), file_date("%Y-%m-%dT%H:%M:%S")};
  const Result<solid::StepReport> written = solid::write_step(file->temporary_path(), surface, step, context);
  if (!written) return written.error();
  if (Status committed = file->commit(); !committed) return committed.error();
  return report_of(*written, surface.radius());
}

}  // namespace krepl::output
