#pragma once

#include <ogr_geometry.h>

#include <memory>
#include <span>

#include "output/linear.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

std::unique_ptr<OGRLineString> line_geometry(std::span<const Point> points);

/// Runs that follow each other as a COMPOUNDCURVE.
std::unique_ptr<OGRCompoundCurve> compound_curve(const std::vector<CurveRun>& runs);

/// A closed ring: a single run as it is, several as a COMPOUNDCURVE.
std::unique_ptr<OGRCurve> ring_of_runs(const std::vector<CurveRun>& runs);

/// The piece as a COMPOUNDCURVE, so that all pieces of a layer are of one type.
std::unique_ptr<OGRCompoundCurve> piece_geometry(const Zone& zone, std::uint32_t piece);

/// A feature's polygons with true curves: a MULTISURFACE, or a CURVEPOLYGON if `single` (precondition: it has one polygon).
std::unique_ptr<OGRGeometry> curve_geometry(const Zone& zone, const ZoneFeature& feature, bool single);

/// The sense of outer rings; holes run the other way. Shapefile wants them clockwise.
enum class OuterSense { counter_clockwise, clockwise };

/// The same with chords: MULTIPOLYGON or POLYGON.
std::unique_ptr<OGRGeometry> linear_geometry(const Zone& zone, const ZoneFeature& feature, bool single,
                                             Linearizer& linearizer, OuterSense sense);

}  // namespace krepl::output
