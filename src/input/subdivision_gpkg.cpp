// The subdivision of a surface as GeoPackage layers faces, edges and vertices (docs/formats.md).
#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "input/subdivision_file.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

using File = SubdivisionFile;
using Index = File::Index;
using Dataset = std::unique_ptr<GDALDataset>;

constexpr const char* remedy = "give a surface that krepl terrain wrote as .gpkg";
constexpr std::size_t samples_of_radius = 1001;

Dataset open_quietly(const std::string& path) {
  ogr::initialise();
  const ogr::MessageCapture ignored;
  return Dataset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
}

Error fault(const std::string& what, const std::string& where) { return {ErrorCode::input, what, where, remedy}; }

/// Numbers in a text, separated by anything else.
template <class T>
std::vector<T> numbers_in(const char* text) {
  std::vector<T> numbers;
  const char* const end = text + std::char_traits<char>::length(text);
  for (const char* at = text; at < end;) {
    T value{};
    const auto [after, wrong] = std::from_chars(at, end, value);
    if (wrong == std::errc()) numbers.push_back(value);
    at = wrong == std::errc() ? after : at + 1;
  }
  return numbers;
}

/// A row of a layer by the names of its columns.
class Row {
 public:
  Row(const OGRFeature& feature, std::string layer) : feature_(feature), layer_(std::move(layer)) {}

  std::string place() const { return fmt::format("layer {}, feature {}", layer_, feature_.GetFID()); }
  const char* text(const char* column) const { return feature_.GetFieldAsString(number(column)); }
  /// Null where the column is empty, missing or no index.
  Index index(const char* column) const {
    const int i = number(column);
    if (i < 0 || !feature_.IsFieldSetAndNotNull(i)) return File::none;
    const GIntBig value = feature_.GetFieldAsInteger64(i);
    return value >= 0 && value < GIntBig{File::none} ? Index(value) : File::none;
  }
  std::optional<double> real(const char* column) const {
    const int i = number(column);
    if (i < 0 || !feature_.IsFieldSetAndNotNull(i)) return std::nullopt;
    return feature_.GetFieldAsDouble(i);
  }
  const OGRGeometry* geometry() const { return feature_.GetGeometryRef(); }

 private:
  int number(const char* column) const { return feature_.GetFieldIndex(column); }
  const OGRFeature& feature_;
  const std::string layer_;
};

class GeoPackageReader {
 public:
  GeoPackageReader(GDALDataset& dataset, const Context& context) : dataset_(dataset), context_(context) {}

  Result<File> read() {
    Status done = each("vertices", [&](const Row& row) { return vertex(row); });
    if (done) done = each("edges", [&](const Row& row) { return edge(row); });
    if (done) done = each("faces", [&](const Row& row) { return face(row); });
    if (done) done = finish_features();
    if (done) done = find_radius();
    if (!done) return done.error();
    return std::move(file_);
  }

 private:
  template <class F>
  Status each(const char* name, F&& take) {
    OGRLayer* layer = dataset_.GetLayerByName(name);
    if (layer == nullptr) return fault(fmt::format("there is no layer '{}'", name), "");
    std::size_t count = 0;
    for (const auto& feature : *layer) {
      if (count++ % 4096 == 0 && context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
      if (Status taken = take(Row(*feature, name)); !taken) return taken;
    }
    return std::monostate{};
  }

  Status vertex(const Row& row) {
    if (row.index("vertex") != file_.vertices.size()) return fault("vertices are not numbered from 0 on", row.place());
    const OGRGeometry* at = row.geometry();
    if (at == nullptr || wkbFlatten(at->getGeometryType()) != wkbPoint)
      return fault("a vertex without a point", row.place());
    file_.vertices.push_back({at->toPoint()->getX(), at->toPoint()->getY(), at->toPoint()->getZ()});
    return std::monostate{};
  }

  template <class Kind>
  static bool word(const char* text, std::initializer_list<const char*> words, Kind& kind) {
    int i = 0;
    for (const char* w : words) {
      if (std::string_view(text) == w) return kind = Kind(i), true;
      ++i;
    }
    return false;
  }

  Status edge(const Row& row) {
    const auto e = Index(file_.edges.size());
    if (row.index("edge") != e) return fault("edges are not numbered from 0 on", row.place());
    File::Edge edge{{}, {}, {row.index("left_feature"), row.index("right_feature")}, file_.points.size()};
    if (!word(row.text("kind"), {"seam", "valley", "rim"}, edge.kind) ||
        !word(row.text("curve"), {"line", "circle", "ellipse", "quartic"}, edge.curve))
      return fault("an edge without kind or curve", row.place());
    const OGRGeometry* line = row.geometry();
    if (line == nullptr || wkbFlatten(line->getGeometryType()) != wkbLineString ||
        line->toLineString()->getNumPoints() < 2)
      return fault("an edge without a line", row.place());
    for (const OGRPoint& p : *line->toLineString()) file_.points.push_back({p.getX(), p.getY(), p.getZ()});
    file_.half_edges.push_back(
        {row.index("from_vertex"), 2 * e + 1, row.index("left_next"), row.index("left_face"), e});
    file_.half_edges.push_back({row.index("to_vertex"), 2 * e, row.index("right_next"), row.index("right_face"), e});
    file_.edges.push_back(edge);
    return std::monostate{};
  }

  Status face(const Row& row) {
    if (const std::optional<double> radius = row.real("radius")) file_.radius = *radius;
    // The outside is not in the layer.
    if (file_.faces.empty()) file_.faces.push_back({File::none, File::none, 0});
    if (row.index("face") != file_.faces.size()) return fault("faces are not numbered from 1 on", row.place());
    file_.faces.push_back({row.index("feature"), row.index("outer"), file_.inner.size()});
    for (const Index h : numbers_in<Index>(row.text("inner"))) file_.inner.push_back(h);
    if (file_.faces.back().feature == File::none) return std::monostate{};
    const std::vector<double> at = numbers_in<double>(row.text("at"));
    if (at.size() != 3 && at.size() != 6 && at.size() != 9)
      return fault("a face without the points of its feature", row.place());
    File::Feature feature{{}, int(at.size() / 3)};
    for (std::size_t i = 0; i < at.size() / 3; ++i) feature.at[i] = {at[3 * i], at[3 * i + 1], at[3 * i + 2]};
    features_.emplace(file_.faces.back().feature, feature);
    return std::monostate{};
  }

  Status finish_features() {
    const std::size_t most = file_.faces.size() + 2 * file_.edges.size();
    for (const auto& [number, feature] : features_) {
      if (number >= most) return fault(fmt::format("a feature has the number {}", number), "layer faces");
      file_.features.resize(number, File::Feature{{}, 1});  // what has no face is not asked for
      file_.features.push_back(feature);
    }
    return std::monostate{};
  }

  static double distance(Point3 p, const File::Feature& feature) {
    const auto minus = [](Point3 a, Point3 b) { return Point3{a.x - b.x, a.y - b.y, a.z - b.z}; };
    const auto cross = [](Point3 a, Point3 b) {
      return Point3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    const auto length = [](Point3 a) { return std::hypot(a.x, a.y, a.z); };
    const Point3 w = minus(p, feature.at[0]);
    if (feature.count == 1) return length(w);
    const Point3 d = minus(feature.at[1], feature.at[0]);
    if (feature.count == 2) return length(cross(w, d)) / length(d);
    const Point3 n = cross(d, minus(feature.at[2], feature.at[0]));
    return std::fabs(n.x * w.x + n.y * w.y + n.z * w.z) / length(n);
  }

  /// Older files do not name the radius; every vertex is that far from what the ball touches there. The median of many,
  /// in which the rounding of a single one does not matter.
  Status find_radius() {
    if (file_.radius > 0) return std::monostate{};
    std::vector<double> found;
    const std::size_t step = file_.edges.size() / samples_of_radius + 1;
    for (std::size_t e = 0; e < file_.edges.size(); e += step)
      for (std::size_t side : {0, 1}) {
        const Index f = file_.edges[e].feature[side];
        if (f < file_.features.size()) found.push_back(distance(file_.points[file_.edges[e].first], file_.features[f]));
      }
    if (found.empty()) return fault("no edge has a feature", "layer edges");
    std::nth_element(found.begin(), found.begin() + std::ptrdiff_t(found.size() / 2), found.end());
    file_.radius = found[found.size() / 2];
    return std::monostate{};
  }

  GDALDataset& dataset_;
  const Context& context_;
  File file_;
  std::map<Index, File::Feature> features_;
};

}  // namespace

bool is_subdivision_gpkg(const std::string& path) {
  const Dataset dataset = open_quietly(path);
  return dataset && dataset->GetLayerByName("faces") && dataset->GetLayerByName("edges") &&
         dataset->GetLayerByName("vertices");
}

Result<SubdivisionGeoPackage> read_subdivision_gpkg(const std::string& path, const Context& context) {
  const Dataset dataset = open_quietly(path);
  if (!dataset) return fault("is not a GeoPackage that can be read", "");
  Result<File> file = GeoPackageReader(*dataset, context).read();
  if (!file) return file.error();
  SubdivisionGeoPackage result{std::move(*file), ""};
  if (const OGRSpatialReference* crs = dataset->GetLayerByName("faces")->GetSpatialRef();
      crs != nullptr && !crs->IsLocal())
    result.crs = ogr::crs_name(*crs);
  return result;
}

}  // namespace krepl::input
