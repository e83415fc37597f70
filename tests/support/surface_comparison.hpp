#pragma once

#include <array>
#include <optional>
#include <string>

#include "krepl/surface.hpp"

namespace krepl::test {

/// How two surfaces of the same terrain differ as labelled maps of the plane; nothing if they do not. They are compared
/// up to
///  - the numbering of vertices, edges and faces;
///  - vertices at which one edge merely goes on as itself;
///  - vertices at which two edges that go on as themselves touch, with one label between them on both sides of the place:
///    whether what is there is one face or two is less than any tolerance tells;
///  - edges both ends of which are the same place within the tolerance: their ends count as one vertex;
///  - whether an edge is a wall or a valley where it is both within half the tolerance (a wall so low that the ball at its top
///    touches what is below; a valley all along the end of a feature): it counts as what it goes on as.
/// Equal means: vertices can be paired so that partners are the same place; around partners the same labels, kinds of
/// edge and curve, and partners at the other ends follow each other; closed edges without a vertex likewise, halfway
/// points on each other's curve; and faces correspond, with as many loops each.
///
/// Where that fails, they are compared once more up to tangency. Where curves are tangent it is known only to the root
/// of the tolerance where they part, so the ends of an edge no longer than that (times the root of the extent) count as
/// one vertex if one of them touches all that is touched around the other, within the tolerance; and vertices are
/// partners that do so mutually.
struct Comparison {
  std::optional<std::string> difference;
  bool up_to_tangency = false;       ///< equal only so, or not at all
  int tangent_vertices = 0;          ///< pairs of vertices farther apart than the tolerance
  std::array<int, 2> short_edges{};  ///< edges taken for a vertex, in the first and in the second
};
Comparison compare(const Surface& first, const Surface& second, double tolerance);

}  // namespace krepl::test
