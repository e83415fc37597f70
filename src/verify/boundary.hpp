#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "input/result_file.hpp"
#include "verify/bands.hpp"
#include "verify/nearest_tree.hpp"
#include "verify/obstacle.hpp"

namespace krepl::verify {

/// A piece of a result's boundary: a segment, or an arc about c. Distances are to the piece as a point set.
struct Curve {
  Vec a, b;
  bool arc = false;
  Vec c;
  Real r = 0;
  Real sweep = 0;  ///< arcs: signed angle from a to b, counter-clockwise positive; a full circle has +-2 pi
  std::uint32_t ring = 0;
  std::shared_ptr<const CircularArc> bow = {};  ///< the same where it is about an arc of the input: its circle may be vast

  /// Point at the fraction t of the piece.
  Vec at(Real t) const;
  /// Unit normal at the fraction t, to the right of the direction from a to b.
  Vec normal(Real t) const;
  Real length() const;
  Real distance(Vec p) const;
  Box box() const;
  /// Arcs: true if the direction d from the centre lies strictly within the sweep.
  bool sweeps(Vec d) const;
};

/// Where the arcs of a result may be: about an input vertex, or concentric with an arc of the input.
struct ArcPlaces {
  Real radius;         ///< the distance from that
  Real tolerance;
  Real inner = 0;      ///< another distance, of a band
  bool along = false;  ///< also on the arc of the input itself
  bool beyond = false; ///< also as far from it across its centre: on a circle of R - r
};

/// What turning a result's pieces into curves found about its arcs: each must be centred at an input vertex, or be
/// concentric with an arc of the input and R away from it.
struct ArcFit {
  std::size_t arcs = 0;
  std::size_t without_centre = 0;  ///< arcs for which no input vertex lies at distance about R of all three points
  Real worst = 0;                  ///< largest difference from R of the distance between an arc's point and its centre
  Vec where;
};

/// The boundary of a result as found in a file.
class Boundary {
 public:
  /// The centre of an arc is taken from the input, since three points of a short arc determine it only badly. An arc
  /// that has none keeps the circle of its points.
  Boundary(const std::vector<input::ResultPolygon>& polygons, const Obstacle& obstacle, const ArcPlaces& places);

  struct Ring {
    std::uint32_t first = 0, last = 0;  // curves
    std::uint32_t polygon = 0;
    bool hole = false;
    bool turned = false;  ///< runs clockwise though outer, or counter-clockwise though a hole
  };

  const NearestTree<Curve>& curves() const { return curves_; }
  const std::vector<Ring>& rings() const { return rings_; }
  const ArcFit& arc_fit() const { return arc_fit_; }
  Box box() const { return curves_.box(); }

  /// How often the boundary winds around p: 1 inside, 0 outside, anything else where polygons overlap.
  int winding(Vec p) const;
  /// The same per ring: appends the rings that wind around p.
  void rings_around(Vec p, std::vector<std::uint32_t>& out) const;
  /// Length inside the result of the line at height y of the ray frame.
  Real section(Real y) const;
  /// Lowest and highest point of the boundary in the ray frame; the first is larger if there is none.
  std::pair<Real, Real> heights() const;
  /// Area by Green's formula, arcs as arcs.
  Real area() const;
  Real perimeter() const;

 private:
  struct Part {  // a part of a curve, monotone in y, in the ray frame
    Vec a, b;
    int side = 0;  // 0 segment, +1 / -1 the right / left half of the circle
    Vec c;
    Real r = 0;
    std::uint32_t ring = 0;
    std::shared_ptr<const CircularArc> bow = {};  // of all of the curve
    /// +-1 if the part crosses the ray from p (in the ray frame) towards +x upwards / downwards, else 0.
    int crosses(Vec p) const;
    /// Where the part meets height y; precondition: it does.
    Real x_at(Real y) const;
  };
  static std::vector<Curve> resolve(const std::vector<input::ResultPolygon>& polygons, const Obstacle& obstacle,
                                    const ArcPlaces& places, ArcFit& fit);
  void make_rings(const std::vector<input::ResultPolygon>& polygons);
  void make_parts();
  void add_parts_of(const CircularArc& arc, std::uint32_t ring, std::vector<std::pair<Real, Real>>& ranges);
  Real ring_area(const Ring& ring) const;

  ArcFit arc_fit_;
  NearestTree<Curve> curves_;
  std::vector<Ring> rings_;
  std::vector<Part> parts_;
  Bands bands_;
};

}  // namespace krepl::verify
