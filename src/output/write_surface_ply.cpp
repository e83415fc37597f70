// Binary PLY: double coordinates; colours by what the ball touches, and the face and feature of each triangle. A vertex where
// patches of different kinds meet is there once for each kind.
#include <algorithm>

#include "output/surface_mesh_file.hpp"

namespace krepl::output {

namespace {

struct ColouredVertex {
  SurfaceMesh::Index vertex;
  std::uint8_t kind;
  auto operator<=>(const ColouredVertex&) const = default;
};

class PlyMesh {
 public:
  PlyMesh(const Surface& surface, const SurfaceMesh& mesh) : surface_(surface), mesh_(mesh) {
    for (const SurfaceMesh::Triangle& t : mesh.triangles) {
      for (const SurfaceMesh::Index v : t.vertex) vertices_.push_back({v, kind_of(t)});
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }

  std::string header() const {
    return fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment krepl surface, radius {}\n"
        "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face {}\nproperty list uchar uint vertex_indices\nproperty uint patch\nproperty uint feature\nend_header\n",
        surface_.radius(), vertices_.size(), mesh_.triangles.size());
  }
  std::size_t vertex_count() const { return vertices_.size(); }
  void put_vertex(fmt::memory_buffer& bytes, std::size_t i) const {
    const Point3 p = mesh_.vertices[vertices_[i].vertex], o = surface_.terrain().origin();
    for (const double value : {p.x + o.x, p.y + o.y, p.z + o.z}) put_binary(bytes, value);
    put_binary(bytes, patch_colour(Terrain::FeatureKind(vertices_[i].kind)));
  }
  void put_triangle(fmt::memory_buffer& bytes, std::size_t i) const {
    const SurfaceMesh::Triangle& t = mesh_.triangles[i];
    put_binary(bytes, std::uint8_t{3});
    for (const SurfaceMesh::Index v : t.vertex) {
      const auto at = std::lower_bound(vertices_.begin(), vertices_.end(), ColouredVertex{v, kind_of(t)});
      put_binary(bytes, std::uint32_t(at - vertices_.begin()));
    }
    put_binary(bytes, t.face);
    put_binary(bytes, surface_.face_feature(t.face));
  }

 private:
  std::uint8_t kind_of(const SurfaceMesh::Triangle& t) const {
    return std::uint8_t(surface_.terrain().feature_kind(surface_.face_feature(t.face)));
  }

  const Surface& surface_;
  const SurfaceMesh& mesh_;
  std::vector<ColouredVertex> vertices_;
};

}  // namespace

SurfaceWriteResult write_surface_ply(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                     const Context& context) {
  const auto put = [&](OutputStream& stream, const SurfaceMesh& mesh, SurfaceFileReport&) -> Status {
    const PlyMesh ply(surface, mesh);
    stream.write(ply.header());
    Status written =
        write_items(stream, ply.vertex_count(), context, [&](auto& bytes, std::size_t i) { ply.put_vertex(bytes, i); });
    if (!written) return written;
    return write_items(stream, mesh.triangles.size(), context,
                       [&](auto& bytes, std::size_t i) { ply.put_triangle(bytes, i); });
  };
  return write_mesh(path, surface, options, context, put);
}

}  // namespace krepl::output
