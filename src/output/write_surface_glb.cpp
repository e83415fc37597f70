// glTF 2.0, binary: one mesh with normals and colours by what the ball touches; y points up, as glTF wants it. Vertices are
// repeated for each face, so that valleys look sharp.
#include <algorithm>
#include <cmath>

#include "output/surface_mesh_file.hpp"
#include "output/surface_patch.hpp"

namespace krepl::output {

namespace {

using Vector = std::array<float, 3>;

struct GlbVertex {
  SurfaceMesh::Index vertex;
  Surface::Index face;
};

class GlbMesh {
 public:
  GlbMesh(const Surface& surface, const SurfaceMesh& mesh, Point3 off);

  bool fits() const { return 36 * vertices_.size() + 12 * mesh_.triangles.size() + 4096 < 0xffffffffu; }
  Status write(OutputStream& stream, const Context& context) const;

 private:
  std::string json() const;
  Vector position(std::size_t i) const;
  Vector normal(std::size_t i) const;
  std::array<std::uint8_t, 4> colour(std::size_t i) const;
  std::size_t bytes_of_vectors() const { return 12 * vertices_.size(); }
  std::size_t binary_size() const { return 28 * vertices_.size() + 4 * corners_.size(); }

  const Surface& surface_;
  const SurfaceMesh& mesh_;
  Point3 shift_, off_;
  std::vector<GlbVertex> vertices_;
  std::vector<std::uint32_t> corners_;
};

GlbMesh::GlbMesh(const Surface& surface, const SurfaceMesh& mesh, Point3 off) : surface_(surface), mesh_(mesh), off_(off) {
  const Point3 o = surface.terrain().origin();
  shift_ = {o.x - off.x, o.y - off.y, o.z - off.z};
  const auto& triangles = mesh.triangles;
  std::vector<SurfaceMesh::Index> own;
  for (std::size_t first = 0, last = 0; first < triangles.size(); first = last) {
    own.clear();
    for (; last < triangles.size() && triangles[last].face == triangles[first].face; ++last)
      own.insert(own.end(), triangles[last].vertex.begin(), triangles[last].vertex.end());
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    const std::size_t base = vertices_.size();
    for (const SurfaceMesh::Index v : own) vertices_.push_back({v, triangles[first].face});
    for (std::size_t t = first; t < last; ++t) {
      for (const SurfaceMesh::Index v : triangles[t].vertex)
        corners_.push_back(std::uint32_t(base + std::size_t(std::lower_bound(own.begin(), own.end(), v) - own.begin())));
    }
  }
}

Vector GlbMesh::position(std::size_t i) const {
  const Point3 p = mesh_.vertices[vertices_[i].vertex];
  return {float(p.x + shift_.x), float(p.z + shift_.z), float(-(p.y + shift_.y))};
}

Vector GlbMesh::normal(std::size_t i) const {
  const GlbVertex& v = vertices_[i];
  const SurfacePatch patch(surface_.terrain(), surface_.face_feature(v.face), surface_.radius());
  const Point3 n = patch.normal(mesh_.vertices[v.vertex]);
  return {float(n.x), float(n.z), float(-n.y)};
}

/// Colours of glTF vertices are linear.
std::array<std::uint8_t, 4> GlbMesh::colour(std::size_t i) const {
  const auto rgb = patch_colour(surface_.terrain().feature_kind(surface_.face_feature(vertices_[i].face)));
  std::array<std::uint8_t, 4> linear{0, 0, 0, 255};
  for (std::size_t k = 0; k < 3; ++k) linear[k] = std::uint8_t(std::lround(255 * std::pow(rgb[k] / 255.0, 2.2)));
  return linear;
}

std::string GlbMesh::json() const {
  Vector low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Vector p = position(i);
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  const std::size_t n = vertices_.size(), vectors = bytes_of_vectors();
  std::string text = fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"krepl"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0,"name":"surface","translation":[{},{},{}]}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"COLOR_0":2}},"indices":3,"material":0}}]}}],)"
      R"("materials":[{{"pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":0.8}},"doubleSided":true}}],)"
      R"("buffers":[{{"byteLength":{}}}],)",
      off_.x, off_.z, off_.y == 0 ? 0 : -off_.y, binary_size());
  text += fmt::format(
      R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{0},"target":34962}},)"
      R"({{"buffer":0,"byteOffset":{0},"byteLength":{0},"target":34962}},)"
      R"({{"buffer":0,"byteOffset":{1},"byteLength":{2},"target":34962}},)"
      R"({{"buffer":0,"byteOffset":{3},"byteLength":{4},"target":34963}}],)",
      vectors, 2 * vectors, 4 * n, 2 * vectors + 4 * n, 4 * corners_.size());
  text += fmt::format(
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{0},"type":"VEC3","min":[{1}],"max":[{2}]}},)"
      R"({{"bufferView":1,"componentType":5126,"count":{0},"type":"VEC3"}},)"
      R"({{"bufferView":2,"componentType":5121,"normalized":true,"count":{0},"type":"VEC4"}},)"
      R"({{"bufferView":3,"componentType":5125,"count":{3},"type":"SCALAR"}}]}})",
      n, fmt::join(low, ","), fmt::join(high, ","), corners_.size());
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return text;
}

Status GlbMesh::write(OutputStream& stream, const Context& context) const {
  const std::string head = json();
  fmt::memory_buffer bytes;
  constexpr std::uint32_t magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
  for (const std::size_t value :
       {std::size_t{magic}, std::size_t{2}, 28 + head.size() + binary_size(), head.size(), std::size_t{json_chunk}})
    put_binary(bytes, std::uint32_t(value));
  bytes.append(head);
  put_binary(bytes, std::uint32_t(binary_size()));
  put_binary(bytes, binary_chunk);
  stream.write({bytes.data(), bytes.size()});
  const std::size_t n = vertices_.size();
  Status status = write_items(stream, n, context, [&](auto& b, std::size_t i) { put_binary(b, position(i)); });
  if (!status) return status;
  status = write_items(stream, n, context, [&](auto& b, std::size_t i) { put_binary(b, normal(i)); });
  if (!status) return status;
  status = write_items(stream, n, context, [&](auto& b, std::size_t i) { put_binary(b, colour(i)); });
  if (!status) return status;
  return write_items(stream, corners_.size(), context, [&](auto& b, std::size_t i) { put_binary(b, corners_[i]); });
}

}  // namespace

SurfaceWriteResult write_surface_glb(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                     const Context& context) {
  const auto put = [&](OutputStream& stream, const SurfaceMesh& mesh, SurfaceFileReport&) -> Status {
    const GlbMesh glb(surface, mesh, float_origin(surface, surface_max_error(options, surface.radius())));
    if (!glb.fits()) {
      return Error{ErrorCode::io, "glTF binary files hold 4 GB at most", "", "give a larger --max-error, or write PLY"};
    }
    return glb.write(stream, context);
  };
  return write_mesh(path, surface, options, context, put);
}

}  // namespace krepl::output
