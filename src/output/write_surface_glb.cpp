// glTF 2.0, binary: one mesh with normals and colours by what the ball touches; y points up, as glTF wants it. Vertices
// are repeated for each face, so that valleys look sharp.
#include <cmath>

#include "output/surface_mesh_file.hpp"
#include "output/surface_patch.hpp"

namespace krepl::output {

namespace {

using Vector = std::array<float, 3>;

using Buffers = std::span<fmt::memory_buffer>;

class GlbMesh {
 public:
  GlbMesh(const SurfaceMesh& mesh, Point3 off);

  bool fits() const { return 36 * vertex_count() + 12 * mesh_.triangle_count() + 4096 < 0xffffffffu; }
  Status write(OutputStream& stream, const Context& context) const;

 private:
  std::string json() const;
  Vector position(Point3 p) const;
  void put_face(Buffers bytes, const SurfaceMesh::Face& face) const;
  std::uint64_t vertex_count() const { return mesh_.points_count(); }
  std::uint64_t corner_count() const { return 3 * mesh_.triangle_count(); }
  std::uint64_t bytes_of_vectors() const { return 12 * vertex_count(); }
  std::uint64_t binary_size() const { return 28 * vertex_count() + 4 * corner_count(); }

  const SurfaceMesh& mesh_;
  const Surface& surface_;
  Point3 shift_, off_;
};

GlbMesh::GlbMesh(const SurfaceMesh& mesh, Point3 off) : mesh_(mesh), surface_(mesh.surface()), off_(off) {
  const Point3 o = surface_.terrain().origin();
  shift_ = {o.x - off.x, o.y - off.y, o.z - off.z};
}

Vector GlbMesh::position(Point3 p) const {
  return {float(p.x + shift_.x), float(p.z + shift_.z), float(-(p.y + shift_.y))};
}

/// Colours of glTF vertices are linear.
std::array<std::uint8_t, 4> linear_colour(Terrain::FeatureKind kind) {
  const auto rgb = patch_colour(kind);
  std::array<std::uint8_t, 4> linear{0, 0, 0, 255};
  for (std::size_t k = 0; k < 3; ++k) linear[k] = std::uint8_t(std::lround(255 * std::pow(rgb[k] / 255.0, 2.2)));
  return linear;
}

/// Appends positions, normals and colours of a face's points, and its triangles.
void GlbMesh::put_face(Buffers bytes, const SurfaceMesh::Face& face) const {
  const SurfacePatch patch(surface_.terrain(), surface_.face_feature(face.face), surface_.radius());
  const auto colour = linear_colour(patch.kind());
  for (const Point3 p : face.triangles.points()) {
    const Point3 n = patch.normal(p);
    put_binary(bytes[0], position(p));
    put_binary(bytes[1], Vector{float(n.x), float(n.z), float(-n.y)});
    put_binary(bytes[2], colour);
  }
  for (std::size_t t = 0; t < face.triangles.triangle_count(); ++t) {
    for (const PatchMesh::Index i : face.triangles.triangle(t))
      put_binary(bytes[3], std::uint32_t(face.points_before + i));
  }
}

std::string GlbMesh::json() const {
  const Point3 l = mesh_.lowest(), h = mesh_.highest();
  const Vector low = position({l.x, h.y, l.z}), high = position({h.x, l.y, h.z});
  const std::uint64_t n = vertex_count(), vectors = bytes_of_vectors();
  std::string text = fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"krepl"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0,"name":"surface","translation":[{},{},{}]}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"COLOR_0":2}},"indices":3,"material":0}}]}}],)"
      R"("materials":[{{"pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":0.8}},"doubleSided":true}}],)"
      R"("buffers":[{{"byteLength":{}}}],)",
      off_.x, off_.z, off_.y == 0 ? 0 : -off_.y, binary_size());
  text += fmt::format(R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{0},"target":34962}},)"
                      R"({{"buffer":0,"byteOffset":{0},"byteLength":{0},"target":34962}},)"
                      R"({{"buffer":0,"byteOffset":{1},"byteLength":{2},"target":34962}},)"
                      R"({{"buffer":0,"byteOffset":{3},"byteLength":{4},"target":34963}}],)",
                      vectors, 2 * vectors, 4 * n, 2 * vectors + 4 * n, 4 * corner_count());
  text += fmt::format(
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{0},"type":"VEC3","min":[{1}],"max":[{2}]}},)"
      R"({{"bufferView":1,"componentType":5126,"count":{0},"type":"VEC3"}},)"
      R"({{"bufferView":2,"componentType":5121,"normalized":true,"count":{0},"type":"VEC4"}},)"
      R"({{"bufferView":3,"componentType":5125,"count":{3},"type":"SCALAR"}}]}})",
      n, fmt::join(low, ","), fmt::join(high, ","), corner_count());
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return text;
}

Status GlbMesh::write(OutputStream& stream, const Context& context) const {
  const std::string head = json();
  fmt::memory_buffer bytes;
  constexpr std::uint32_t magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
  for (const std::uint64_t value : {std::uint64_t{magic}, std::uint64_t{2}, 28 + head.size() + binary_size(),
                                    std::uint64_t{head.size()}, std::uint64_t{json_chunk}})
    put_binary(bytes, std::uint32_t(value));
  bytes.append(head);
  put_binary(bytes, std::uint32_t(binary_size()));
  put_binary(bytes, binary_chunk);
  stream.write({bytes.data(), bytes.size()});
  const std::uint64_t sizes[] = {bytes_of_vectors(), bytes_of_vectors(), 4 * vertex_count(), 4 * corner_count()};
  return write_sections(stream, sizes, mesh_.block_count(), context, [&](Buffers buffers, std::size_t b) {
    mesh_.visit(b, context, [&](const SurfaceMesh::Face& face) { put_face(buffers, face); });
  });
}

}  // namespace

SurfaceWriteResult write_surface_glb(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                     const Context& context) {
  const auto put = [&](OutputStream& stream, const SurfaceMesh& mesh, SurfaceFileReport&) -> Status {
    const GlbMesh glb(mesh, float_origin(surface, surface_max_error(options, surface.radius())));
    if (!glb.fits()) {
      return Error{ErrorCode::io, "glTF binary files hold 4 GB at most", "", "give a larger --max-error, or write PLY"};
    }
    return glb.write(stream, context);
  };
  return write_mesh(path, surface, options, context, put);
}

}  // namespace krepl::output
