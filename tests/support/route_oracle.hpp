#pragma once

#include <optional>
#include <string>

#include "krepl/route.hpp"
#include "support/zone_case.hpp"

namespace krepl::test {

/// Distance of a place from the lines and points of a case, in extended precision, one by one; the inside of polygons
/// does not count.
long double clearance_of(const ZoneCase& c, Point p);

/// Length of the shortest route of a disk by the whole visibility graph: all common tangents of circles about all
/// vertices, each tested against all obstacles, and Dijkstra. Nothing if there is no route. Takes n^4; for n up to
/// about
/// 20. Obstacles may be nearer by `slack`.
std::optional<double> brute_shortest(const ZoneCase& c, Point from, Point to, double slack);

/// Clearance of the widest route by samples: a grid of `steps` x `steps` about the case, bottleneck path; within two
/// cells' diagonals of the truth, ends' own clearance apart only as far as the grid sees it.
double sampled_widest(const ZoneCase& c, Point from, Point to, int steps, double* cell);

/// What is wrong with a route, by brute force: pieces that do not follow one another or do not join smoothly, places
/// (on a dense sample of every piece) nearer to an obstacle than R, a clearance or length that is not that of the
/// pieces. `smooth`: joints must have no kink. Nothing if all is well.
std::optional<std::string> fault_in_route(const Route& route, const ZoneCase& c, Point from, Point to, bool smooth);

}  // namespace krepl::test
