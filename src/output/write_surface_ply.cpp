// Binary PLY: double coordinates; colours by what the ball touches, and the face and feature of each triangle. A vertex where
// patches of different kinds meet is there once for each kind.
#include <bit>

#include "output/surface_mesh_file.hpp"

namespace krepl::output {

namespace {

using Buffers = std::span<fmt::memory_buffer>;

class PlyMesh {
 public:
  explicit PlyMesh(const SurfaceMesh& mesh);

  bool fits() const { return vertex_count() <= 0xffffffffu; }
  Status write(OutputStream& stream, const Context& context) const;

 private:
  static constexpr std::size_t kinds = 3, vertex_size = 27, triangle_size = 21, rank_step = 64;

  std::uint64_t vertex_count() const { return border_count_ + mesh_.inner_count(); }
  std::string header() const;
  std::uint32_t number(BorderVertices::Index v, unsigned kind) const;
  void put_vertex(fmt::memory_buffer& bytes, Point3 p, unsigned kind) const;
  void put_border_vertex(fmt::memory_buffer& bytes, BorderVertices::Index v) const;
  void put_face(Buffers bytes, const SurfaceMesh::Face& face) const;
  unsigned kind_of(Surface::Index face) const {
    return unsigned(surface_.terrain().feature_kind(surface_.face_feature(face)));
  }

  const SurfaceMesh& mesh_;
  const Surface& surface_;
  std::vector<std::uint8_t> kinds_;  // per vertex of the border: one bit for each kind of a patch there
  std::vector<std::uint64_t> rank_;  // per rank_step of them: how many bits are set before
  std::uint64_t border_count_ = 0;
};

PlyMesh::PlyMesh(const SurfaceMesh& mesh) : mesh_(mesh), surface_(mesh.surface()), kinds_(mesh.border().count()) {
  const Subdivision& topology = surface_.subdivision();
  std::vector<BorderVertices::Index> vertices;
  for (Surface::Index h = 0; h < topology.half_edge_count(); ++h) {
    const Surface::Index face = topology.face[h];
    if (!mesh.border().has_triangles(face)) continue;
    vertices.clear();
    mesh.border().append(h, vertices);
    for (const BorderVertices::Index v : vertices) kinds_[v] |= std::uint8_t(1u << kind_of(face));
  }
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (v % rank_step == 0) rank_.push_back(border_count_);
    border_count_ += unsigned(std::popcount(kinds_[v]));
  }
}

std::string PlyMesh::header() const {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment krepl surface, radius {}\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face {}\nproperty list uchar uint vertex_indices\nproperty uint patch\n"
      "property uint feature\nend_header\n",
      surface_.radius(), vertex_count(), mesh_.triangle_count());
}

/// Where the vertex of the border v stands in the file, in the colour of a kind.
std::uint32_t PlyMesh::number(BorderVertices::Index v, unsigned kind) const {
  std::uint64_t count = rank_[v / rank_step];
  for (std::size_t i = v / rank_step * rank_step; i < v; ++i) count += unsigned(std::popcount(kinds_[i]));
  return std::uint32_t(count + unsigned(std::popcount(kinds_[v] & ((1u << kind) - 1))));
}

void PlyMesh::put_vertex(fmt::memory_buffer& bytes, Point3 p, unsigned kind) const {
  const Point3 o = surface_.terrain().origin();
  for (const double value : {p.x + o.x, p.y + o.y, p.z + o.z}) put_binary(bytes, value);
  put_binary(bytes, patch_colour(Terrain::FeatureKind(kind)));
}

void PlyMesh::put_border_vertex(fmt::memory_buffer& bytes, BorderVertices::Index v) const {
  for (unsigned kind = 0; kind < kinds; ++kind)
    if ((kinds_[v] >> kind & 1) != 0) put_vertex(bytes, mesh_.border().vertex(v), kind);
}

/// Appends a face's own points and its triangles.
void PlyMesh::put_face(Buffers bytes, const SurfaceMesh::Face& face) const {
  const PatchMesh& triangles = face.triangles;
  const unsigned kind = kind_of(face.face);
  const std::size_t known = face.border.size();
  std::vector<std::uint32_t> numbers;
  for (const BorderVertices::Index v : face.border) numbers.push_back(number(v, kind));
  for (std::size_t i = known; i < triangles.points().size(); ++i) {
    numbers.push_back(std::uint32_t(border_count_ + face.inner_before + (i - known)));
    put_vertex(bytes[0], triangles.points()[i], kind);
  }
  for (std::size_t t = 0; t < triangles.triangle_count(); ++t) {
    put_binary(bytes[1], std::uint8_t{3});
    for (const PatchMesh::Index i : triangles.triangle(t)) put_binary(bytes[1], numbers[i]);
    put_binary(bytes[1], face.face);
    put_binary(bytes[1], surface_.face_feature(face.face));
  }
}

Status PlyMesh::write(OutputStream& stream, const Context& context) const {
  stream.write(header());
  Status written = write_items(stream, kinds_.size(), context, [&](fmt::memory_buffer& bytes, std::size_t v) {
    put_border_vertex(bytes, BorderVertices::Index(v));
  });
  if (!written) return written;
  const std::uint64_t sizes[] = {vertex_size * mesh_.inner_count(), triangle_size * mesh_.triangle_count()};
  return write_sections(stream, sizes, mesh_.block_count(), context, [&](Buffers bytes, std::size_t b) {
    mesh_.visit(b, context, [&](const SurfaceMesh::Face& face) { put_face(bytes, face); });
  });
}

}  // namespace

SurfaceWriteResult write_surface_ply(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                                     const Context& context) {
  const auto put = [&](OutputStream& stream, const SurfaceMesh& mesh, SurfaceFileReport&) -> Status {
    const PlyMesh ply(mesh);
    if (!ply.fits()) return too_many_vertices();
    return ply.write(stream, context);
  };
  return write_mesh(path, surface, options, context, put);
}

}  // namespace krepl::output
