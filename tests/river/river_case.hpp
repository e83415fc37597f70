#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "krepl/river.hpp"

namespace krepl::test {

/// Lines as input of a river network; a line's feature is its place in the list.
using RiverLines = std::vector<std::vector<Point>>;

Network network_of(const RiverLines& lines);

/// Lines on a small grid of whole numbers: duplicates, overlaps, loops, spikes, crossings at vertices, repeated points.
RiverLines grid_lines(std::mt19937_64& random);
/// Lines that cross anywhere, some at coordinates far from the origin.
RiverLines free_lines(std::mt19937_64& random);

/// All that must hold whatever the input: planar by all pairs, Euler's formula, reaches between nodes and each in one
/// sub-river, sub-rivers simple and downstream, every piece on the input and running with it if `digitised`, lengths
/// that add up. `error`: distance that rounding may have moved something.
void check_rivers(const RiverNetwork& rivers, const RiverLines& lines, bool digitised, double error);

}  // namespace krepl::test
