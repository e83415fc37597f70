// Hill climbing for terrains with many vertices: which number of triangles can have how many?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/chart.hpp"
#include "lab/experiments.hpp"
#include "lab/families.hpp"
#include "lab/fit.hpp"
#include "lab/measure.hpp"

namespace krepl::lab {

namespace {

/// One climb from one start.
struct Climb {
  const Family* family;
  std::size_t size;
  std::size_t number;
  Construction best;
  std::size_t from = 0, vertices = 0, taken = 0, refused = 0, late = 0;
};

struct Value {
  std::size_t vertices = 0;  // 0: no result
  bool late = false;
};

Value value_of(const Construction& c, std::size_t triangles, const Context& context) {
  const auto surface = surface_of(c, context);
  if (!surface) return {0, surface.error().code == ErrorCode::cancelled};
  // A terrain that lost a triangle without area is another n.
  if (surface->terrain().triangle_count() != triangles) return {};
  return {surface->subdivision().vertex_count, false};
}

double extent_of(const Construction& c) {
  double extent = 0;
  for (const Point3& p : c.vertices) extent = std::max({extent, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return extent;
}

/// One vertex, one triangle or the radius, changed by much or by little. False if projections overlap now.
bool change(Construction& c, Random& random) {
  if (random.one_in(8)) {
    c.radius *= random.scaled(0.8, 1.25);
    return true;
  }
  const double by = extent_of(c) * random.scaled(1e-4, 0.3);
  const bool upright = random.one_in(3);
  const Point3 move{upright ? 0 : random.between(-by, by), upright ? 0 : random.between(-by, by),
                    random.between(-by, by)};
  const auto shift = [&](Terrain::Index v) {
    Point3& p = c.vertices[v];
    p = {p.x + move.x, p.y + move.y, p.z + move.z};
  };
  const Construction::Triangle triangle = c.triangles[random.below(c.triangles.size())];
  if (random.one_in(4)) {
    for (const Terrain::Index v : triangle) shift(v);
    return upright ||
           std::none_of(triangle.begin(), triangle.end(), [&](auto v) { return projections_overlap_at(c, v); });
  }
  const Terrain::Index v = triangle[random.below(3)];
  shift(v);
  return upright || !projections_overlap_at(c, v);
}

void climb(Climb& climb, const SearchOptions& options, TimeLimit& limit, const Context& outer) {
  Random random(options.seed, climb.number);
  climb.best = climb.family->make(random, climb.size);
  const std::size_t triangles = climb.best.triangles.size();
  climb.from = climb.vertices = value_of(climb.best, triangles, limit.begin()).vertices;
  for (std::size_t step = 0; step < options.steps && !outer.cancelled(); ++step) {
    Construction next = climb.best;
    if (!change(next, random)) {
      ++climb.refused;
      continue;
    }
    const Value value = value_of(next, triangles, limit.begin());
    climb.late += value.late;
    if (value.vertices < climb.vertices || value.vertices == 0) continue;  // as many is good enough: it may lead on
    climb.best = std::move(next), climb.vertices = value.vertices, ++climb.taken;
  }
}

double ratio_of(const Climb& c) {
  const double n = double(c.best.triangles.size());
  return double(c.vertices) / (n * lambda_2(n));
}

Status check(const SearchOptions& options) {
  for (const std::size_t size : options.sizes) {
    if (size < 3 || size > 100)
      return Error{ErrorCode::usage, fmt::format("{} triangles are out of range", size), "",
                   "give numbers from 3 to 100"};
  }
  if (options.sizes.empty() || options.restarts == 0)
    return Error{ErrorCode::usage, "there is nothing to start from", "", "give sizes, and one restart or more"};
  return std::monostate{};
}

std::vector<Climb> climbs_of(const SearchOptions& options) {
  std::vector<Climb> climbs;
  for (const std::size_t size : options.sizes) {
    for (const Family& family : families()) {
      if (!family.terrain || size < family.least_triangles) continue;
      for (std::size_t k = 0; k < options.restarts; ++k) climbs.push_back({&family, size, climbs.size(), {}});
    }
  }
  return climbs;
}

/// A row for each family and size: the best of its restarts.
void append_rows(Report& report, const std::vector<Climb>& climbs, const SearchOptions& options) {
  report.table.columns = {"start", "n",           "radius", "start_vertices", "vertices", "vertices/n_lambda_2",
                          "taken", "overlapping", "late"};
  for (std::size_t i = 0; i < climbs.size(); i += options.restarts) {
    const auto group = climbs.begin() + std::ptrdiff_t(i);
    const Climb& c = *std::max_element(group, group + std::ptrdiff_t(options.restarts),
                                       [](const Climb& a, const Climb& b) { return ratio_of(a) < ratio_of(b); });
    report.table.rows.push_back({std::string(c.family->name), whole(c.best.triangles.size()), c.best.radius,
                                 whole(c.from), whole(c.vertices), ratio_of(c), whole(c.taken), whole(c.refused),
                                 whole(c.late)});
  }
}

/// Where features are all but tangent a surface may be right within its tolerance and have more vertices than the true
/// one.
std::string second_opinion(const Climb& climb, const SearchOptions& options, const Context& context) {
  TimeLimit limit(context, options.limit);
  const auto other = incremental_surface_of(climb.best, limit.begin());
  if (!other) return "not confirmed by the incremental engine";
  const std::size_t vertices = other->subdivision().vertex_count;
  return vertices == climb.vertices ? "confirmed by the incremental engine"
                                    : fmt::format("the incremental engine finds {}", vertices);
}

void append_best(Report& report, const std::vector<Climb>& climbs, const SearchOptions& options,
                 const Context& context) {
  Chart::Series found{"best found", {}, true, false};
  std::vector<Point> vertices;
  for (const std::size_t size : options.sizes) {
    const Climb* best = nullptr;
    for (const Climb& c : climbs) {
      if (c.size == size && (best == nullptr || ratio_of(c) > ratio_of(*best))) best = &c;
    }
    if (best == nullptr || best->vertices == 0) continue;
    const double n = double(best->best.triangles.size());
    found.points.push_back({n, ratio_of(*best)}), vertices.push_back({n, double(best->vertices)});
    const std::string title =
        fmt::format("{} triangles, {} vertices, found from `{}`", n, best->vertices, best->family->name);
    report.findings.push_back(title + ", " + second_opinion(*best, options, context));
    report.exhibits.push_back({fmt::format("search-{}.obj", size), obj_text(best->best, title)});
  }
  if (vertices.size() >= 2) {
    const double exponent = fitted_exponent(vertices);
    report.results.emplace_back("exponent of the most vertices", exponent);
    report.findings.push_back(fmt::format("the most vertices found grow as n^{:.3f}", exponent));
  }
  const Chart chart{"Terrains found by hill climbing", "n, triangles", "vertices / n lambda_2(n)", {found}};
  report.exhibits.push_back({"search.svg", svg_of(chart)});
}

}  // namespace

Result<Report> search_experiment(const SearchOptions& options, const Context& context) {
  if (Status right = check(options); !right) return right.error();
  std::vector<Climb> climbs = climbs_of(options);
  const bool done = run_limited(context, 0, climbs.size(), [&](std::size_t i, const Context&) {
    TimeLimit limit(context, options.limit);
    climb(climbs[i], options, limit, context);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  Report report;
  report.name = "search";
  append_rows(report, climbs, options);
  append_best(report, climbs, options, context);
  return report;
}

}  // namespace krepl::lab
