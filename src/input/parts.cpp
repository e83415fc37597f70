#include "input/parts.hpp"

#include <algorithm>
#include <cmath>

#include "input/arc_chords.hpp"

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

Status Parts::add_arcs(const OGRSimpleCurve& string, const std::string& place) {
  constexpr double most = 0x1p28;  // vertices that a network takes
  if (string.getNumPoints() % 2 == 0) {
    return Error{ErrorCode::input, "a circular string has an even number of points", place,
                 "give end, middle, end, middle, end"};
  }
  for (int i = 1; i + 1 < string.getNumPoints(); i += 2) {
    const Point start = points.back(), between{string.getX(i), string.getY(i)}, end{string.getX(i + 1), string.getY(i + 1)};
    if (Status added = add_vertex(between.x, between.y, place, static_cast<std::size_t>(i)); !added) return added;
    if (!(arc_error > 0)) {
      middle.push_back(points.size() - 1);
    } else if (const auto arc = ArcChords::through(start, between, end)) {
      points.pop_back();
      const double count = arc->count(arc_error);
      if (static_cast<double>(points.size()) + count > most) {
        return Error{ErrorCode::input, "the arcs need more than 2^28 chords", place, "give a larger --arc-error"};
      }
      arc->append_inner_ends(static_cast<std::size_t>(count), points);
      ++arcs;
      arc_deviation = std::max(arc_deviation, arc->deviation(count));
    }
    if (Status added = add_vertex(end.x, end.y, place, static_cast<std::size_t>(i) + 1); !added) return added;
  }
  return std::monostate{};
}

Status Parts::add_vertices(const OGRCurve& curve, const std::string& place) {
  if (wkbFlatten(curve.getGeometryType()) == wkbCompoundCurve) {
    for (const OGRCurve* member : *curve.toCompoundCurve()) {
      if (Status added = add_vertices(*member, place); !added) return added;
    }
    return std::monostate{};
  }
  const OGRSimpleCurve& simple = *curve.toSimpleCurve();
  if (simple.getNumPoints() == 0) return std::monostate{};
  const bool goes_on = points.size() > begin.back() && points.back() == Point{simple.getX(0), simple.getY(0)};
  if (!goes_on) {
    if (Status added = add_vertex(simple.getX(0), simple.getY(0), place, 0); !added) return added;
  }
  if (wkbFlatten(curve.getGeometryType()) == wkbCircularString) return add_arcs(simple, place);
  for (int i = 1; i < simple.getNumPoints(); ++i) {
    if (Status added = add_vertex(simple.getX(i), simple.getY(i), place, static_cast<std::size_t>(i)); !added)
      return added;
  }
  return std::monostate{};
}

Status Parts::close_curve(const OGRCurve& curve, Kind part_kind, std::int64_t number, const std::string& place) {
  if (Status added = add_vertices(curve, place); !added) return added;
  if (points.size() > begin.back()) close_part(part_kind, number);
  return std::monostate{};
}

Status Parts::add_curved(const OGRGeometry& geometry, std::int64_t number, const std::string& place) {
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbCircularString:
    case wkbCompoundCurve:
      return close_curve(*geometry.toCurve(), Kind::line, number, place);
    case wkbCurvePolygon:
      for (const OGRCurve* ring : *geometry.toCurvePolygon()) {
        if (Status added = close_curve(*ring, Kind::ring, number, place); !added) return added;
      }
      return std::monostate{};
    case wkbMultiCurve:
    case wkbMultiSurface:
    case wkbGeometryCollection:
      for (const OGRGeometry* member : *geometry.toGeometryCollection()) {
        if (Status added = add_curved(*member, number, place); !added) return added;
      }
      return std::monostate{};
    default:
      return add_linear(geometry, number, place);
  }
}

std::vector<std::uint32_t> Parts::middles_of(std::size_t i) const {
  std::vector<std::uint32_t> own;
  for (auto m = std::lower_bound(middle.begin(), middle.end(), begin[i]); m != middle.end() && *m < begin[i + 1]; ++m)
    own.push_back(static_cast<std::uint32_t>(*m - begin[i]));
  return own;
}

Status Parts::add(const OGRGeometry& geometry, std::int64_t number, const std::string& place) {
  has_height = has_height || geometry.Is3D() || geometry.IsMeasured();
  if (geometry.hasCurveGeometry(TRUE) && !(arc_error > 0) && !keep_arcs) {
    return Error{ErrorCode::input, "arcs of the input cannot stay arcs here", place,
                 "give --arc-error LENGTH for chords in their place that deviate by no more"};
  }
  return geometry.hasCurveGeometry() ? add_curved(geometry, number, place) : add_linear(geometry, number, place);
}

}  // namespace krepl::input
