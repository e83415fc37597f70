#pragma once

#include <span>
#include <string>
#include <vector>

#include "krepl/offset.hpp"
#include "output/dxf_document.hpp"
#include "output/linear.hpp"
#include "output/zone_curves.hpp"

/// Curves of segments and arcs of either sense, as formats take them.
namespace krepl::output {

using CurvePiece = OffsetCurve::Piece;

/// The arc as zones have it: counter-clockwise.
Zone::Piece as_zone_piece(const CurvePiece& piece);
/// False for segments, and for arcs that no double lies on.
bool is_arc(const CurvePiece& piece);
/// Turned round where the arc is clockwise.
std::vector<Point> in_sense(const CurvePiece& piece, std::vector<Point> points);

std::vector<CurveRun> runs_of(std::span<const CurvePiece> pieces);
std::vector<Point> chords_of(std::span<const CurvePiece> pieces, Linearizer& linearizer);
/// All vertices; the last one is left out where the curve is closed.
std::vector<DxfDocument::Vertex> bulges_of(std::span<const CurvePiece> pieces, bool closed);
/// WKT: a LINESTRING, CIRCULARSTRING or COMPOUNDCURVE, and a line end.
std::string wkt_of(std::span<const CurvePiece> pieces);

}  // namespace krepl::output
