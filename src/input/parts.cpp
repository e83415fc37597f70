#include "input/parts.hpp"

#include <cmath>

namespace krepl::input {

Status Parts::add_vertex(double x, double y, const std::string& place, std::size_t vertex) {
  if (!std::isfinite(x) || !std::isfinite(y)) {
    return Error{ErrorCode::input, "a coordinate is not a finite number", place + ", vertex " + std::to_string(vertex),
                 "correct or remove it"};
  }
  points.push_back({x, y});
  return std::monostate{};
}

void Parts::close_part(Kind part_kind, std::int64_t number) {
  begin.push_back(points.size());
  feature.push_back(number);
  kind.push_back(part_kind);
}

Status Parts::add_curve(const OGRSimpleCurve& curve, Kind part_kind, std::int64_t number, const std::string& place) {
  int count = curve.getNumPoints();
  if (count == 0) return std::monostate{};
  for (int i = 0; i < count; ++i) {
    Status added = add_vertex(curve.getX(i), curve.getY(i), place, static_cast<std::size_t>(i));
    if (!added) return added;
  }
  close_part(part_kind, number);
  return std::monostate{};
}

Status Parts::add_polygon(const OGRPolygon& polygon, std::int64_t number, const std::string& place) {
  for (const OGRLinearRing* ring : polygon) {
    if (Status added = add_curve(*ring, Kind::ring, number, place); !added) return added;
  }
  return std::monostate{};
}

Status Parts::add_linear(const OGRGeometry& geometry, std::int64_t number, const std::string& place) {
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbPoint: {
      const OGRPoint& point = *geometry.toPoint();
      if (point.IsEmpty()) return std::monostate{};
      if (Status added = add_vertex(point.getX(), point.getY(), place, 0); !added) return added;
      close_part(Kind::point, number);
      return std::monostate{};
    }
    case wkbLineString:
      return add_curve(*geometry.toLineString(), Kind::line, number, place);
    case wkbPolygon:
    case wkbTriangle:
      return add_polygon(*geometry.toPolygon(), number, place);
    case wkbMultiPoint:
    case wkbMultiLineString:
    case wkbMultiPolygon:
    case wkbGeometryCollection:
      for (const OGRGeometry* member : *geometry.toGeometryCollection()) {
        if (Status added = add_linear(*member, number, place); !added) return added;
      }
      return std::monostate{};
    default:
      return Error{ErrorCode::input, std::string("geometry of type ") + geometry.getGeometryName() + " cannot be used",
                   place, "give lines, polygons or points"};
  }
}

Status Parts::add(const OGRGeometry& geometry, std::int64_t number, const std::string& place) {
  has_height = has_height || geometry.Is3D() || geometry.IsMeasured();
  if (!geometry.hasCurveGeometry()) return add_linear(geometry, number, place);
  if (geometry.hasCurveGeometry(TRUE)) {
    return Error{ErrorCode::input, "arcs as input are not supported yet", place,
                 "turn them into lines first: ogr2ogr -nlt CONVERT_TO_LINEAR"};
  }
  // A curve type that holds straight parts only: its linear form is the same set of points.
  std::unique_ptr<OGRGeometry> linear(geometry.getLinearGeometry());
  return add_linear(*linear, number, place);
}

}  // namespace krepl::input
