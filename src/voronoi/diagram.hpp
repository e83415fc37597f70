#pragma once

#include <optional>
#include <string>
#include <vector>

#include "krepl/error.hpp"
#include "voronoi/faces.hpp"

namespace krepl::voronoi {

/// How the faces came about. Printed by `krepl --verbose`.
struct DiagramCounters {
  std::uint64_t faces = 0, candidates = 0, searched = 0;
  std::uint64_t faces_in_pairs = 0;         ///< done again because neighbours disagreed in double precision
  std::uint64_t faces_in_quadruple = 0;     ///< of them, done again because that did not settle it
  std::uint64_t faces_in_widest = 0;        ///< of them, done once more in 320 bits
  std::uint64_t vertices_in_quadruple = 0;  ///< evaluated again because the faces around them disagreed on the place
  std::uint64_t links_reconciled = 0;       ///< too short even for quadruple precision: seen from one side only
  std::uint64_t rounds = 0;                 ///< of doing faces again until all agreed
};

/// The faces of all elements, put together. Links (half-edges) of face e are begin[e] .. begin[e+1), counter-clockwise,
/// from the site's start to its end (an isolated vertex: all around).
struct Diagram {
  std::vector<Index> begin;
  std::vector<Index> label;       // the face on the other side; none: the horizon
  std::vector<Index> twin;        // the same link seen from there; none: there is none
  std::vector<Index> vertex;      // where the link ends
  std::vector<double> minimum;    // the least clearance along the link, at most that of its ends
  std::vector<Point> place;       // per vertex
  std::vector<double> clearance;  // per vertex
  DiagramCounters counters;

  Index face_count() const { return Index(begin.size() - 1); }
  Index link_count() const { return Index(label.size()); }
};

/// Computes all faces in parallel and puts them together; faces that disagree with a neighbour are done again more
/// precisely. ErrorCode::computation names the place where neighbours still disagree, or says that there were more
/// candidates than VoronoiOptions::most_candidates allows.
Result<Diagram> build_diagram(const Sites& sites, const SiteBoxes& boxes, std::uint64_t most_candidates,
                              const Context& context);

/// Twins are mutual and bound by the same vertices, borders are closed, what has no neighbour lies at the horizon.
/// Returns what is wrong, or nothing.
std::optional<std::string> validate(const Diagram& diagram, double horizon);

}  // namespace krepl::voronoi
