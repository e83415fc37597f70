#include "view/surface/tile_encoding.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace krepl::view {

namespace {

using Words = std::vector<std::uint32_t>;

constexpr double most = 65535;

std::uint32_t zigzag(std::int64_t v) { return std::uint32_t(v < 0 ? -2 * v - 1 : 2 * v); }

void to_differences(Words& values) {
  std::int64_t before = 0;
  for (std::uint32_t& v : values) {
    const std::int64_t now = v;
    v = zigzag(now - before);
    before = now;
  }
}

/// Numbers in the order of first use become small: 0 is the next new one [Isenburg and
/// Snoeyink 2005; Cesium's quantized-mesh].
Words below_highest(const Words& values) {
  Words coded;
  std::uint32_t next = 0;
  for (const std::uint32_t v : values) {
    coded.push_back(next - v);
    if (v == next) ++next;
  }
  return coded;
}

/// Things numbered in the order of first use.
template <class Key, class Hash = std::hash<Key>>
class Numbering {
 public:
  std::uint32_t operator()(const Key& key) {
    const auto [place, fresh] = number_.try_emplace(key, std::uint32_t(keys_.size()));
    if (fresh) keys_.push_back(key);
    return place->second;
  }
  const std::vector<Key>& keys() const { return keys_; }

 private:
  std::unordered_map<Key, std::uint32_t, Hash> number_;
  std::vector<Key> keys_;
};

struct PointHash {
  std::size_t operator()(const Point3& p) const {
    std::size_t h = 0;
    for (const double v : {p.x, p.y, p.z}) h = h * 1000003u ^ std::hash<double>()(v);
    return h;
  }
};

double along(double value, double low, double high) { return high > low ? (value - low) / (high - low) : 0; }

std::uint32_t quantised(double value, double low, double high) {
  return std::uint32_t(std::lround(most * std::clamp(along(value, low, high), 0.0, 1.0)));
}

struct LeafArrays {
  std::vector<std::uint8_t> face_kind, line_kind;
  Words triangle_count, feature, feature_point, corner, line_count, line_vertex;
  Numbering<Shape::Index> vertex;
  Numbering<Point3, PointHash> point;
};

LeafArrays collect(const Shape& shape, const TileTree& tree, const TileTree::Tile& leaf) {
  LeafArrays a;
  for (std::uint32_t k = leaf.first; k < leaf.last; ++k) {
    const std::uint32_t f = tree.order()[k];
    const Shape::Face& face = shape.faces[f];
    a.face_kind.push_back(std::uint8_t(face.kind));
    a.triangle_count.push_back(std::uint32_t(shape.triangles_end(f) - face.first_triangle));
    for (std::uint64_t t = face.first_triangle; t < shape.triangles_end(f); ++t)
      for (const Shape::Index v : shape.triangles[t]) a.corner.push_back(a.vertex(v));
    if (face.feature == Shape::none) continue;
    a.feature.push_back(face.feature);
    const Shape::Feature& feature = shape.features[face.feature];
    for (int i = 0; i < feature.count; ++i) a.feature_point.push_back(a.point(feature.at[std::size_t(i)]));
  }
  for (const std::uint32_t l : tree.lines_of(leaf)) {
    a.line_kind.push_back(std::uint8_t(shape.lines[l].kind));
    a.line_count.push_back(std::uint32_t(shape.line_end(l) - shape.lines[l].first));
    for (std::uint64_t i = shape.lines[l].first; i < shape.line_end(l); ++i)
      a.line_vertex.push_back(a.vertex(shape.line_vertices[i]));
  }
  return a;
}

void put_vertices(PlaneWriter& writer, const Shape& shape, const LeafArrays& arrays, const TileTree::Tile& leaf) {
  for (double Point3::*axis : {&Point3::x, &Point3::y, &Point3::z}) {
    if (shape.radius == 0) {
      std::vector<double> exact;
      for (const Shape::Index v : arrays.vertex.keys()) exact.push_back(shape.vertices[v].*axis);
      writer.doubles(exact);
    } else {
      Words whole;
      for (const Shape::Index v : arrays.vertex.keys())
        whole.push_back(quantised(shape.vertices[v].*axis, leaf.low.*axis, leaf.high.*axis));
      to_differences(whole);
      writer.words(whole);
    }
  }
}

}  // namespace

template <class T>
void PlaneWriter::planes(const std::vector<T>& values) {
  const auto* from = reinterpret_cast<const std::uint8_t*>(values.data());
  for (std::size_t plane = 0; plane < sizeof(T); ++plane)
    for (std::size_t i = 0; i < values.size(); ++i) raw_.push_back(from[i * sizeof(T) + plane]);
}

void PlaneWriter::bytes(const std::vector<std::uint8_t>& values) {
  raw_.insert(raw_.end(), values.begin(), values.end());
}
void PlaneWriter::words(const Words& values) { planes(values); }
void PlaneWriter::doubles(const std::vector<double>& values) { planes(values); }

TileBytes PlaneWriter::finish() const {
  uLongf size = compressBound(uLong(raw_.size()));
  TileBytes packed(size);
  // It can only fail for want of room, of which compressBound tells enough.
  compress2(packed.data(), &size, raw_.data(), uLong(raw_.size()), 7);
  packed.resize(size);
  return packed;
}

TileBytes encode_leaf(const Shape& shape, const TileTree& tree, const TileTree::Tile& leaf) {
  LeafArrays a = collect(shape, tree, leaf);
  PlaneWriter writer;
  const auto size = [](const auto& list) { return std::uint32_t(list.size()); };
  writer.words({size(a.vertex.keys()), size(a.face_kind), size(a.corner), size(a.feature), size(a.feature_point),
                size(a.point.keys()), size(a.line_kind), size(a.line_vertex)});
  put_vertices(writer, shape, a, leaf);
  writer.bytes(a.face_kind);
  writer.words(a.triangle_count);
  writer.words(below_highest(a.corner));
  to_differences(a.feature);
  writer.words(a.feature);
  writer.words(below_highest(a.feature_point));
  for (double Point3::*axis : {&Point3::x, &Point3::y, &Point3::z}) {
    std::vector<double> exact;
    for (const Point3& p : a.point.keys()) exact.push_back(p.*axis);
    writer.doubles(exact);
  }
  writer.bytes(a.line_kind);
  writer.words(a.line_count);
  to_differences(a.line_vertex);
  writer.words(a.line_vertex);
  return writer.finish();
}

TileBytes encode_samples(const HeightPyramid& pyramid, const TileTree::Tile& tile) {
  constexpr std::int64_t n = HeightPyramid::cells;
  std::vector<HeightPyramid::Sample> samples;
  double low = INFINITY, high = -INFINITY;  // not the tile's own: faces of other tiles reach over it
  for (std::int64_t row = -1; row <= n + 1; ++row) {
    for (std::int64_t column = -1; column <= n + 1; ++column) {
      samples.push_back(pyramid.sample(tile.depth, tile.column * n + column, tile.row * n + row));
      const double z = double(samples.back().height);
      if (!std::isnan(z)) low = std::min(low, z), high = std::max(high, z);
    }
  }
  Words height;
  std::vector<std::uint8_t> cylinder, sphere;
  for (const HeightPyramid::Sample& s : samples) {
    const double z = along(double(s.height), low, high);
    height.push_back(std::isnan(s.height) ? 0 : 1 + std::uint32_t(std::lround((most - 1) * z)));
    cylinder.push_back(s.cylinder);
    sphere.push_back(s.sphere);
  }
  to_differences(height);
  PlaneWriter writer;
  writer.doubles({low, high});
  writer.words(height);
  writer.bytes(cylinder);
  writer.bytes(sphere);
  return writer.finish();
}

}  // namespace krepl::view
