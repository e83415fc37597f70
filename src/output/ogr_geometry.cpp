#include "output/ogr_geometry.hpp"

#include <algorithm>

#include "output/zone_curves.hpp"

namespace krepl::output {

namespace {

static_assert(sizeof(OGRRawPoint) == sizeof(Point), "points are handed to OGR in bulk");

template <class Curve>
std::unique_ptr<Curve> simple_curve(const std::vector<Point>& points) {
  auto curve = std::make_unique<Curve>();
  std::vector<OGRRawPoint> raw;
  raw.reserve(points.size());
  for (const Point& p : points) raw.emplace_back(p.x, p.y);
  curve->setPoints(static_cast<int>(raw.size()), raw.data());
  return curve;
}

std::unique_ptr<OGRCurve> run_curve(const CurveRun& run) {
  if (run.arc) return simple_curve<OGRCircularString>(run.points);
  return simple_curve<OGRLineString>(run.points);
}

}  // namespace

std::unique_ptr<OGRLineString> line_geometry(std::span<const Point> points) {
  auto line = std::make_unique<OGRLineString>();
  line->setNumPoints(int(points.size()), FALSE);
  for (std::size_t i = 0; i < points.size(); ++i) line->setPoint(int(i), points[i].x, points[i].y);
  return line;
}

std::unique_ptr<OGRCompoundCurve> compound_curve(const std::vector<CurveRun>& runs) {
  auto compound = std::make_unique<OGRCompoundCurve>();
  for (const CurveRun& run : runs) compound->addCurveDirectly(run_curve(run).release());
  return compound;
}

std::unique_ptr<OGRCurve> ring_of_runs(const std::vector<CurveRun>& runs) {
  if (runs.size() == 1) return run_curve(runs.front());
  return compound_curve(runs);
}

namespace {

std::unique_ptr<OGRCurve> ring_curve(const Zone& zone, std::uint32_t ring) {
  return ring_of_runs(ring_runs(zone, ring));
}

std::unique_ptr<OGRCurvePolygon> curve_polygon(const Zone& zone, std::uint32_t p) {
  auto result = std::make_unique<OGRCurvePolygon>();
  Zone::Polygon polygon = zone.polygon(p);
  result->addRingDirectly(ring_curve(zone, polygon.outer).release());
  for (std::uint32_t hole : polygon.holes) result->addRingDirectly(ring_curve(zone, hole).release());
  return result;
}

std::unique_ptr<OGRPolygon> linear_polygon(const Zone& zone, std::uint32_t p, Linearizer& linearizer, OuterSense sense) {
  auto result = std::make_unique<OGRPolygon>();
  auto add_ring = [&](std::uint32_t ring) {
    std::vector<Point> points = linearizer.ring(zone, ring);
    if (sense == OuterSense::clockwise) std::reverse(points.begin(), points.end());
    result->addRingDirectly(simple_curve<OGRLinearRing>(points).release());
  };
  Zone::Polygon polygon = zone.polygon(p);
  add_ring(polygon.outer);
  for (std::uint32_t hole : polygon.holes) add_ring(hole);
  return result;
}

}  // namespace

std::unique_ptr<OGRCompoundCurve> piece_geometry(const Zone& zone, std::uint32_t piece) {
  Zone::Piece p = zone.piece(piece);
  CurveRun run{p.kind == Zone::Kind::arc && !is_negligible(p), {p.start, p.end}};
  if (run.arc) run.points = arc_points(p);
  return compound_curve({run});
}

std::unique_ptr<OGRGeometry> curve_geometry(const Zone& zone, const ZoneFeature& feature, bool single) {
  if (single) return curve_polygon(zone, feature.first_polygon);
  auto surface = std::make_unique<OGRMultiSurface>();
  for (std::uint32_t i = 0; i < feature.polygon_count; ++i) {
    surface->addGeometryDirectly(curve_polygon(zone, feature.first_polygon + i).release());
  }
  return surface;
}

std::unique_ptr<OGRGeometry> linear_geometry(const Zone& zone, const ZoneFeature& feature, bool single,
                                             Linearizer& linearizer, OuterSense sense) {
  if (single) return linear_polygon(zone, feature.first_polygon, linearizer, sense);
  auto surface = std::make_unique<OGRMultiPolygon>();
  for (std::uint32_t i = 0; i < feature.polygon_count; ++i) {
    surface->addGeometryDirectly(linear_polygon(zone, feature.first_polygon + i, linearizer, sense).release());
  }
  return surface;
}

}  // namespace krepl::output
