// geos_buffer: the buffer of a line network by GEOS, measured, for comparison with `krepl buffer`.
//
//   geos_buffer IN TO_CRS RADIUS RELATIVE_ERROR
//
// Reads the lines of IN through OGR, projects them to TO_CRS ("-": leaves them as they are), and has GEOS buffer them
// all at once, with so many segments to a quadrant that chords stay within RELATIVE_ERROR * RADIUS of their arcs.
// Prints one line of key=value pairs; `seconds` is the buffer call alone, `worst` the largest difference between RADIUS
// and the distance from the network to a vertex or the middle of a side of the result. Linked with GEOS (LGPL) as a
// program of its own.
#include <geos_c.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace {

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "geos_buffer: %s\n", what.c_str());
  std::exit(1);
}

void report(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::vfprintf(stderr, format, arguments);
  va_end(arguments);
  std::fputc('\n', stderr);
}

struct DestroyGeometry {
  void operator()(GEOSGeometry* g) const { GEOSGeom_destroy(g); }
};
using Geometry = std::unique_ptr<GEOSGeometry, DestroyGeometry>;

struct Lines {
  std::vector<GEOSGeometry*> parts;
  std::size_t segments = 0;
};

void add_lines(const OGRGeometry& geometry, Lines& lines) {
  if (OGR_GT_IsSubClassOf(wkbFlatten(geometry.getGeometryType()), wkbGeometryCollection)) {
    for (const OGRGeometry* member : *geometry.toGeometryCollection()) add_lines(*member, lines);
    return;
  }
  if (wkbFlatten(geometry.getGeometryType()) != wkbLineString) fail("the input holds something that is no line");
  const OGRLineString& line = *geometry.toLineString();
  const unsigned count = static_cast<unsigned>(line.getNumPoints());
  GEOSCoordSequence* points = GEOSCoordSeq_create(count, 2);
  for (unsigned i = 0; i < count; ++i)
    GEOSCoordSeq_setXY(points, i, line.getX(static_cast<int>(i)), line.getY(static_cast<int>(i)));
  lines.parts.push_back(GEOSGeom_createLineString(points));
  lines.segments += count - 1;
}

Lines read_lines(const char* path, const std::string& to_crs) {
  GDALDatasetUniquePtr data(GDALDataset::Open(path, GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (data == nullptr || data->GetLayerCount() == 0) fail(std::string(path) + " cannot be read");
  OGRLayer& layer = *data->GetLayer(0);
  std::unique_ptr<OGRCoordinateTransformation> transformation;
  if (to_crs != "-") {
    OGRSpatialReference target;
    if (target.SetFromUserInput(to_crs.c_str()) != OGRERR_NONE) fail(to_crs + " is not a coordinate system");
    target.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    transformation.reset(OGRCreateCoordinateTransformation(layer.GetSpatialRef(), &target));
    if (transformation == nullptr) fail("no way from the file's coordinate system to " + to_crs);
  }
  Lines lines;
  for (auto& feature : layer) {
    OGRGeometry* geometry = feature->GetGeometryRef();
    if (geometry == nullptr || geometry->IsEmpty()) continue;
    if (transformation != nullptr && geometry->transform(transformation.get()) != OGRERR_NONE)
      fail("projection failed");
    add_lines(*geometry, lines);
  }
  if (lines.parts.empty()) fail("no lines");
  return lines;
}

struct Shape {
  std::size_t polygons = 0, rings = 0, holes = 0, vertices = 0;
};

/// Calls `use` for every ring of a polygon or a collection of them.
void for_each_ring(const GEOSGeometry* zone, Shape& shape,
                   const std::function<void(const GEOSCoordSequence*, unsigned)>& use) {
  for (int p = 0; p < GEOSGetNumGeometries(zone); ++p) {
    const GEOSGeometry* polygon = GEOSGetGeometryN(zone, p);
    const int holes = GEOSGetNumInteriorRings(polygon);
    ++shape.polygons;
    shape.holes += static_cast<std::size_t>(holes);
    for (int h = -1; h < holes; ++h) {
      const GEOSGeometry* ring = h < 0 ? GEOSGetExteriorRing(polygon) : GEOSGetInteriorRingN(polygon, h);
      const GEOSCoordSequence* points = GEOSGeom_getCoordSeq(ring);
      unsigned count = 0;
      GEOSCoordSeq_getSize(points, &count);
      ++shape.rings;
      shape.vertices += count - 1;
      use(points, count);
    }
  }
}

/// Largest | distance to the network - radius | at vertices and middles of sides, at about 200,000 of them.
double worst_error(const GEOSGeometry* zone, const GEOSGeometry* network, double radius, std::size_t vertices) {
  const GEOSPreparedGeometry* index = GEOSPrepare(network);
  const std::size_t step = std::max<std::size_t>(1, vertices / 100000);
  double worst = 0;
  const auto test = [&](double x, double y) {
    const Geometry point(GEOSGeom_createPointFromXY(x, y));
    double distance = 0;
    if (GEOSPreparedDistance(index, point.get(), &distance) != 1) fail("distance failed");
    worst = std::max(worst, std::abs(distance - radius));
  };
  Shape ignored;
  std::size_t running = 0;
  for_each_ring(zone, ignored, [&](const GEOSCoordSequence* points, unsigned count) {
    for (unsigned i = 0; i + 1 < count; ++i) {
      if (running++ % step != 0) continue;
      double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
      GEOSCoordSeq_getXY(points, i, &x0, &y0);
      GEOSCoordSeq_getXY(points, i + 1, &x1, &y1);
      test(x0, y0);
      test((x0 + x1) / 2, (y0 + y1) / 2);
    }
  });
  GEOSPreparedGeom_destroy(index);
  return worst;
}

double number(const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end == text || *end != 0 || !(value > 0) || !std::isfinite(value))
    fail(std::string(text) + " is not a positive number");
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: geos_buffer IN TO_CRS|- RADIUS RELATIVE_ERROR\n");
    return 2;
  }
  GDALAllRegister();
  initGEOS(report, report);
  const double radius = number(argv[3]), relative = number(argv[4]);
  Lines lines = read_lines(argv[1], argv[2]);
  const Geometry network(
      GEOSGeom_createCollection(GEOS_MULTILINESTRING, lines.parts.data(), static_cast<unsigned>(lines.parts.size())));
  // A chord over an angle a is radius * (1 - cos(a / 2)) away from its arc in the middle.
  const double angle = 2 * std::acos(1 - std::min(relative, 0.5));
  const int quadrant = std::max(1, static_cast<int>(std::ceil(std::numbers::pi / 2 / angle)));

  const auto begin = std::chrono::steady_clock::now();
  const Geometry zone(GEOSBuffer(network.get(), radius, quadrant));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (zone == nullptr) fail("GEOS failed");

  Shape shape;
  for_each_ring(zone.get(), shape, [](const GEOSCoordSequence*, unsigned) {});
  double area = 0;
  GEOSArea(zone.get(), &area);
  const double worst = worst_error(zone.get(), network.get(), radius, shape.vertices);
  std::printf(
      "version=%s radius=%.17g quadrant=%d segments=%zu polygons=%zu rings=%zu holes=%zu vertices=%zu area=%.10g "
      "worst=%.4g valid=%d seconds=%.4f\n",
      GEOSversion(), radius, quadrant, lines.segments, shape.polygons, shape.rings, shape.holes, shape.vertices, area,
      worst, static_cast<int>(GEOSisValid(zone.get())), seconds);
  return 0;
}
