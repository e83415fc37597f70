#pragma once

#include "arcs/uncovered.hpp"

namespace krepl::arcs {

/// Where borders meet and which way they run, by the unmoved bodies at the radius as it was given.
class Corners {
 public:
  explicit Corners(const Bodies& bodies) : bodies_(bodies) {}

  /// The place where the boundary goes over from one border to the next, given where the moved bodies' do: from one
  /// place to another where pieces between the two were taken out. Where that is ill-conditioned one of these is taken,
  /// which is off by a little more than what the radius is enlarged by; but borders about a common vertex may touch,
  /// and are then at their common tangent point.
  Vector<quad> meet(BorderId from, BorderId to, Vector<quad> first, Vector<quad> last) const;

  /// How far p is from the line or circle that the border lies on.
  double off(BorderId border, Vector<quad> p) const;

  /// True if the border runs from q back to p. Precondition: p and q are on it, less than a quarter turn apart.
  bool runs_back(BorderId border, Vector<quad> p, Vector<quad> q) const;

  Border<quad> nominal(BorderId id) const { return bodies_.nominal(body_of(id)).border[place_of(id)]; }

 private:
  double limit(const Border<quad>& a, const Border<quad>& b, double sine) const;
  bool are_incident(const Key& a, const Key& b) const;
  const Bodies& bodies_;
};

}  // namespace krepl::arcs
