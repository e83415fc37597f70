#pragma once

#include <optional>
#include <vector>

#include "incremental/planar_map.hpp"
#include "incremental/visibility.hpp"

namespace krepl::incremental {

/// What one union did.
struct UnionStep {
  Index triangle = none;
  std::size_t components = 0;  ///< of the intersection of the new boundary with the old one, none missed
  std::size_t closed = 0;      ///< of them, closed curves
};

/// The union of semi-kreplach, grown one by one: ComputeUnion [javgal2006, section 4.5], with every component of the
/// intersection found by looking along the curves of all pairs of patches.
class Union {
 public:
  Union(const Parts& parts, const Tolerance& tolerance) : parts_(parts), tolerance_(tolerance), map_(tolerance) {
    is_in_.assign(parts.triangles().size(), false);
    has_part_.assign(parts.parts().size(), false);
  }

  /// Adds the semi-krepl of a triangle. A fault if the map that comes out cannot be certified.
  std::optional<Fault> add(Index triangle);

  const PlanarMap& map() const { return map_; }
  const UnionStep& last_step() const { return step_; }
  std::size_t curves_traced() const { return curves_traced_; }

 private:
  /// Where others may pass an arc of this step without crossing it, and the stretch of it that touches.
  struct Touch {
    Arc around;
    Vector at;
  };
  std::vector<Index> new_parts(Index triangle) const;
  std::vector<Index> triangles_near(const Box& box) const;
  void trace(Curve curve, std::vector<Arc>& arcs);
  void cut_old(Index triangle, std::vector<Arc> old, std::vector<Arc>& arcs);
  void keep(const CurvePointer& curve, const std::vector<Interval>& intervals, const Arc* from, std::vector<Arc>& arcs);
  void set_ends(std::vector<Arc>& arcs);
  void split_at_vertices(std::vector<Arc>& arcs);
  void drop_repeated(std::vector<Arc>& arcs) const;
  std::array<Index, 2> labels_beside(const Arc& arc, Real off) const;
  bool set_labels(Arc& arc) const;
  bool rejoin(std::vector<Arc>& arcs) const;
  Index label(Vector place) const;
  std::size_t count_components(const std::vector<Arc>& arcs, const std::vector<Index>& added);

  const Parts& parts_;
  Tolerance tolerance_;
  PlanarMap map_;
  std::vector<bool> is_in_, has_part_;
  std::vector<Index> in_, in_parts_;
  std::vector<Vector> corners_;  // of the patches of all parts that are in
  std::vector<Touch> touches_;
  UnionStep step_;
  std::size_t curves_traced_ = 0;
};

}  // namespace krepl::incremental
