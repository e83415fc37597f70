#include "output/owner_geometry.hpp"

#include <algorithm>
#include <cmath>

#include "output/zone_curves.hpp"

namespace krepl::output {

namespace {

Zone::Piece piece_of(const OwnerZone::Curve& arc) {
  const double radius = std::hypot(arc.points.front().x - arc.center.x, arc.points.front().y - arc.center.y);
  return {Zone::Kind::arc, arc.points.front(), arc.points.back(), arc.center, 0, false, radius};
}

bool is_arc(const OwnerZone::Curve& curve) {
  return curve.kind == OwnerZone::Kind::arc && !is_negligible(piece_of(curve));
}

std::vector<CurveRun> runs_of(const OwnerZone::Ring& ring) {
  std::vector<CurveRun> runs;
  for (const OwnerZone::Curve& curve : ring.curves) {
    const bool arc = is_arc(curve);
    if (runs.empty() || runs.back().arc != arc) runs.push_back({arc, {curve.points.front()}});
    const std::vector<Point> along = arc ? arc_points(piece_of(curve)) : curve.points;
    runs.back().points.insert(runs.back().points.end(), along.begin() + 1, along.end());
  }
  return runs;
}

std::vector<Point> chords_of(const OwnerZone::Ring& ring, Linearizer& linearizer) {
  std::vector<Point> points{ring.curves.front().points.front()};
  for (const OwnerZone::Curve& curve : ring.curves) {
    if (is_arc(curve)) {
      linearizer.append_arc(piece_of(curve), points);
    } else {
      points.insert(points.end(), curve.points.begin() + 1, curve.points.end());
    }
  }
  return points;
}

}  // namespace

std::unique_ptr<OGRGeometry> owner_curve_geometry(const OwnerZone& zone) {
  auto surface = std::make_unique<OGRMultiSurface>();
  for (const OwnerZone::Polygon& polygon : zone.polygons) {
    auto part = std::make_unique<OGRCurvePolygon>();
    part->addRingDirectly(ring_of_runs(runs_of(polygon.outer)).release());
    for (const OwnerZone::Ring& hole : polygon.holes) part->addRingDirectly(ring_of_runs(runs_of(hole)).release());
    surface->addGeometryDirectly(part.release());
  }
  return surface;
}

std::unique_ptr<OGRGeometry> owner_linear_geometry(const OwnerZone& zone, Linearizer& linearizer, OuterSense sense) {
  auto surface = std::make_unique<OGRMultiPolygon>();
  const auto add = [&](OGRPolygon& part, const OwnerZone::Ring& ring) {
    std::vector<Point> points = chords_of(ring, linearizer);
    if (sense == OuterSense::clockwise) std::reverse(points.begin(), points.end());
    auto line = std::make_unique<OGRLinearRing>();
    line->setNumPoints(int(points.size()), FALSE);
    for (std::size_t i = 0; i < points.size(); ++i) line->setPoint(int(i), points[i].x, points[i].y);
    part.addRingDirectly(line.release());
  };
  for (const OwnerZone::Polygon& polygon : zone.polygons) {
    auto part = std::make_unique<OGRPolygon>();
    add(*part, polygon.outer);
    for (const OwnerZone::Ring& hole : polygon.holes) add(*part, hole);
    surface->addGeometryDirectly(part.release());
  }
  return surface;
}

}  // namespace krepl::output
