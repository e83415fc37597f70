// The subdivision as one JSON object: the exchange form for scripts and checks. Streamed, a line an item; numbers have the
// fewest digits that read back the same.
#include <algorithm>
#include <iterator>

#include "output/surface_writers.hpp"

namespace krepl::output {

namespace {

using Index = Surface::Index;
using Text = fmt::memory_buffer;

class SurfaceJson {
 public:
  SurfaceJson(const Surface& surface, const SurfaceFileOptions& options)
      : surface_(surface), topology_(surface.subdivision()), origin_(surface.terrain().origin()), options_(options),
        features_(visible_features(surface)) {}

  Status write(OutputStream& stream, const Context& context) const;

 private:
  void put_feature(Text& text, std::size_t i) const;
  void put_edge(Text& text, std::size_t e) const;
  void put_half_edge(Text& text, std::size_t h) const;
  void put_face(Text& text, std::size_t f) const;
  void put_feature_number(Text& text, Index feature) const;
  void put_point(Text& text, Point3 p) const {
    fmt::format_to(std::back_inserter(text), "[{},{},{}]", p.x + origin_.x, p.y + origin_.y, p.z + origin_.z);
  }
  template <class Points>
  void put_points(Text& text, const Points& points, std::size_t count) const;

  const Surface& surface_;
  const Subdivision& topology_;
  const Point3 origin_;
  const SurfaceFileOptions& options_;
  const std::vector<Index> features_;  // the file numbers them anew
};

void put(Text& text, std::string_view s) { text.append(s.data(), s.data() + s.size()); }

void SurfaceJson::put_feature_number(Text& text, Index feature) const {
  if (feature == Surface::none) return put(text, "null");
  const auto at = std::lower_bound(features_.begin(), features_.end(), feature);
  fmt::format_to(std::back_inserter(text), "{}", at - features_.begin());
}

template <class Points>
void SurfaceJson::put_points(Text& text, const Points& points, std::size_t count) const {
  text.push_back('[');
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text.push_back(',');
    put_point(text, points[i]);
  }
  text.push_back(']');
}

void SurfaceJson::put_feature(Text& text, std::size_t i) const {
  const Terrain::Corners corners = surface_.terrain().corners(features_[i]);
  const char* kind = name_of(surface_.terrain().feature_kind(features_[i]));
  fmt::format_to(std::back_inserter(text), "{{\"kind\":\"{}\",\"at\":", kind);
  put_points(text, corners.point, std::size_t(corners.count));
  text.push_back('}');
}

void SurfaceJson::put_edge(Text& text, std::size_t e) const {
  const Surface::Edge edge = surface_.edge(Index(e));
  fmt::format_to(std::back_inserter(text), "{{\"kind\":\"{}\",\"curve\":\"{}\",\"features\":[", name_of(edge.kind),
                 name_of(edge.curve));
  put_feature_number(text, edge.feature[0]);
  text.push_back(',');
  put_feature_number(text, edge.feature[1]);
  put(text, "],\"points\":");
  const std::vector<Point3> points = surface_.curve(Index(e), options_.curve_points);
  put_points(text, points, points.size());
  text.push_back('}');
}

void SurfaceJson::put_half_edge(Text& text, std::size_t i) const {
  const auto h = Index(i);
  fmt::format_to(std::back_inserter(text), "[{},{},{},{},{}]", topology_.origin[h], Subdivision::twin(h), topology_.next[h],
                 topology_.face[h], Subdivision::edge(h));
}

void SurfaceJson::put_face(Text& text, std::size_t i) const {
  const auto f = Index(i);
  put(text, "{\"feature\":");
  put_feature_number(text, surface_.face_feature(f));
  const Index outer = topology_.face_outer[f];
  put(text, ",\"outer\":");
  put(text, outer == Subdivision::none ? "null" : fmt::format("{}", outer));
  fmt::format_to(std::back_inserter(text), ",\"inner\":[{}]}}", fmt::join(topology_.inner_loops(f), ","));
}

Status SurfaceJson::write(OutputStream& stream, const Context& context) const {
  const auto list = [&](const char* name, std::size_t count, auto put_item) -> Status {
    stream.write(fmt::format(",\n\"{}\":[", name));
    Status written = write_items(stream, count, context, [&](Text& text, std::size_t i) {
      put(text, i == 0 ? "\n" : ",\n");
      put_item(text, i);
    });
    stream.write("\n]");
    return written;
  };
  stream.write(fmt::format("{{\"krepl\":\"subdivision\",\"version\":1,\"radius\":{}", surface_.radius()));
  Status status = list("features", features_.size(), [&](Text& t, std::size_t i) { put_feature(t, i); });
  if (!status) return status;
  status = list("vertices", topology_.vertex_count, [&](Text& t, std::size_t i) { put_point(t, surface_.vertex(Index(i))); });
  if (!status) return status;
  status = list("edges", topology_.edge_count(), [&](Text& t, std::size_t i) { put_edge(t, i); });
  if (!status) return status;
  status = list("half_edges", topology_.half_edge_count(), [&](Text& t, std::size_t i) { put_half_edge(t, i); });
  if (!status) return status;
  status = list("faces", topology_.face_count(), [&](Text& t, std::size_t i) { put_face(t, i); });
  stream.write("}\n");
  return status;
}

}  // namespace

SurfaceWriteResult write_surface_json(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                      const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  if (Status written = SurfaceJson(surface, options).write(*stream, context); !written) return written.error();
  if (Status finished = stream->finish(); !finished) return finished.error();
  return SurfaceFileReport{};
}

}  // namespace krepl::output
