#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace krepl {

/// Topology of a subdivision of the plane (or of a terrain-like surface seen from above) as a doubly connected edge list
/// in index arrays. Half-edges come in pairs: h and twin(h) = h ^ 1 belong to edge(h) = h / 2. The face of a half-edge
/// lies on its left. Face 0 is the unbounded one. Geometry is kept by the owner in arrays of the same indices.
struct Subdivision {
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};

  std::size_t vertex_count = 0;
  std::vector<Index> origin;  ///< per half-edge: the vertex it starts from
  std::vector<Index> next;    ///< per half-edge: the following one around its face
  std::vector<Index> face;    ///< per half-edge: the face on its left
  std::vector<Index> face_outer;        ///< per face: a half-edge of its outer loop; none for face 0
  std::vector<Index> face_inner_begin;  ///< per face and one more: where its inner loops start in face_inner
  std::vector<Index> face_inner;        ///< one half-edge per inner loop

  static Index twin(Index h) { return h ^ 1u; }
  static Index edge(Index h) { return h >> 1; }
  std::size_t half_edge_count() const { return origin.size(); }
  std::size_t edge_count() const { return origin.size() / 2; }
  std::size_t face_count() const { return face_outer.size(); }
  std::span<const Index> inner_loops(Index f) const {
    return {face_inner.data() + face_inner_begin[f], face_inner_begin[f + 1] - face_inner_begin[f]};
  }

  /// Checks that indices are in range, next is a permutation, the end of each half-edge is the origin of its next, loops
  /// keep their face, every loop is listed once by its face, no vertex is isolated, and Euler's formula
  /// V - E + F = 1 + C holds. Returns what is wrong and where, or nothing. O(V + E + F).
  std::optional<std::string> validate() const;
};

}  // namespace krepl
