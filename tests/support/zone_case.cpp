#include "support/zone_case.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "verify/obstacle.hpp"

namespace krepl::test {

namespace {

/// A compound curve of circular strings and lines.
std::string curve_text(const InputPart& part) {
  const auto put = [](Point p) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.17g %.17g", p.x, p.y);
    return std::string(buffer);
  };
  std::string t = "COMPOUNDCURVE (";
  const auto& v = part.vertices;
  auto middle = part.middles.begin();
  for (std::size_t i = 0; i + 1 < v.size(); ++i) {
    if (i > 0) t += ", ";
    const bool arc = middle != part.middles.end() && *middle == i + 1;
    t += arc ? "CIRCULARSTRING (" : "(";
    t += put(v[i]) + ", " + put(v[i + 1]);
    if (arc) t += ", " + put(v[i + 2]), ++i, ++middle;
    t += ")";
  }
  if (part.ring && !(v.front() == v.back())) t += ", (" + put(v.back()) + ", " + put(v.front()) + ")";
  return t + ")";
}

std::string coordinates(const std::vector<Point>& vertices, bool close) {
  std::string t = "(";
  char buffer[64];
  const auto add = [&](Point p) {
    std::snprintf(buffer, sizeof buffer, "%s%.17g %.17g", t.size() > 1 ? ", " : "", p.x, p.y);
    t += buffer;
  };
  for (const Point& p : vertices) add(p);
  if (close && !vertices.empty() && !(vertices.front() == vertices.back())) add(vertices.front());
  return t + ")";
}

}  // namespace

std::string text(const ZoneCase& c) {
  std::string t = "GEOMETRYCOLLECTION (";
  for (std::size_t i = 0; i < c.parts.size(); ++i) {
    if (i > 0) t += ", ";
    const InputPart& part = c.parts[i];
    if (!part.middles.empty()) {
      t += part.ring ? "CURVEPOLYGON (" + curve_text(part) + ")" : curve_text(part);
    } else if (part.ring) {
      t += "POLYGON (" + coordinates(part.vertices, true);
      for (; i + 1 < c.parts.size() && c.parts[i + 1].ring && c.parts[i + 1].feature == part.feature; ++i)
        t += ", " + coordinates(c.parts[i + 1].vertices, true);
      t += ")";
    } else {
      t += (part.vertices.size() == 1 ? "POINT " : "LINESTRING ") + coordinates(part.vertices, false);
    }
  }
  char radius[40];
  std::snprintf(radius, sizeof radius, ") R = %.17g", c.radius);
  t += radius;
  for (const InputPart& part : c.parts) {
    if (part.radius <= 0) continue;
    std::snprintf(radius, sizeof radius, " %.17g", part.radius);
    t += radius;
  }
  return t;
}

double largest_radius(const ZoneCase& c) {
  double largest = 0;
  for (const InputPart& part : c.parts) largest = std::max(largest, part.radius);
  return largest > 0 ? largest : c.radius;
}

ZoneCase varied(ZoneCase c) {
  static constexpr double factors[] = {1, 2, 0.5, 1, 3, 1.5};
  for (std::size_t i = 0; i < c.parts.size(); ++i)
    c.parts[i].radius = c.radius * factors[(c.parts[i].ring ? std::size_t(c.parts[i].feature) : i) % std::size(factors)];
  return c;
}

InputPart line(std::vector<Point> vertices) { return {std::move(vertices), false, -1, 0, {}}; }
InputPart curve(std::vector<Point> vertices, std::vector<std::uint32_t> middles) {
  return {std::move(vertices), false, -1, 0, std::move(middles)};
}
InputPart curve_ring(std::vector<Point> vertices, std::vector<std::uint32_t> middles, std::int64_t feature) {
  return {std::move(vertices), true, feature, 0, std::move(middles)};
}

Result<CurveNetwork> curve_network_of(const ZoneCase& c, const Context& context) {
  CurveNetwork::Builder builder;
  for (const InputPart& part : c.parts) {
    if (part.ring)
      builder.add_ring(part.vertices, part.middles, part.feature);
    else if (part.vertices.size() == 1)
      builder.add_point(part.vertices[0], part.feature);
    else
      builder.add_line(part.vertices, part.middles, part.feature);
  }
  return std::move(builder).build(context);
}

Result<Zone> curve_zone_of(const ZoneCase& c, const Context& context) {
  auto network = curve_network_of(c, context);
  if (!network) return network.error();
  auto shared = std::make_shared<const CurveNetwork>(std::move(*network));
  std::vector<double> radii;
  for (const InputPart& part : c.parts) {
    if (part.radius > 0) radii.push_back(part.radius);
  }
  return radii.empty() ? compute_zone(std::move(shared), ZoneOptions{c.radius}, context)
                       : compute_zone(std::move(shared), radii, context);
}

InputPart ring(std::vector<Point> vertices, std::int64_t feature) { return {std::move(vertices), true, feature, 0, {}}; }
InputPart point(double x, double y) { return {{{x, y}}, false, -1, 0, {}}; }

Result<Network> network_of(const ZoneCase& c, const Context& context) {
  Network::Builder builder;
  for (const InputPart& part : c.parts) {
    if (part.ring)
      builder.add_ring(part.vertices, part.feature);
    else if (part.vertices.size() == 1)
      builder.add_point(part.vertices[0], part.feature);
    else
      builder.add_line(part.vertices, part.feature);
  }
  return std::move(builder).build(context);
}

Result<Zone> zone_of(const ZoneCase& c, const Context& context) {
  Result<Network> network = network_of(c, context);
  if (!network) return network.error();
  auto shared = std::make_shared<const Network>(std::move(network).value());
  if (c.parts.front().radius <= 0) return compute_zone(std::move(shared), ZoneOptions{c.radius}, context);
  std::vector<double> radii;
  for (const InputPart& part : c.parts) {
    if (!part.vertices.empty()) radii.push_back(part.radius);
  }
  return compute_zone(std::move(shared), radii, context);
}

namespace {

input::ResultPiece plain(const Zone::Piece& piece) {
  input::ResultPiece p;
  p.start = piece.start, p.end = piece.end;
  p.arc = piece.kind == Zone::Kind::arc;
  if (!p.arc) return p;
  using Real = long double;
  const Real ux = Real(piece.start.x) - piece.center.x, uy = Real(piece.start.y) - piece.center.y;
  const Real vx = Real(piece.end.x) - piece.center.x, vy = Real(piece.end.y) - piece.center.y;
  constexpr Real two_pi = 6.283185307179586476925286766559005768L;
  Real sweep = std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
  if (sweep < 0) sweep += two_pi;
  if (piece.start == piece.end) sweep = two_pi;
  if (piece.clockwise && piece.start != piece.end) sweep -= two_pi;
  const Real dx = Real(piece.end.x) - piece.start.x, dy = Real(piece.end.y) - piece.start.y;
  const Real chord = std::hypot(dx, dy), r = piece.radius;
  const bool vast = std::abs(ux * vy - uy * vx) < 1e-13L * r * r && chord < r / 4;
  if (piece.from_arc && piece.start != piece.end && (std::abs(sweep) < two_pi / 4 || vast)) {
    // The centre may be far away, and rounded: the height above the chord, to the right of a left turn.
    const Real height = chord * chord / 4 / (r + std::sqrt((r - chord / 2) * (r + chord / 2))) * (piece.clockwise ? -1 : 1);
    p.middle = {double(piece.start.x + dx / 2 + dy / chord * height), double(piece.start.y + dy / 2 - dx / chord * height)};
    return p;
  }
  const Real c = std::cos(sweep / 2), s = std::sin(sweep / 2);
  p.middle = {double(piece.center.x + c * ux - s * uy), double(piece.center.y + s * ux + c * uy)};
  return p;
}

}  // namespace

std::vector<input::ResultPolygon> plain(const Zone& zone) {
  const auto ring_of = [&](std::uint32_t r) {
    input::ResultRing ring;
    for (std::uint32_t e = zone.ring_begin(r); e < zone.ring_begin(r + 1); ++e)
      ring.pieces.push_back(plain(zone.piece(e)));
    return ring;
  };
  std::vector<input::ResultPolygon> polygons;
  for (std::uint32_t p = 0; p < zone.polygon_count(); ++p) {
    const Zone::Polygon polygon = zone.polygon(p);
    polygons.push_back({ring_of(polygon.outer), {}});
    for (const std::uint32_t hole : polygon.holes) polygons.back().holes.push_back(ring_of(hole));
  }
  return polygons;
}

namespace {

std::optional<std::string> fault_in(const Result<verify::ZoneReport>& report) {
  if (!report) return "not checked: " + report.error().text();
  for (const verify::Check& check : report->checks) {
    if (check.ok()) continue;
    char buffer[300];
    std::snprintf(buffer, sizeof buffer, "%s: %llu of %llu wrong, worst %.3g (allowed %.3g) at (%.17g, %.17g) %s",
                  check.name.c_str(), (unsigned long long)check.violations, (unsigned long long)check.tested,
                  check.worst, check.limit, check.where.x, check.where.y, check.note.c_str());
    return buffer;
  }
  return std::nullopt;
}

std::optional<std::string> difference_in_measures(const Zone& zone, const verify::ZoneReport& report, double step) {
  // Written coordinates are rounded, by half a step an end.
  if (!(std::abs(zone.area() - report.area) <= 1e-9 * report.area + 2 * step * report.perimeter))
    return "Zone::area() differs from the area of its pieces";
  if (!(std::abs(zone.perimeter() - report.perimeter) <=
        1e-9 * report.perimeter + 4 * step * double(zone.piece_count())))
    return "Zone::perimeter() differs from the length of its pieces";
  return std::nullopt;
}

}  // namespace

std::optional<std::string> fault_in(const Zone& zone, const ZoneCase& c, double effort) {
  if (const auto wrong = zone.validate()) return "not valid: " + *wrong;
  verify::ZoneCheckOptions options;
  options.radius = largest_radius(c), options.effort = effort;
  const verify::Obstacle obstacle(c.parts, options.radius);
  const auto report = verify::check_zone(plain(zone), obstacle, options, Context{1, {}, nullptr});
  if (auto fault = fault_in(report)) return fault;
  return difference_in_measures(zone, *report, double(obstacle.resolution()));
}

Result<Zone> shape_of(const ZoneCase& c, const ShapeOptions& options) {
  Result<Network> network = network_of(c);
  if (!network) return network.error();
  return compute_shape(std::make_shared<const Network>(std::move(network).value()), options);
}

Result<Zone> curve_shape_of(const ZoneCase& c, const ShapeOptions& options) {
  auto network = curve_network_of(c);
  if (!network) return network.error();
  return compute_shape(std::make_shared<const CurveNetwork>(std::move(*network)), options);
}

std::optional<std::string> fault_in(const Zone& zone, const ZoneCase& c, const ShapeOptions& shape, double effort) {
  if (const auto wrong = zone.validate()) return "not valid: " + *wrong;
  verify::ZoneCheckOptions options;
  options.effort = effort, options.max_error = shape.side == Side::both ? 0 : 2 * shape.max_error;
  verify::ShapeQuestion question;
  question.distance = shape.distance, question.mitre_limit = shape.mitre_limit, question.ring = shape.ring;
  question.cap = verify::ShapeQuestion::Cap(shape.cap), question.join = verify::ShapeQuestion::Join(shape.join);
  question.side = verify::ShapeQuestion::Side(shape.side);
  const auto report = verify::check_shape(plain(zone), c.parts, question, options, Context{1, {}, nullptr});
  if (auto fault = fault_in(report)) return fault;
  return difference_in_measures(zone, *report, double(verify::Obstacle(c.parts).resolution()));
}

std::string text(const ShapeOptions& o) {
  static constexpr const char* caps[] = {"round", "flat", "square"};
  static constexpr const char* joins[] = {"round", "mitre", "bevel"};
  static constexpr const char* sides[] = {"both", "left", "right"};
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, "--radius %.17g --cap %s --join %s --mitre-limit %g --side %s%s", o.distance,
                caps[int(o.cap)], joins[int(o.join)], o.mitre_limit, sides[int(o.side)], o.ring ? " --ring" : "");
  return buffer;
}

std::optional<std::string> fault_in(const ZoneCase& c, double effort) {
  const Result<Zone> zone = zone_of(c);
  if (!zone) return "no zone: " + zone.error().text();
  return fault_in(*zone, c, effort);
}

std::ostream& operator<<(std::ostream& out, const RingCounts& c) {
  return out << c.outer << " outer rings, " << c.holes << " holes";
}

}  // namespace krepl::test
