// GeoPackage: the subdivision as layers faces, edges and vertices, with its topology in columns. Numbers are those of the JSON
// form; half-edges 2e and 2e + 1 belong to edge e.
#include <ogrsf_frmts.h>

#include <algorithm>

#include "ogr/message_capture.hpp"
#include "output/atomic_file.hpp"
#include "output/ogr_options.hpp"
#include "output/surface_mesh.hpp"
#include "output/surface_writers.hpp"

namespace krepl::output {

namespace {

using Index = Surface::Index;
using Fields = std::initializer_list<std::pair<const char*, OGRFieldType>>;

class SurfaceGeoPackage {
 public:
  SurfaceGeoPackage(const Surface& surface, const BorderVertices& border, const std::string& crs,
                    const Context& context)
      : surface_(surface),
        topology_(surface.subdivision()),
        border_(border),
        features_(visible_features(surface)),
        crs_text_(crs),
        context_(context),
        total_(topology_.face_count() + topology_.edge_count() + topology_.vertex_count) {}

  Status write(const std::string& path);
  std::size_t faces_without_polygon() const { return without_polygon_; }

 private:
  Status create(const std::string& path);
  Result<OGRLayer*> create_layer(const char* name, OGRwkbGeometryType type, Fields fields);
  template <class Fill>
  Status write_layer(OGRLayer& layer, std::size_t first, std::size_t count, Fill fill);
  void fill_face(OGRFeature& feature, Index f);
  void fill_edge(OGRFeature& feature, Index e);
  void fill_vertex(OGRFeature& feature, Index v);
  std::unique_ptr<OGRPolygon> polygon(Index f) const;
  bool add_ring(OGRPolygon& polygon, Index half_edge) const;
  void set_feature_number(OGRFeature& feature, const char* field, Index number) const;
  std::string place_of(Index feature) const;
  template <class Curve>
  void add_point(Curve& curve, Point3 p) const {
    const Point3 o = surface_.terrain().origin();
    curve.addPoint(p.x + o.x, p.y + o.y, p.z + o.z);
  }
  Error failure() const {
    return messages_.error(ErrorCode::io, "cannot be written", "", "free some space or choose another place");
  }

  const Surface& surface_;
  const Subdivision& topology_;
  const BorderVertices& border_;
  const std::vector<Index> features_;
  const std::string& crs_text_;
  const Context& context_;
  const std::size_t total_;
  std::size_t done_ = 0, without_polygon_ = 0;
  ogr::MessageCapture messages_;
  OGRSpatialReference crs_;
  std::unique_ptr<GDALDataset> dataset_;
  std::vector<Index> outgoing_;  // per vertex: a half-edge
};

Status SurfaceGeoPackage::create(const std::string& path) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  if (driver == nullptr) return failure();
  dataset_.reset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset_) return failure();
  if (crs_text_.empty()) {
    crs_.SetLocalCS("Undefined Cartesian SRS");
  } else {
    crs_.importFromWkt(crs_text_.c_str());
    crs_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  }
  return std::monostate{};
}

Result<OGRLayer*> SurfaceGeoPackage::create_layer(const char* name, OGRwkbGeometryType type, Fields fields) {
  OGRLayer* layer = dataset_->CreateLayer(name, &crs_, type, nullptr);
  if (layer == nullptr) return failure();
  for (const auto& [field_name, field_type] : fields) {
    OGRFieldDefn field(field_name, field_type);
    if (layer->CreateField(&field) != OGRERR_NONE) return failure();
  }
  return layer;
}

template <class Fill>
Status SurfaceGeoPackage::write_layer(OGRLayer& layer, std::size_t first, std::size_t count, Fill fill) {
  for (std::size_t i = first; i < count; ++i, ++done_) {
    if (context_.cancelled()) return surface_interrupted();
    if (context_.progress && done_ % 4096 == 0) context_.progress(double(done_) / double(total_));
    OGRFeature feature(layer.GetLayerDefn());
    fill(feature, Index(i));
    messages_.clear();
    if (layer.CreateFeature(&feature) != OGRERR_NONE || messages_.failed()) return failure();
  }
  return std::monostate{};
}

void SurfaceGeoPackage::set_feature_number(OGRFeature& feature, const char* field, Index number) const {
  if (number == Surface::none) return;
  const auto at = std::lower_bound(features_.begin(), features_.end(), number);
  feature.SetField(field, static_cast<GIntBig>(at - features_.begin()));
}

/// The input points of a feature as text: x y z, x y z.
std::string SurfaceGeoPackage::place_of(Index feature) const {
  const Terrain::Corners corners = surface_.terrain().corners(feature);
  const Point3 o = surface_.terrain().origin();
  std::string text;
  for (int i = 0; i < corners.count; ++i) {
    const Point3 p = corners.point[std::size_t(i)];
    text += fmt::format("{}{} {} {}", i == 0 ? "" : ", ", p.x + o.x, p.y + o.y, p.z + o.z);
  }
  return text;
}

bool SurfaceGeoPackage::add_ring(OGRPolygon& polygon, Index half_edge) const {
  const std::vector<BorderVertices::Index> loop = border_.loop(half_edge);
  if (loop.size() < 3) return false;
  auto ring = std::make_unique<OGRLinearRing>();
  for (const BorderVertices::Index v : loop) add_point(*ring, border_.vertex(v));
  ring->closeRings();
  polygon.addRingDirectly(ring.release());
  return true;
}

std::unique_ptr<OGRPolygon> SurfaceGeoPackage::polygon(Index f) const {
  auto polygon = std::make_unique<OGRPolygon>();
  if (!add_ring(*polygon, topology_.face_outer[f])) return nullptr;
  for (const Index h : topology_.inner_loops(f)) add_ring(*polygon, h);
  return polygon;
}

void SurfaceGeoPackage::fill_face(OGRFeature& feature, Index f) {
  feature.SetField("face", static_cast<GIntBig>(f));
  feature.SetField("outer", static_cast<GIntBig>(topology_.face_outer[f]));
  feature.SetField("inner", fmt::format("{}", fmt::join(topology_.inner_loops(f), " ")).c_str());
  feature.SetField("radius", surface_.radius());
  const Index patch = surface_.face_feature(f);
  if (patch == Surface::none) {
    feature.SetField("kind", "hole");
    return;
  }
  feature.SetField("kind", name_of(surface_.terrain().feature_kind(patch)));
  set_feature_number(feature, "feature", patch);
  feature.SetField("at", place_of(patch).c_str());
  std::unique_ptr<OGRPolygon> geometry = polygon(f);
  without_polygon_ += geometry ? 0 : 1;
  if (geometry) feature.SetGeometryDirectly(geometry.release());
}

void SurfaceGeoPackage::fill_edge(OGRFeature& feature, Index e) {
  const Surface::Edge edge = surface_.edge(e);
  const Index left = 2 * e, right = 2 * e + 1;
  feature.SetField("edge", static_cast<GIntBig>(e));
  feature.SetField("kind", name_of(edge.kind));
  feature.SetField("curve", name_of(edge.curve));
  feature.SetField("from_vertex", static_cast<GIntBig>(topology_.origin[left]));
  feature.SetField("to_vertex", static_cast<GIntBig>(topology_.origin[right]));
  feature.SetField("left_face", static_cast<GIntBig>(topology_.face[left]));
  feature.SetField("right_face", static_cast<GIntBig>(topology_.face[right]));
  feature.SetField("left_next", static_cast<GIntBig>(topology_.next[left]));
  feature.SetField("right_next", static_cast<GIntBig>(topology_.next[right]));
  set_feature_number(feature, "left_feature", edge.feature[0]);
  set_feature_number(feature, "right_feature", edge.feature[1]);
  auto line = std::make_unique<OGRLineString>();
  // A vertex on a wall is at its upper end; an edge that meets the wall further down ends there.
  const std::vector<Point3> ends = surface_.curve(e, 3);
  add_point(*line, ends.front());
  for (const Point3 p : border_.edges().inner(e)) add_point(*line, p);
  add_point(*line, ends.back());
  feature.SetGeometryDirectly(line.release());
}

void SurfaceGeoPackage::fill_vertex(OGRFeature& feature, Index v) {
  feature.SetField("vertex", static_cast<GIntBig>(v));
  feature.SetField("half_edge", static_cast<GIntBig>(outgoing_[v]));
  const Point3 p = surface_.vertex(v), o = surface_.terrain().origin();
  feature.SetGeometryDirectly(new OGRPoint(p.x + o.x, p.y + o.y, p.z + o.z));
}

Status SurfaceGeoPackage::write(const std::string& path) {
  const ScopedOption fixed_date("OGR_CURRENT_DATE", file_date("%Y-%m-%dT%H:%M:%S.000Z"));
  // AtomicFile flushes the finished file once; until then it is nobody's.
  const ScopedOption lazy("OGR_SQLITE_SYNCHRONOUS", "OFF");
  if (Status created = create(path); !created) return created;
  const bool transaction = dataset_->StartTransaction() == OGRERR_NONE;
  outgoing_.resize(topology_.vertex_count);
  for (std::size_t h = topology_.half_edge_count(); h-- > 0;) outgoing_[topology_.origin[h]] = Index(h);

  Result<OGRLayer*> layer = create_layer("faces", wkbPolygon25D,
                                         {{"face", OFTInteger64},
                                          {"kind", OFTString},
                                          {"feature", OFTInteger64},
                                          {"at", OFTString},
                                          {"outer", OFTInteger64},
                                          {"inner", OFTString},
                                          {"radius", OFTReal}});
  if (!layer) return layer.error();
  Status written = write_layer(**layer, 1, topology_.face_count(), [&](OGRFeature& row, Index f) { fill_face(row, f); });
  if (!written) return written;
  layer = create_layer("edges", wkbLineString25D,
      {{"edge", OFTInteger64}, {"kind", OFTString}, {"curve", OFTString}, {"from_vertex", OFTInteger64},
       {"to_vertex", OFTInteger64}, {"left_face", OFTInteger64}, {"right_face", OFTInteger64}, {"left_next", OFTInteger64},
       {"right_next", OFTInteger64}, {"left_feature", OFTInteger64}, {"right_feature", OFTInteger64}});
  if (!layer) return layer.error();
  written = write_layer(**layer, 0, topology_.edge_count(), [&](OGRFeature& row, Index e) { fill_edge(row, e); });
  if (!written) return written;
  layer = create_layer("vertices", wkbPoint25D, {{"vertex", OFTInteger64}, {"half_edge", OFTInteger64}});
  if (!layer) return layer.error();
  written = write_layer(**layer, 0, topology_.vertex_count, [&](OGRFeature& row, Index v) { fill_vertex(row, v); });
  if (!written) return written;

  messages_.clear();
  if (transaction && dataset_->CommitTransaction() != OGRERR_NONE) return failure();
  dataset_->FlushCache(true);
  dataset_.reset();
  if (messages_.failed()) return failure();
  return std::monostate{};
}

}  // namespace

SurfaceWriteResult write_surface_gpkg(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                      const Context& context) {
  ogr::initialise();
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const double max_error = surface_max_error(options, surface.radius());
  const Result<BorderVertices> border = BorderVertices::make(surface, max_error, context);
  if (!border) return border.error();
  SurfaceFileReport report;
  {
    SurfaceGeoPackage writer(surface, *border, options.crs, context);
    if (Status written = writer.write(file->temporary_path()); !written) return written.error();
    if (writer.faces_without_polygon() > 0) {
      report.notes.push_back(fmt::format("note: {} faces are narrower than the deviation and have no polygon; a smaller "
                                         "--max-error shows them", writer.faces_without_polygon()));
    }
  }
  if (Status committed = file->commit(); !committed) return committed.error();
  report.deviation = border->edges().deviation();
  return report;
}

}  // namespace krepl::output
