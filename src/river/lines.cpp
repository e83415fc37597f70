#include "river/lines.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"

namespace krepl::river {
namespace {

using vectors::distance;

/// Gives equal grid points one number, by their coordinates.
void weld(const std::vector<GridPoint>& points, std::vector<GridPoint>& vertices, std::vector<Index>& number) {
  vertices = points;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  number.resize(points.size());
  std::transform(points.begin(), points.end(), number.begin(), [&](GridPoint p) {
    return Index(std::lower_bound(vertices.begin(), vertices.end(), p) - vertices.begin());
  });
}

}  // namespace

Lines take_lines(const Network& network, double coarsest, RiverReport& report) {
  Lines lines;
  lines.pitch = network.resolution();
  if (coarsest > lines.pitch) lines.pitch = std::ldexp(1.0, std::ilogb(coarsest));
  std::vector<GridPoint> grid(network.vertices().size());
  for (std::size_t v = 0; v < grid.size(); ++v) {
    const Point local = network.vertices()[v], p{network.origin().x + local.x, network.origin().y + local.y};
    grid[v] = {std::llround(p.x / lines.pitch), std::llround(p.y / lines.pitch)};
    report.largest_move =
        std::max(report.largest_move, distance(p, {double(grid[v].x) * lines.pitch, double(grid[v].y) * lines.pitch}));
  }
  std::vector<Index> number;
  weld(grid, lines.vertices, number);
  for (std::uint32_t part = 0; part < network.part_count(); ++part) {
    const auto given = network.part(part);
    const std::size_t first = lines.chain.size();
    const auto add = [&](Index vertex) {
      if (lines.chain.size() > first && lines.chain.back() == vertex)
        ++report.repeated_vertices;
      else
        lines.chain.push_back(vertex);
    };
    for (std::uint32_t v : given) add(number[v]);
    if (network.part_is_ring(part) && lines.chain.back() != lines.chain[first]) add(lines.chain[first]);
    if (lines.chain.size() - first < 2) {
      lines.chain.resize(first);
      ++report.ignored_points;
      continue;
    }
    for (std::size_t i = first + 1; i < lines.chain.size(); ++i) {
      report.input_length += distance(lines.place(lines.chain[i - 1]), lines.place(lines.chain[i]));
    }
    lines.begin.push_back(lines.chain.size());
    lines.feature.push_back(network.part_feature(part));
  }
  report.lines = lines.line_count();
  report.grid = lines.pitch;
  return lines;
}

double Edges::length(const Edge& e) const { return distance(place(e.from), place(e.to)); }

std::optional<Edges> node_lines(const Lines& lines, RiverReport& report, const Context& context) {
  Edges result;
  result.pitch = lines.pitch;
  // Only vertices that lines still use attract segments.
  std::vector<Index> number(lines.vertices.size(), ~Index{0});
  for (Index v : lines.chain) number[v] = 0;
  for (Index v = 0; v < number.size(); ++v) {
    if (number[v] != 0) continue;
    number[v] = Index(result.vertices.size());
    result.vertices.push_back(lines.vertices[v]);
  }
  std::vector<model::GridSegment> segments;
  std::vector<std::int64_t> feature;
  for (std::size_t line = 0; line < lines.line_count(); ++line) {
    for (std::size_t i = lines.begin[line] + 1; i < lines.begin[line + 1]; ++i) {
      segments.push_back({number[lines.chain[i - 1]], number[lines.chain[i]]});
      feature.push_back(lines.feature[line]);
    }
  }
  const std::size_t given = result.vertices.size();
  auto noding = model::node_segments(std::move(result.vertices), segments, context);
  if (!noding) return std::nullopt;
  result.vertices = std::move(noding->vertices);
  report.crossings = result.vertices.size() - given;
  report.touches = noding->touches;
  if (report.crossings > 0) report.largest_move = std::max(report.largest_move, lines.pitch * std::sqrt(0.5));

  auto& fragments = noding->fragments;
  const auto ends = [](const auto& f) { return std::minmax(f.from, f.to); };
  std::sort(fragments.begin(), fragments.end(), [&](const auto& f, const auto& g) {
    return ends(f) != ends(g) ? ends(f) < ends(g) : f.segment < g.segment;
  });
  for (const auto& f : fragments) {
    const Edge edge{f.from, f.to, feature[f.segment]};
    if (result.edges.empty() || ends(result.edges.back()) != ends(edge)) {
      result.edges.push_back(edge);
      continue;
    }
    ++report.duplicates;
    report.duplicate_length += result.length(edge);
    if (result.edges.back().from != edge.from) ++report.opposed_duplicates;
  }
  return result;
}

}  // namespace krepl::river
