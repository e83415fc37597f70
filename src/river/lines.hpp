#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/river.hpp"
#include "model/noding.hpp"

namespace krepl::river {

using Index = std::uint32_t;
using model::GridPoint;

/// The input's lines on the grid. No vertex is repeated at once; every line has at least two.
struct Lines {
  double pitch = 0;
  std::vector<GridPoint> vertices;
  std::vector<Index> chain;           // vertices of all lines, one line after the other
  std::vector<std::size_t> begin{0};  // per line, and the end
  std::vector<std::int64_t> feature;  // per line

  std::size_t line_count() const { return feature.size(); }
  Point place(Index vertex) const { return {double(vertices[vertex].x) * pitch, double(vertices[vertex].y) * pitch}; }
};

/// Rounds the network's lines to a grid, and welds equal vertices. The pitch is the network's resolution, or the
/// greatest power of two that is not above `grid`.
Lines take_lines(const Network& network, double grid, RiverReport& report);

/// Moves free ends of lines to other lines within `reach`; see RiverOptions::snap. Ends are treated in input order; one
/// that another end was moved to is free no more, so none is moved further than that. False if cancelled.
bool snap_ends(Lines& lines, double reach, RiverReport& report, const Context& context);

/// A piece of a river between two neighbouring vertices, in the sense of the line that it comes from.
struct Edge {
  Index from, to;
  std::int64_t feature;
};

/// Edges that meet at their ends only; each pair of vertices has at most one.
struct Edges {
  double pitch = 0;
  std::vector<GridPoint> vertices;
  std::vector<Edge> edges;  // sorted by their vertices

  Point place(Index vertex) const { return {double(vertices[vertex].x) * pitch, double(vertices[vertex].y) * pitch}; }
  double length(const Edge& e) const;
};

/// Cuts the lines where they meet and merges what coincides. Nothing if cancelled.
std::optional<Edges> node_lines(const Lines& lines, RiverReport& report, const Context& context);

}  // namespace krepl::river
