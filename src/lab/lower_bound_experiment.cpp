// Section 4.3: grooves and needles.
#include <fmt/format.h>

#include "lab/chart.hpp"
#include "lab/count_columns.hpp"
#include "lab/drawing.hpp"
#include "lab/experiments.hpp"
#include "lab/fit.hpp"
#include "lab/lower_bound.hpp"
#include "lab/measure.hpp"

namespace krepl::lab {

namespace {

struct Kind {
  const char* name;
  Construction (*make)(std::size_t grooves, std::size_t needles);
};
constexpr Kind kinds[] = {{"lower-bound", lower_bound}, {"islands", lower_bound_islands}};
constexpr std::size_t kind_count = std::size(kinds);
constexpr std::size_t largest_drawing = 4000;  // edges

struct Case {
  std::size_t n = 0;
  const Kind* kind = nullptr;
  std::size_t triangles = 0;
  terrain::SurfaceCounts counts;
  Error error;
  std::string obj, drawing;
};

void measure(Case& c, bool draw, const Context& context) {
  const Construction construction = c.kind->make(c.n / 2, c.n / 2);
  const auto surface = surface_of(construction, context);
  if (!surface) {
    c.error = surface.error();
    return;
  }
  c.triangles = construction.triangles.size();
  c.counts = terrain::count_surface(*surface);
  const std::string title = fmt::format("{}, n = {}: {} vertices", c.kind->name, c.n, c.counts.vertices);
  c.obj = obj_text(construction, title);
  if (draw && c.counts.edges <= largest_drawing) c.drawing = svg_of(*surface, title);
}

/// The argument of lower_bound.hpp holds, or something is wrong with it or with the engine.
Status check(const Case& c) {
  const std::size_t half = c.n / 2;
  const bool connected = c.kind == &kinds[0];
  const std::size_t pairs = 2 * half * (connected ? half + 1 : half - 1);
  if (c.counts.triple_contacts >= pairs && (!connected || c.counts.vertices == lower_bound_vertices(half, half)))
    return std::monostate{};
  return Error{
      ErrorCode::computation,
      fmt::format("{} at n = {} has {} vertices, in {} of which the ball touches three places; expected {} of these",
                  c.kind->name, c.n, c.counts.vertices, c.counts.triple_contacts, pairs),
      "", "report this with the version of krepl"};
}

void append_fits(Report& report, const std::vector<Case>& cases, Chart& chart) {
  for (std::size_t k = 0; k < kind_count; ++k) {
    std::vector<Point> by_triangles, by_n;
    for (std::size_t i = k; i < cases.size(); i += kind_count) {
      by_triangles.push_back({double(cases[i].triangles), double(cases[i].counts.vertices)});
      by_n.push_back({double(cases[i].n), double(cases[i].counts.vertices)});
    }
    chart.series.push_back({kinds[k].name, by_triangles, true, false});
    if (by_n.size() < 2) continue;
    const double exponent = fitted_exponent(by_triangles), in_n = fitted_exponent(by_n);
    report.results.emplace_back(fmt::format("{}: exponent in triangles", kinds[k].name), exponent);
    report.results.emplace_back(fmt::format("{}: exponent in n", kinds[k].name), in_n);
    report.findings.push_back(
        fmt::format("{}: vertices grow as triangles^{:.3f} (as n^{:.3f}, n grooves and needles together)",
                    kinds[k].name, exponent, in_n));
  }
}

}  // namespace

Result<Report> lower_bound_experiment(const std::vector<std::size_t>& n, const Context& context) {
  std::vector<Case> cases;
  for (const std::size_t each : n) {
    if (each < 4 || each > 1024 || each % 4 != 0)
      return Error{ErrorCode::usage,
                   fmt::format("n = {} gives no n/2 grooves, half of them on each side of n/2 needles", each), "",
                   "give multiples of 4 from 4 to 1024"};
    for (const Kind& kind : kinds) cases.push_back({each, &kind, 0, {}, {}, {}, {}});
  }
  if (!run_limited(context, 0, cases.size(),
                   [&](std::size_t i, const Context& one) { measure(cases[i], i < kind_count, one); }))
    return Error{ErrorCode::cancelled, "cancelled", "", ""};
  Report report;
  report.name = "lower-bound";
  report.table.columns = {"kind", "n", "triangles"};
  append_count_names(report.table);
  report.table.columns.push_back("vertices/n_lambda_2");
  for (Case& c : cases) {
    if (c.kind != nullptr && c.triangles == 0) return c.error;
    if (Status right = check(c); !right) return right.error();
    std::vector<Table::Value> row{std::string(c.kind->name), whole(c.n), whole(c.triangles)};
    append_counts(row, c.counts);
    row.emplace_back(double(c.counts.vertices) / (double(c.triangles) * lambda_2(double(c.triangles))));
    report.table.rows.push_back(std::move(row));
    report.exhibits.push_back({fmt::format("{}-{}.obj", c.kind->name, c.n), std::move(c.obj)});
    if (!c.drawing.empty())
      report.exhibits.push_back({fmt::format("{}-{}.svg", c.kind->name, c.n), std::move(c.drawing)});
  }
  Chart chart{"n/2 grooves and n/2 needles", "triangles", "vertices of the boundary", {}};
  append_fits(report, cases, chart);
  report.exhibits.push_back({"lower-bound.svg", svg_of(chart)});
  return report;
}

}  // namespace krepl::lab
