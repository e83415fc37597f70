// Section 3.3: crossings that a sweep over the boundaries of cigars meets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "krepl/sweep.hpp"
#include "lab/chart.hpp"
#include "lab/experiments.hpp"
#include "lab/fit.hpp"
#include "lab/sub_rivers.hpp"

namespace krepl::lab {

namespace {

using CleanUp = SweepOptions::CleanUp;

struct Way {
  CleanUp clean_up;
  const char* name;
};
constexpr Way ways[] = {{CleanUp::neighbours, "one sweep"}, {CleanUp::rounds, "in rounds"}};
constexpr std::size_t largest_drawing = 24;  // reaches

Error unexpected(const std::string& what) {
  return {ErrorCode::computation, what, "", "report this with the version of krepl"};
}

struct Run {
  SweepCounters counters;
  std::size_t pieces = 0;
};

/// Both ways, beside the engine that does not sweep.
Result<std::vector<Run>> run(const SubRiver& river, const Context& context, std::string& drawing) {
  Network::Builder builder;
  builder.add_line(river.vertices);
  auto built = std::move(builder).build(context);
  if (!built) return built.error();
  const auto network = std::make_shared<const Network>(std::move(*built));
  const auto expected = compute_zone(network, {river.radius}, context);
  if (!expected) return expected.error();
  const std::size_t n = network->segments().size();
  std::vector<Run> runs;
  for (const Way& way : ways) {
    Run each;
    const auto zone = compute_zone_by_sweep(network, {river.radius, way.clean_up}, context, &each.counters);
    if (!zone) return zone.error();
    each.pieces = zone->piece_count();
    if (each.pieces != expected->piece_count() || zone->ring_count() != expected->ring_count() ||
        std::abs(zone->area() - expected->area()) > 1e-9 * expected->area())
      return unexpected(fmt::format("{} of {} reaches, {}: another zone than the engine by intervals finds", river.name,
                                    n, way.name));
    if (n <= largest_drawing)
      drawing = svg_of(river, *zone, fmt::format("{}, n = {}: {} pieces of boundary", river.name, n, each.pieces));
    runs.push_back(each);
  }
  return runs;
}

std::string wkt_of(const SubRiver& river) {
  std::string text = "LINESTRING (";
  for (const Point p : river.vertices) text += fmt::format("{}{} {}", text.back() == '(' ? "" : ", ", p.x, p.y);
  return text + ")\n";
}

}  // namespace

Result<Report> sweep_experiment(const std::vector<std::size_t>& n, const Context& context) {
  for (const std::size_t reaches : n) {
    if (reaches < 3 || reaches > 4000)
      return Error{ErrorCode::usage, fmt::format("n = {} is out of range", reaches), "",
                   "give numbers of reaches from 3 to 4000"};
  }
  Report report;
  report.name = "sweep";
  report.table.columns = {"kind", "n", "clean_up", "pieces", "curves", "rounds", "crossings", "expected_at_least"};
  Chart chart{"Crossings met by sweeps over n cigars", "n", "crossings", {}};
  for (const auto make : {bundle, spread}) {
    std::vector<Point> series[std::size(ways)];
    for (const std::size_t reaches : n) {
      const SubRiver river = make(reaches);
      std::string drawing;
      const auto runs = run(river, context, drawing);
      if (!runs) return runs.error();
      const std::size_t least = make == bundle ? bundle_crossings(reaches) : 0;
      if ((*runs)[0].counters.crossings < least)
        return unexpected(fmt::format("{} of {} reaches: {} crossings, expected {} or more", river.name, reaches,
                                      (*runs)[0].counters.crossings, least));
      for (std::size_t w = 0; w < std::size(ways); ++w) {
        const Run& each = (*runs)[w];
        series[w].push_back({double(reaches), double(each.counters.crossings)});
        report.table.rows.push_back({std::string(river.name), whole(reaches), std::string(ways[w].name),
                                     whole(each.pieces), whole(each.counters.curves), whole(each.counters.rounds),
                                     whole(each.counters.crossings), whole(w == 0 ? least : 0)});
      }
      report.exhibits.push_back({fmt::format("{}-{}.wkt", river.name, reaches), wkt_of(river)});
      if (!drawing.empty()) report.exhibits.push_back({fmt::format("{}-{}.svg", river.name, reaches), drawing});
    }
    for (std::size_t w = 0; w < std::size(ways); ++w) {
      const std::string name = fmt::format("{}, {}", make(3).name, ways[w].name);
      chart.series.push_back({name, series[w], true, false});
      if (n.size() < 2) continue;
      const double exponent = fitted_exponent(series[w]);
      report.results.emplace_back(name + ": exponent of crossings", exponent);
      report.findings.push_back(fmt::format("{}: crossings grow as n^{:.3f}", name, exponent));
    }
  }
  report.exhibits.push_back({"sweep.svg", svg_of(chart)});
  return report;
}

}  // namespace krepl::lab
