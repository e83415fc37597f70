// Figure 4.5 and theorem 4.5.4: what holds for two bodies and not for three, and what holds for none.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "lab/count_columns.hpp"
#include "lab/drawing.hpp"
#include "lab/experiments.hpp"
#include "lab/figures.hpp"
#include "lab/measure.hpp"

namespace krepl::lab {

namespace {

using Index = Surface::Index;

/// Numbers of the construction's triangles that have all corners of a feature.
std::vector<std::size_t> triangles_with(const Surface& surface, Index feature, const Construction& c) {
  const Terrain::Corners corners = surface.terrain().corners(feature);
  const Point3 o = surface.terrain().origin();
  std::vector<std::size_t> found;
  for (std::size_t t = 0; t < c.triangles.size(); ++t) {
    bool all = true;
    for (int k = 0; k < corners.count; ++k) {
      all = all && std::any_of(c.triangles[t].begin(), c.triangles[t].end(), [&](Terrain::Index v) {
              const Point3 p = c.vertices[v];
              return Point3{p.x - o.x, p.y - o.y, p.z - o.z} == corners.point[std::size_t(k)];
            });
    }
    if (all) found.push_back(t);
  }
  return found;
}

/// Centres of balls that rest on three triangles at once, in the coordinates of the construction.
std::vector<Point3> balls_on_three(const Surface& surface, const Construction& c) {
  const Subdivision& topology = surface.subdivision();
  std::vector<std::set<std::size_t>> touched(topology.vertex_count);
  for (std::size_t h = 0; h < topology.half_edge_count(); ++h) {
    const Index feature = surface.face_feature(topology.face[h]);
    if (feature == Surface::none) continue;
    for (const std::size_t t : triangles_with(surface, feature, c)) touched[topology.origin[h]].insert(t);
  }
  std::vector<Point3> centres;
  const Point3 o = surface.terrain().origin();
  for (Index v = 0; v < topology.vertex_count; ++v) {
    const Point3 p = surface.vertex(v);
    if (touched[v].size() == 3) centres.push_back({p.x + o.x, p.y + o.y, p.z + o.z});
  }
  return centres;
}

std::string list_of(const std::vector<Point3>& places) {
  std::string text;
  for (const Point3& p : places)
    text += fmt::format("{}({:.6f} {:.6f} {:.6f})", text.empty() ? "" : ", ", p.x, p.y, p.z);
  return text;
}

Error unexpected(const std::string& what) {
  return {ErrorCode::computation, what, "", "report this with the version of krepl"};
}

}  // namespace

Result<Report> pseudospheres_experiment(const Context& context) {
  Report report;
  report.name = "pseudospheres";
  report.table.columns = {"kind", "engine", "triangles", "projections_overlap", "touching_all_three"};
  append_count_names(report.table);
  const std::pair<const char*, Construction> kinds[] = {{"crossing-needles", crossing_needles()},
                                                        {"crossing-blades", crossing_blades()}};
  for (const auto& [name, construction] : kinds) {
    for (const bool incremental : {false, true}) {
      const auto surface =
          incremental ? incremental_surface_of(construction, context) : surface_of(construction, context);
      if (!surface) return surface.error();
      const std::vector<Point3> balls = balls_on_three(*surface, construction);
      if (balls.size() != 4)
        return unexpected(fmt::format("{}: {} balls touch all three triangles, not 4", name, balls.size()));
      std::vector<Table::Value> row{std::string(name), std::string(incremental ? "incremental" : "auto"),
                                    whole(construction.triangles.size()),
                                    std::string(projections_overlap(construction) ? "yes" : "no"), whole(balls.size())};
      append_counts(row, terrain::count_surface(*surface));
      report.table.rows.push_back(std::move(row));
      if (incremental) continue;
      const std::string title = fmt::format("{}: four balls touch all three triangles", name);
      report.findings.push_back(fmt::format("{}, with their centres at {}", title, list_of(balls)));
      report.exhibits.push_back({fmt::format("{}.obj", name), obj_text(construction, title)});
      report.exhibits.push_back({fmt::format("{}.svg", name), svg_of(*surface, title)});
    }
  }
  return report;
}

Result<Report> components_experiment(const Context& context) {
  const Construction construction = two_components();
  const auto by_cells = surface_of(construction, context);
  if (!by_cells) return by_cells.error();
  const auto surface = incremental_surface_of(construction, context);
  if (!surface) return surface.error();
  const SurfaceCounters& counters = surface->counters();
  Report report;
  report.name = "components";
  report.table.columns = {"engine", "triangles", "unions", "components_of_last", "closed_of_last"};
  append_count_names(report.table);
  std::vector<Table::Value> row{std::string("incremental"), whole(construction.triangles.size()),
                                whole(counters.unions), whole(counters.last_components), whole(counters.last_closed)};
  append_counts(row, terrain::count_surface(*surface));
  report.table.rows.push_back(std::move(row));
  row = {std::string("auto"), whole(construction.triangles.size()), std::string(), std::string(), std::string()};
  append_counts(row, terrain::count_surface(*by_cells));
  report.table.rows.push_back(std::move(row));
  if (counters.last_components != 2 || counters.last_closed != 1)
    return unexpected(fmt::format("the last union has {} components, {} of them closed, not 2 and 1",
                                  counters.last_components, counters.last_closed));
  const std::string title = "counter-example to theorem 4.5.4";
  report.findings.push_back(fmt::format(
      "{}: the last of {} triangles meets the sum of all others in a closed curve and an arc", title, counters.unions));
  report.exhibits.push_back({"components.obj", obj_text(construction, title)});
  report.exhibits.push_back({"components.svg", svg_of(*surface, title)});
  return report;
}

}  // namespace krepl::lab
