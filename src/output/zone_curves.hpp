#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "krepl/zone.hpp"

namespace krepl::output {

/// A stretch of a ring of one kind. Lines: two or more points, each joined to the next. Arcs: an odd number of points,
/// end, middle, end, middle, end ...: every three consecutive ones from an end on are an arc of half a turn at most, so that
/// three rounded points still determine it well.
struct CurveRun {
  bool arc = false;
  std::vector<Point> points;
};

/// The angle that an arc piece spans, in (0, 2 pi], whichever way it runs; start == end is the full turn.
double arc_angle(const Zone::Piece& arc);

/// The point halfway along the counter-clockwise arc from `start` to `end`, without trigonometry: as far from the centre
/// as the ends are (which the engine moves outwards by some units in the last place), so that a short arc keeps its
/// bulge. Precondition: the ends differ.
Point arc_middle(Point center, Point start, Point end);

/// An arc shorter than a few units in the last place of its coordinates: no double lies between its ends, so it is
/// written as a straight piece.
bool is_negligible(const Zone::Piece& arc);

/// The arc as points of a circular string: start, (middle, end) once or, for more than half a turn, twice.
std::vector<Point> arc_points(const Zone::Piece& arc);

/// The arc cut into `2^k` equal parts of at most `largest` radians: their ends, start and end included, as it runs.
std::vector<Point> arc_ends(const Zone::Piece& arc, double largest);

/// An arc of the input, given by three places, as a piece. Nothing where they are in line.
std::optional<Zone::Piece> arc_of_input(Point start, Point middle, Point end);

double piece_length(const Zone::Piece& piece);

/// The ring as runs, alternating between lines and arcs; the last point of a run is the first of the next.
std::vector<CurveRun> ring_runs(const Zone& zone, std::uint32_t ring);

/// Area (positive for outer rings, negative for holes) and length of one ring.
struct RingMeasure {
  double area = 0, length = 0;
};
RingMeasure measure_ring(const Zone& zone, std::uint32_t ring);

}  // namespace krepl::output
