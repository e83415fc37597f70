#include "incremental/assembly.hpp"
#include "incremental/monotone_order.hpp"
#include "krepl/incremental.hpp"
#include "model/radius_check.hpp"

namespace krepl {

namespace {

std::optional<Error> refusal(const Terrain& terrain, const IncrementalOptions& options) {
  if (auto error = refuse_radius(terrain, options.radius, 0x1p-20, ", or the engine auto")) return error;
  if (terrain.triangle_count() > options.most_triangles) {
    return Error{ErrorCode::usage,
                 "the incremental engine takes at most " + std::to_string(options.most_triangles) +
                     " triangles, these are " + std::to_string(terrain.triangle_count()),
                 "", "use the engine auto, or cut the input smaller"};
  }
  return std::nullopt;
}

Error uncertified(const Terrain& terrain, const incremental::Fault& fault, std::size_t step) {
  const Point3 o = terrain.origin();
  return Error{ErrorCode::computation, "the surface could not be certified: " + fault.what,
               "near x " + shown(double(fault.at.x) + o.x) + ", y " + shown(double(fault.at.y) + o.y) +
                   ", when triangle " + std::to_string(step + 1) + " of the order was added",
               "use the engine auto"};
}

}  // namespace

Result<Surface> compute_surface_incremental(std::shared_ptr<const Terrain> terrain, const IncrementalOptions& options,
                                            const Context& context) {
  if (auto error = refusal(*terrain, options)) return *error;
  const incremental::Parts parts(*terrain, options.radius);
  const incremental::Tolerance tolerance(parts.scale());
  incremental::Union growing(parts, tolerance);
  SurfaceCounters counters;
  counters.patches = parts.parts().size();
  const std::vector<incremental::Index> order = incremental::monotone_order(parts);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    if (const auto fault = growing.add(order[i])) return uncertified(*terrain, *fault, i);
    const incremental::UnionStep& step = growing.last_step();
    ++counters.unions;
    counters.intersection_components += step.components;
    counters.closed_components += step.closed;
    counters.most_components = std::max<std::uint64_t>(counters.most_components, step.components);
    counters.last_components = step.components;
    counters.last_closed = step.closed;
    counters.unions_with_several += step.components > 1;
    if (context.progress) context.progress(double(i + 1) / double(order.size()));
  }
  counters.curves_traced = growing.curves_traced();
  Surface surface = IncrementalAssembly(terrain, options.radius, parts, growing.map()).finish(counters);
  if (auto problem = surface.validate()) {
    return Error{ErrorCode::computation, "the surface could not be certified: " + *problem, "", "use the engine auto"};
  }
  return surface;
}

}  // namespace krepl
