#pragma once

#include <cstddef>
#include <vector>

#include "krepl/surface.hpp"

namespace krepl::solid {

/// The subdivision of a surface without what is smaller than a tolerance: solids of CAD know no edges that short and no
/// faces that narrow. Half-edges keep their numbers, origins are vertices of the surface, and what is gone is marked
/// so.
///
/// Edges shorter than the tolerance become a point; a face that then lies between two edges only, no farther apart than
/// that, becomes one edge, with the half-edges of its neighbours as twins.
class Topology {
 public:
  using Index = Surface::Index;
  static constexpr Index none = Surface::none;

  Topology(const Surface& surface, double tolerance);

  std::size_t half_edge_count() const { return next_.size(); }
  bool has(Index h) const { return next_[h] != none; }
  Index origin(Index h) const { return origin_[h]; }
  Index next(Index h) const { return next_[h]; }
  Index previous(Index h) const { return previous_[h]; }
  Index twin(Index h) const { return twin_[h]; }
  Index face(Index h) const { return face_[h]; }
  /// A half-edge of each loop of a face, the outer one first; none for faces that are gone.
  const std::vector<Index>& loops(Index face) const { return loops_[face]; }
  std::size_t face_count() const { return loops_.size(); }
  /// Of the faces that touch something, how many are gone.
  std::size_t lost_faces() const { return lost_; }

 private:
  void contract(const Surface& surface, double tolerance);
  void unlink(Index h);
  void collapse_narrow_faces(const Surface& surface, double tolerance);
  bool collapse(const Surface& surface, Index f, double tolerance);

  std::vector<Index> origin_, next_, previous_, twin_, face_;
  std::vector<std::vector<Index>> loops_;
  std::size_t lost_ = 0;
};

}  // namespace krepl::solid
