#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/surface.hpp"
#include "output/patch_mesh.hpp"
#include "output/surface_edges.hpp"

namespace krepl::output {

/// The mesh's vertices along the edges of a surface: which one each corner and each point of a chord is. Heights differ
/// between the two sides of a rim. Refers to the surface.
///
/// The surface's vertices keep their numbers; then come the lower corners at rims, then the points of chords.
class BorderVertices {
 public:
  using Index = std::uint32_t;

  /// Errors: 2^32 vertices or more; cancelled.
  static Result<BorderVertices> make(const Surface& surface, double max_error, const Context& context);

  const SurfaceEdges& edges() const { return edges_; }
  /// Takes these edges, ascending, so much finer. Errors as of make().
  Status refine(std::span<const Surface::Index> edges, double max_error, const Context& context);

  Index count() const { return first_inner() + edges_.count(); }
  Point3 vertex(Index v) const;
  /// The loop of half-edge h as vertices, each once.
  std::vector<Index> loop(Surface::Index h) const;
  /// Appends the vertices of half-edge h but for its end.
  void append(Surface::Index h, std::vector<Index>& vertices) const;
  /// False for faces whose border has fewer than three vertices, and for those without a patch.
  bool has_triangles(Surface::Index f) const;

 private:
  struct LowerCorner {
    Surface::Index half_edge;
    Index vertex;
  };
  BorderVertices(const Surface& surface, SurfaceEdges edges);
  void number_corners();
  Status check_count() const;
  Index corner(Surface::Index h) const;
  Index first_inner() const { return Index(topology_->vertex_count + lower_.size()); }

  const Surface* surface_;
  const Subdivision* topology_;
  SurfaceEdges edges_;
  std::vector<Point3> lower_;              // places of corners below a rim
  std::vector<LowerCorner> lower_corner_;  // half-edges that start there, ascending
};

/// A surface as triangles, counter-clockwise seen from above, relative to terrain().origin(). Refers to the surface.
///
/// Faces that meet in a seam or valley share the vertices along it, so that the mesh is closed where the surface is. It
/// ends at rims: the walls below them are no part of the surface. A rim above a lower part has vertices of its own at
/// the wall's foot.
///
/// Only what faces share is kept, and how many triangles and vertices there are. Triangles are made anew whenever they
/// are asked for: all of them need several times the memory of the surface.
class SurfaceMesh {
 public:
  using Index = std::uint32_t;

  /// The triangles of one face. Its points are those of its border, then its own.
  struct Face {
    Surface::Index face;
    const PatchMesh& triangles;
    std::span<const Index> border;  ///< which of the border's vertices its first points are
    /// How many points inside of faces, and points of faces, those before this one have.
    std::uint64_t inner_before, points_before;
  };

  /// Triangles within max_error of the surface. Errors: 2^32 vertices along edges or more; cancelled.
  static Result<SurfaceMesh> make(const Surface& surface, double max_error, const Context& context = {});

  const Surface& surface() const { return *surface_; }
  const BorderVertices& border() const { return border_; }
  std::uint64_t triangle_count() const { return total_.triangles; }
  std::uint64_t inner_count() const { return total_.inner; }    ///< points inside of faces
  std::uint64_t points_count() const { return total_.points; }  ///< points of all faces, those of borders once for each
  Point3 lowest() const { return total_.low; }                  ///< least coordinates of vertices
  Point3 highest() const { return total_.high; }
  /// Bound of the distance between the mesh and the surface.
  double deviation() const { return border_.edges().deviation() + total_.deviation; }
  /// Triangles seen from below, in faces narrower than the tolerance.
  std::uint64_t folded() const { return total_.folded; }

  /// Faces by ascending number, in blocks; those without triangles are left out.
  std::size_t block_count() const { return block_.size(); }
  void visit(std::size_t block, const Context& context, const std::function<void(const Face&)>& use) const;

 private:
  struct Sums {
    std::uint64_t triangles = 0, inner = 0, points = 0, folded = 0;
    double deviation = 0;
    Point3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    void add(const Sums& other);
  };
  struct Block {
    Sums sums;
    std::vector<Surface::Index> folded_faces;
    std::uint64_t inner_before = 0, points_before = 0;
  };
  static constexpr std::size_t block_size = 64;

  SurfaceMesh(const Surface& surface, BorderVertices border, double face_error);
  Status count(const std::vector<std::size_t>& blocks, const Context& context);
  void count(std::size_t block, const Context& context);
  void add_up();
  std::vector<Surface::Index> edges_of_folded_faces() const;
  std::vector<std::size_t> blocks_beside(std::span<const Surface::Index> edges) const;

  const Surface* surface_;
  BorderVertices border_;
  double face_error_;
  std::vector<Block> block_;
  Sums total_;
};

}  // namespace krepl::output
