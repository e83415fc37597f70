// The connected components of free space as polygons.
#include <algorithm>
#include <cmath>
#include <memory>

#include "output/component_file.hpp"
#include "output/feature_file.hpp"
#include "output/ogr_geometry.hpp"
#include "output/zone_curves.hpp"

namespace krepl::output {

namespace {

struct Component {
  std::uint32_t face;
  double number, area;
};

class ComponentWriter {
 public:
  ComponentWriter(const Zone& zone, double max_error) : zone_(zone), linearizer_(zone.radius(), max_error) { collect(); }

  Result<std::optional<ZoneRow>> next(const GeometryStyle& style) {
    if (at_ == components_.size()) return std::optional<ZoneRow>();
    const Component& component = components_[at_++];
    ZoneRow row;
    row.geometry = style.curves ? curves(component) : chords(component, style.sense);
    row.values = {component.number, component.area};
    row.deviation = style.curves ? 0 : linearizer_.deviation();
    return std::optional<ZoneRow>(std::move(row));
  }

 private:
  static std::uint32_t piece_of(Subdivision::Index half_edge) { return Subdivision::edge(half_edge); }

  void collect() {
    const Subdivision& s = zone_.subdivision();
    ring_of_.resize(zone_.piece_count());
    std::vector<double> ring_area(zone_.ring_count());
    for (std::uint32_t ring = 0; ring < zone_.ring_count(); ++ring) {
      std::fill(ring_of_.begin() + zone_.ring_begin(ring), ring_of_.begin() + zone_.ring_begin(ring + 1), ring);
      ring_area[ring] = measure_ring(zone_, ring).area;
      for (std::uint32_t e = zone_.ring_begin(ring); e < zone_.ring_begin(ring + 1); ++e) {
        const Point p = zone_.piece(e).start;
        west_ = std::min(west_, p.x), east_ = std::max(east_, p.x);
        south_ = std::min(south_, p.y), north_ = std::max(north_, p.y);
      }
    }
    // Arcs bulge over their ends by the radius at most.
    const double margin = 2 * zone_.radius();
    west_ -= margin, east_ += margin, south_ -= margin, north_ += margin;
    const auto area = [&](std::uint32_t face, double whole) {
      for (const Subdivision::Index h : s.inner_loops(face)) whole -= ring_area[ring_of_[piece_of(h)]];
      return whole;
    };
    components_.push_back({0, 0, area(0, (east_ - west_) * (north_ - south_))});
    for (std::uint32_t ring = 0; ring < zone_.ring_count(); ++ring) {
      if (!zone_.ring_is_hole(ring)) continue;
      const std::uint32_t face = s.face[2 * zone_.ring_begin(ring) + 1];
      components_.push_back({face, double(components_.size()), area(face, -ring_area[ring])});
    }
  }

  std::vector<Point> frame() const {
    return {{west_, south_}, {east_, south_}, {east_, north_}, {west_, north_}, {west_, south_}};
  }

  /// The rings of a component, the outer one first; nothing stands for the frame of the unbounded one.
  std::vector<std::optional<std::uint32_t>> rings(const Component& component) const {
    const Subdivision& s = zone_.subdivision();
    std::vector<std::optional<std::uint32_t>> rings(1);
    if (component.face != 0) rings[0] = ring_of_[piece_of(s.face_outer[component.face])];
    for (const Subdivision::Index h : s.inner_loops(component.face)) rings.push_back(ring_of_[piece_of(h)]);
    return rings;
  }

  /// The zone's rings have the zone on their left: here all of them run the other way.
  std::unique_ptr<OGRGeometry> curves(const Component& component) const {
    auto polygon = std::make_unique<OGRCurvePolygon>();
    for (const auto& ring : rings(component)) {
      if (!ring) {
        polygon->addRingDirectly(line_geometry(frame()).release());
        continue;
      }
      std::vector<CurveRun> runs = ring_runs(zone_, *ring);
      std::reverse(runs.begin(), runs.end());
      for (CurveRun& run : runs) std::reverse(run.points.begin(), run.points.end());
      polygon->addRingDirectly(ring_of_runs(runs).release());
    }
    auto surface = std::make_unique<OGRMultiSurface>();
    surface->addGeometryDirectly(polygon.release());
    return surface;
  }

  std::unique_ptr<OGRGeometry> chords(const Component& component, OuterSense sense) {
    auto polygon = std::make_unique<OGRPolygon>();
    for (const auto& ring : rings(component)) {
      std::vector<Point> points = ring ? linearizer_.ring(zone_, *ring) : frame();
      const bool as_wanted = sense == OuterSense::counter_clockwise;
      if (ring.has_value() == as_wanted) std::reverse(points.begin(), points.end());
      auto line = std::make_unique<OGRLinearRing>();
      line->setNumPoints(int(points.size()), FALSE);
      for (int i = 0; i < int(points.size()); ++i) line->setPoint(i, points[std::size_t(i)].x, points[std::size_t(i)].y);
      polygon->addRingDirectly(line.release());
    }
    auto many = std::make_unique<OGRMultiPolygon>();
    many->addGeometryDirectly(polygon.release());
    return many;
  }

  const Zone& zone_;
  Linearizer linearizer_;
  std::vector<std::uint32_t> ring_of_;
  std::vector<Component> components_;
  std::size_t at_ = 0;
  double west_ = HUGE_VAL, east_ = -HUGE_VAL, south_ = HUGE_VAL, north_ = -HUGE_VAL;
};

}  // namespace

Result<ZoneFileReport> write_components(const std::string& path, const Zone& zone, const ZoneFormat& format,
                                        const ZoneFileOptions& options) {
  if (!holds_features(format))
    return Error{ErrorCode::usage, format.name + " holds no features", "", "give .gpkg, .fgb, .geojson, .wkt or .shp"};
  const double max_error = options.max_error > 0 ? options.max_error : zone.radius() / 1000;
  if (max_error < Linearizer::finest(zone.radius()))
    return Error{ErrorCode::usage, "--max-error is too small for the radius", "", "give at least 1e-12 of the radius"};
  ComponentWriter writer(zone, max_error);
  const FeatureColumns columns{nullptr, {}, {{"component", OFTInteger64}, {"area", OFTReal}}};
  return write_features(path, format, options.crs, columns, [&](const GeometryStyle& style) { return writer.next(style); });
}

}  // namespace krepl::output
