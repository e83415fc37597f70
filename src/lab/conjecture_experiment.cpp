// Conjecture 4.5.6, O(n lambda_2(n)) vertices: how near do random and adversarial terrains come to more?
#include <fmt/format.h>

#include <algorithm>

#include "lab/chart.hpp"
#include "lab/experiments.hpp"
#include "lab/families.hpp"
#include "lab/fit.hpp"
#include "lab/measure.hpp"

namespace krepl::lab {

namespace {

constexpr std::size_t most_triangles = 1000;
constexpr std::size_t most_confirmed = 32;  // triangles; the other engine takes a second then
constexpr std::size_t most_doubted = 20;

/// What is kept of one random terrain.
struct Outcome {
  std::size_t triangles = 0, vertices = 0, triple_contacts = 0;
  bool late = false;
  std::string error;  // empty if there is none

  double ratio() const {
    return triangles == 0 ? 0 : double(vertices) / (double(triangles) * lambda_2(double(triangles)));
  }
};

/// Terrains of one family and size: numbers first, first + step, ... of all.
struct Group {
  const Family* family;
  std::size_t size;
  std::size_t count = 0, late = 0, failed = 0;
  std::vector<std::size_t> ranked{};  // terrains with a result, the greatest ratio first
  std::size_t best = 0;               // the terrain that counts
  std::size_t doubted = 0;            // terrains before it in the ranking
  bool confirmed = false;             // by both engines
  Outcome most{};
  std::string error{};  // the first
};

std::vector<Group> groups_of(const std::vector<std::size_t>& sizes) {
  std::vector<Group> groups;
  for (const Family& family : families()) {
    for (const std::size_t size : sizes) {
      if (size >= family.least_triangles) groups.push_back({&family, size});
    }
  }
  return groups;
}

Construction terrain_number(const Group& group, std::size_t number, std::uint64_t seed) {
  Random random(seed, number);
  return group.family->make(random, group.size);
}

Outcome measured(const Construction& construction, const Context& context) {
  Outcome outcome;
  const auto surface = surface_of(construction, context);
  if (!surface) {
    outcome.late = surface.error().code == ErrorCode::cancelled;
    outcome.error = surface.error().text();
    return outcome;
  }
  const terrain::SurfaceCounts counts = terrain::count_surface(*surface);
  outcome.triangles = surface->terrain().triangle_count();
  outcome.vertices = counts.vertices, outcome.triple_contacts = counts.triple_contacts;
  return outcome;
}

void add(Group& group, const Outcome& outcome, std::size_t number) {
  ++group.count;
  if (outcome.error.empty()) return group.ranked.push_back(number);
  ++(outcome.late ? group.late : group.failed);
  if (group.error.empty()) group.error = fmt::format("{} (terrain {})", outcome.error, number);
}

/// Where features are all but tangent, a surface may be right within its tolerance and have far more vertices than the
/// true one. So a record of a small terrain counts only if the other engine finds as many.
void choose_best(Group& group, const std::vector<Outcome>& outcomes, std::uint64_t seed, TimeLimit& limit) {
  std::stable_sort(group.ranked.begin(), group.ranked.end(),
                   [&](std::size_t a, std::size_t b) { return outcomes[a].ratio() > outcomes[b].ratio(); });
  for (const std::size_t number : group.ranked) {
    if (group.size <= most_confirmed && group.doubted < most_doubted) {
      const auto other = incremental_surface_of(terrain_number(group, number, seed), limit.begin());
      group.confirmed = other && other->subdivision().vertex_count == outcomes[number].vertices;
      if (!group.confirmed) {
        ++group.doubted;
        continue;
      }
    }
    group.best = number, group.most = outcomes[number];
    return;
  }
}

Status check(const ConjectureOptions& options) {
  const auto usage = [](std::string what, const char* remedy) {
    return Error{ErrorCode::usage, std::move(what), "", remedy};
  };
  if (options.count == 0) return usage("no terrain is to be made", "give a count of one or more");
  for (const std::size_t size : options.sizes) {
    if (size == 0 || size > most_triangles)
      return usage(fmt::format("{} triangles are out of range", size), "give numbers from 1 to 1000");
  }
  if (groups_of(options.sizes).empty()) return usage("no size is given", "give numbers from 1 to 1000");
  return std::monostate{};
}

void append_rows(Report& report, const std::vector<Group>& groups) {
  report.table.columns = {"family",
                          "terrain",
                          "n",
                          "terrains",
                          "late",
                          "failed",
                          "engines_differ",
                          "confirmed",
                          "most_vertices",
                          "triple_contacts",
                          "vertices/n_lambda_2"};
  for (const Group& g : groups) {
    report.table.rows.push_back({std::string(g.family->name), std::string(g.family->terrain ? "yes" : "no"),
                                 whole(g.size), whole(g.count), whole(g.late), whole(g.failed), whole(g.doubted),
                                 std::string(g.confirmed ? "yes" : "no"), whole(g.most.vertices),
                                 whole(g.most.triple_contacts), g.most.ratio()});
    if (!g.error.empty())
      report.findings.push_back(
          fmt::format("{}, n = {}: without a result, first: {}", g.family->name, g.size, g.error));
  }
}

/// The conjecture speaks of growth: if it is false, some family grows faster than n lambda_2(n), its ratio with n.
void append_growth(Report& report, const std::vector<Group>& groups, Chart& chart) {
  std::string greatest_name;
  double greatest = 0;
  for (const Family& family : families()) {
    Chart::Series series{family.name, {}, true, false};
    std::vector<Point> vertices;
    for (const Group& g : groups) {
      if (g.family != &family || g.most.vertices == 0) continue;
      series.points.push_back({double(g.size), g.most.ratio()});
      vertices.push_back({double(g.most.triangles), double(g.most.vertices)});
    }
    if (vertices.size() >= 2) {
      const double exponent = fitted_exponent(vertices);
      report.results.emplace_back(fmt::format("{}: exponent of the most vertices", family.name), exponent);
      if (family.terrain && exponent > greatest) greatest = exponent, greatest_name = family.name;
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  if (greatest > 0)
    report.findings.push_back(
        fmt::format("of terrains, `{}` grows fastest: the most vertices as n^{:.3f}; n lambda_2(n) grows as n^2",
                    greatest_name, greatest));
}

/// The terrain with the greatest ratio of every family, at the largest size.
void append_best(Report& report, const std::vector<Group>& groups, std::uint64_t seed) {
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const Group& g = groups[k];
    if (g.most.ratio() == 0 || (k + 1 < groups.size() && groups[k + 1].family == g.family)) continue;
    const std::string title =
        fmt::format("{}, n = {}: {:.4g} n lambda_2(n) vertices", g.family->name, g.size, g.most.ratio());
    report.exhibits.push_back(
        {fmt::format("conjecture-{}.obj", g.family->name), obj_text(terrain_number(g, g.best, seed), title)});
  }
}

}  // namespace

Result<Report> conjecture_experiment(const ConjectureOptions& options, const Context& context) {
  if (Status right = check(options); !right) return right.error();
  std::vector<Group> groups = groups_of(options.sizes);
  std::vector<Outcome> outcomes(options.count);
  const auto measure_one = [&](std::size_t i, const Context& one) {
    outcomes[i] = measured(terrain_number(groups[i % groups.size()], i, options.seed), one);
  };
  if (!run_limited(context, options.limit, options.count, measure_one))
    return Error{ErrorCode::cancelled, "cancelled", "", ""};
  for (std::size_t i = 0; i < outcomes.size(); ++i) add(groups[i % groups.size()], outcomes[i], i);
  const auto choose = [&](std::size_t i, const Context&) {
    TimeLimit limit(context, options.limit);
    choose_best(groups[i], outcomes, options.seed, limit);
  };
  if (!run_limited(context, 0, groups.size(), choose)) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  Report report;
  report.name = "conjecture";
  append_rows(report, groups);
  Chart chart{"How near to n lambda_2(n)", "n, triangles", "greatest vertices / n lambda_2(n)", {}};
  append_growth(report, groups, chart);
  append_best(report, groups, options.seed);
  report.exhibits.push_back({"conjecture.svg", svg_of(chart)});
  return report;
}

}  // namespace krepl::lab
