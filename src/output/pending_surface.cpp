// TEMPORARY: replaced within the hour.
#include "output/surface_writers.hpp"
namespace krepl::output {
#define KREPL_PENDING(name)                                                                                       \
  SurfaceWriteResult name(const std::string&, const Surface&, const SurfaceFileOptions&, const Context&) {         \
    return Error{ErrorCode::usage, "not written yet", "", ""};                                                   \
  }
KREPL_PENDING(write_surface_gpkg)
KREPL_PENDING(write_surface_stl)
KREPL_PENDING(write_surface_ply)
KREPL_PENDING(write_surface_glb)
KREPL_PENDING(write_surface_png)
SurfaceWriteResult write_heights(const std::string&, std::shared_ptr<const Terrain>, double, const SurfaceFileOptions&, const Context&) {
  return Error{ErrorCode::usage, "not written yet", "", ""};
}
}
