#pragma once

#include <optional>
#include <string>
#include <vector>

#include "incremental/curve.hpp"
#include "krepl/surface.hpp"

namespace krepl::incremental {

/// A stretch of a curve that separates two labels, from vertex to vertex.
struct Arc {
  CurvePointer curve;
  Real begin = 0, end = 0;              ///< parameters at the two vertices
  std::array<Real, 2> early{}, late{};  ///< each end is between these, as nothing but the tolerance decides
  std::array<Index, 2> vertex{none, none};
  std::array<Index, 2> label{none, none};  ///< parts that are highest on its left and on its right
  Surface::EdgeKind kind = Surface::EdgeKind::valley;
  int lower = 2;  ///< rim: which side is below, 0 left or 1 right
  Box box;
  Real reach = 0;  ///< at least how far it goes from its ends, seen from above

  Vector point(Real t) const { return curve->point(t); }
  /// Somewhere in the middle, but not where something symmetrical touches it.
  Real middle_parameter() const { return begin + 0.4381966L * (end - begin); }
  Vector middle() const { return curve->point(middle_parameter()); }
};

/// What could not be certified, and where.
struct Fault {
  std::string what;
  Vector at;
};

/// The boundary of the union so far as a labelled map of the plane: a doubly connected edge list whose half-edges 2a
/// and 2a + 1 run along arc a and back.
class PlanarMap {
 public:
  explicit PlanarMap(const Tolerance& tolerance) : tolerance_(tolerance) {}

  const std::vector<Arc>& arcs() const { return arcs_; }
  Vector vertex(Index v) const { return vertices_[v]; }
  std::size_t vertex_count() const { return vertices_.size(); }
  /// Half-edges that leave the vertex, counter-clockwise.
  const std::vector<Index>& around(Index v) const { return around_[v]; }
  Index origin(Index h) const { return arcs_[h / 2].vertex[h % 2]; }
  Index label(Index h) const { return arcs_[h / 2].label[h % 2]; }
  Index next(Index h) const { return next_[h]; }

  /// The vertex there, a new one if none is near. Heights do not count.
  Index vertex_at(Vector place);

  /// Arcs that meet the box, taken out of the map.
  std::vector<Arc> take(const Box& box);
  /// Puts arcs in and links all half-edges. A fault if the labels around a vertex or along a loop do not agree, or if
  /// the map is not planar by Euler's formula.
  std::optional<Fault> put(std::vector<Arc> arcs);

  /// Box, reach; to be called when the parameters are known.
  static void measure(Arc& arc);
  /// Where the arc passes within `distance` of a point, seen from above.
  static std::optional<Real> passes(const Arc& arc, Vector point, Real distance);

 private:
  bool turn_order(Index v, Real radius);
  std::optional<Fault> order_around(Index v);
  std::optional<Fault> check_loops();

  Tolerance tolerance_;
  std::vector<Vector> vertices_;
  std::vector<std::vector<Index>> around_;
  std::vector<Arc> arcs_;
  std::vector<Index> next_;
};

}  // namespace krepl::incremental
