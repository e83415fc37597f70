#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/cutter.hpp"
#include "krepl/error.hpp"
#include "krepl/simulation.hpp"
#include "krepl/terrain.hpp"
#include "krepl/tool_path.hpp"

namespace krepl::view {

/// The material that a path takes off, as the page shows it.
struct Material {
  Simulation finished;             ///< by the path
  std::vector<double> before;      ///< heights of the block when the path begins, as Simulation::left(); empty: its top
  const Terrain* part = nullptr;   ///< is kept until the page is written
};

struct PathPageData {
  std::string title;
  std::string unit;  ///< of length, short; empty if unknown
  const ToolPath* path = nullptr;
  std::vector<std::size_t> line;  ///< of each move in its program; empty if there is none
  Cutter cutter;
  const Material* material = nullptr;  ///< none: the path alone
};

struct PathPage {
  std::string html;
  std::size_t pieces = 0;  ///< straight stretches, arcs taken apart
  double minutes = 0;      ///< from the first move to the end of the last one, as the page plays them
};

/// One HTML page that plays a tool path: the tool where it is, the way behind and before it, the part, and the material as it
/// is taken off. Arcs are drawn as chords that are off by a fiftieth of a dexel, or a thousandth of the tool's radius. Rapid
/// moves are played at twice the fastest feed, since programs do not say how fast they are. The same data give the same bytes.
/// Errors: cancelled; more than 2^31 pieces; a program that was built without the page's script says so.
Result<PathPage> render_path_page(const PathPageData& data, const Context& context = {});

}  // namespace krepl::view
