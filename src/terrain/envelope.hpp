#pragma once

#include <optional>
#include <span>
#include <vector>

#include "terrain/patches.hpp"

namespace krepl::terrain {

/// How two labels meet along the boundary between them.
enum class Meeting : std::uint8_t { seam, valley, rim };

/// Where labels change along a line.
struct LineCrossing {
  double t;
  Index after;  ///< label beyond it
  Meeting meeting;
};

/// A wall in which a body ends, and how far inside it that body is above another patch.
template <class Real>
struct WallBesideOf {
  BoundOf<Real> outline;
  Real inset;
};

/// The upper envelope of a set of patches over a region: which candidates can appear at all, which one is highest at a
/// place, and in what order they appear along a line.
///
/// In double it passes on to a `finer` one what it cannot tell: which of several patches of nearly one height is
/// highest, where labels change within a short stretch of a line, and where two surfaces meet at a small angle.
template <class Real>
class Envelope {
 public:
  using Point = PointOf<Real>;
  using Box = BoxOf<Real>;
  using Bound = BoundOf<Real>;
  using Patch = PatchOf<Real>;
  using Gradient = GradientOf<Real>;
  using Range = RangeOf<Real>;
  using GradientRange = GradientRangeOf<Real>;

  /// `scale`: the S of the accuracy contract.
  Envelope(PatchSet<Real>& patches, double scale, SurfaceCounters& counters, Envelope<DoubleDouble>* finer = nullptr);

  const PatchSet<Real>& patches() const { return patches_; }
  /// The one with more digits, ready for lines across these patches, or also for cells; null if there is none.
  Envelope<DoubleDouble>* finer(std::span<const Index> candidates, bool cells = false) const;
  /// Lengths and heights that differ by less are not told apart.
  Real tolerance() const { return tolerance_; }
  /// Heights that differ by less count as equal.
  Real noise() const { return noise_; }
  Real smallest_cell() const { return smallest_cell_; }
  /// What is nearer to a wall than that counts as its foot or top; the same in both precisions.
  Real rim_width() const { return rim_width_; }
  /// What is thinner than that on the surface is left out, however steep.
  Real thickness() const { return thickness_; }
  /// Cells and stretches below this are left to the finer envelope, if there is one.
  Real fine_cell() const { return fine_cell_; }
  /// True if R is at least the extent.
  bool is_far() const { return far_; }

  /// Highest candidate at p, among equals a face before an edge before a vertex, then the longest edge, then the lowest
  /// feature number; none if no patch lies over p.
  Index winner(Point p, std::span<const Index> candidates) const { return winner(p, candidates, finer_ != nullptr); }

  /// Appends to `out` the candidates that may appear in the box: those whose domain meets it and that are not hidden
  /// below the bodies of the champions. Champions that are candidates are kept wherever their domain meets the box.
  /// Without `also_hidden` what is hidden is kept, too. Returns how many are hidden.
  std::size_t filter(const Box& box, std::span<const Index> champions, std::span<const Index> candidates,
                     std::vector<Index>& out, bool also_hidden = true) const;

  /// True if the patch is certainly not seen in the box: each part of it, halved up to `depth` times, lies outside the
  /// domain or below the bodies of the labels, at most four.
  bool stays_hidden(Index patch, const Box& box, std::span<const Index> labels, int depth) const;

  /// True if the patch rises nowhere in the box above the upper ones' bodies by more than the tolerance.
  bool hidden_within_tolerance(Index patch, std::span<const Index> uppers, const Box& box) const;
  /// True if the curves between a patch and two others certainly do not meet in the box.
  bool stay_apart(Index patch, Index first, Index second, const Box& box) const;
  /// False if the patch's domain certainly does not reach into the box by more than matters.
  bool domain_meets(Index patch, const Box& box) const;
  /// True if all of the box lies on the patch's side of the bound.
  bool covers(const Bound& bound, const Box& box) const;

  /// Labels along an axis-parallel line: appends crossings with t ascending to `out`. `start` and `end` are the labels
  /// at the two ends, where t is x or y.
  void section(bool vertical, double at, double from, double to, Index start, Index end,
               std::span<const Index> candidates, std::vector<LineCrossing>& out);

  Range bound_range(const Bound& bound, const Box& box) const;
  GradientRange bound_gradient_range(const Bound& bound, const Box& box) const;
  /// Over all of a box, or only over the part of it that is in the patch's domain, or in a convex set around that.
  enum class Where : std::uint8_t { in_box, in_domain };
  GradientRange gradient_range(Index patch, const Box& box, Where where = Where::in_box) const;
  /// Second derivatives in the middle of a box, and how large third ones may be along any direction in it.
  struct Curvature {
    Real xx, xy, yy, third;
    Curvature operator+(const Curvature& c) const { return {xx + c.xx, xy + c.xy, yy + c.yy, third + c.third}; }
    Curvature operator*(Real k) const { return {k * xx, k * xy, k * yy, absolute(k) * third}; }
  };
  /// Of extended_height, and of a bound's function; infinite beside a wall.
  Curvature curvature(Index patch, const Box& box) const;
  Curvature curvature(const Bound& bound, const Box& box) const;
  /// Of the derivative of extended_height along a direction of the plane.
  Range derivative_range(Index patch, const Box& box, Gradient direction, Where where = Where::in_box) const;
  /// The same of a function that vanishes where a cylinder or sphere is as high as the other patch, and is smooth where
  /// it is upright: half of a^2 + b^2 - R^2, with a the distance from its axis and b the other patch's height over the
  /// axis, measured across it.
  Range upright_derivative_range(Index patch, Index other, const Box& box, Gradient direction) const;
  /// The same of a cone, where the sphere is as high as the plane of the cone's circle.
  Range upright_derivative_range(const Bound& cone, const Box& box, Gradient direction) const;
  /// Those functions themselves: positive where the other patch is higher, or the plane. The other patch has to be
  /// above the axis there, the plane above the sphere's centre.
  Real upright_value(Index patch, Index other, Point p) const;
  Real upright_value(const Bound& cone, Point p) const;
  /// Height at which a patch ends in a wall: of the points that a ball touches with a horizontal normal.
  Real rim_height(Index patch, Point p) const;
  /// Of an edge's line straight below p, beyond its ends too.
  Real axis_height(Index edge, Point p) const;
  /// The same as written. Beyond an end of an edge by less than is told apart the wall is that of the next edge, in
  /// nearly the same line, unless a sphere is between them.
  Real wall_height(Index patch, Point p) const;
  Gradient rim_gradient(Index patch) const;
  /// Gradient of a bound's function; steep but finite near the rim.
  Gradient bound_gradient(const Bound& bound, Point p) const;
  /// The one wall in which the upper patch's body ends within the box, if that wall is all above the lower patch.
  std::optional<Bound> wall_above(Index upper, Index lower, const Box& box) const;
  /// The same, or the one wall that rises above the lower patch not far inside of it.
  std::optional<WallBesideOf<Real>> wall_beside(Index upper, Index lower, const Box& box) const;
  /// True if what a ball over the box may touch of an edge or a vertex is the mirror image, in the vertical plane of a straight
  /// bound, of a part of another one on the plane's negative side: a ball on that side is nearer to any place of the original
  /// than to its image, so that the image is hidden there.
  bool is_image(Index image, Index original, const Bound& plane, const Box& box) const;
  /// Of extended_height, but continued where the patch's surface has ended.
  Real clamped_height(Index patch, Point p) const;
  /// The side of the patch's domain beside p that ends in a wall; null if there is none so near.
  const Bound* rim_at(Index patch, Point p) const;
  /// Height at p, a place on the border of the patch's domain: at a rim that of the rim.
  Real border_height(Index patch, Point p) const;
  /// Along a straight seam, a face's with an edge: that of the line, which may be all but level where the patches are all but
  /// upright. Nothing if there is none between the two.
  std::optional<Real> straight_seam_height(Index a, Index b, Point p) const;
  Meeting meeting(Index a, Index b, Point p) const;
  /// Of the patches on the two sides of a wall the upper one: where both are equally high but for what is too low to show, the
  /// one that ends there, else the higher one, else the first.
  Index upper_at_wall(Index a, Index b, Point p) const;
  /// True if both are faces, equally high all over the box but for rounding.
  bool are_coplanar(Index a, Index b, const Box& box) const;
  Gradient gradient_across(Index a, Index b, Meeting how, Point p) const;

 private:
  template <class Other>
  friend class Envelope;
  static constexpr double endless = std::numeric_limits<double>::infinity();
  Index winner(Point p, std::span<const Index> candidates, bool finely) const;
  struct Line;
  struct BoxFrame;
  class Cover;
  /// A linear function: its value in the middle of a box, and its gradient.
  struct Plane {
    Real height;
    Gradient gradient;
    /// At the corners of the box, counter-clockwise from the lowest.
    std::array<Real, 4> at_corners(const BoxFrame& box) const;
  };
  /// A wall in which a body ends, and by how much the body may be lower there than the patch's rim_height.
  struct Wall {
    Bound outline;
    Real lowered;
  };
  Range aside_range(Index edge, const Box& box, Where where) const;
  Range slope_across(Index edge, const Box& box, Where where) const;
  std::optional<bool> meet_before_wall(Index a, const Bound* of_a, Index b, const Bound* of_b, Point p) const;
  bool is_beyond_wall(Index patch, Point p) const;
  Index body_at(Point p, std::span<const Index> ends, std::span<const Index> candidates) const;
  bool misses(const Line& line, Real t0, Real t1, Index i) const;
  void section(const Line& line, Real t0, Index l0, Real t1, Index l1, std::size_t first, int depth);
  void drop_slivers(const Line& line, Index start, std::size_t first, std::vector<LineCrossing>& crossings) const;
  bool gap(const Line& line, Real t0, Index l0, Real t1, Index l1) const;
  bool single_crossing(const Line& line, Real t0, Index l0, Real t1, Index l1) const;
  Real locate(const Line& line, Real t0, Index l0, Real t1, Index l1, Meeting& meeting) const;
  template <class Function>
  Real root(const Function& value, Real a, Real fa, Real b, Real fb) const;
  Point support_point(Index patch, const BoxFrame& box) const;
  Plane plane_of(const Patch& face, Point p) const;
  bool is_steep(const Patch& patch) const;
  Plane support(Index patch, const BoxFrame& box) const;
  Plane support_of_steep(Index patch, const Plane& whole, const BoxFrame& box) const;
  template <int sign>
  Real extreme(const Bound& bound, const BoxFrame& box, Real least_up = 0, Real most_up = endless) const;
  bool is_within(const Bound& bound, const BoxFrame& box, Real least_up = 0, Real most_up = endless) const;
  std::optional<Wall> wall_through(Index patch, const BoxFrame& box) const;
  bool is_above(Index upper, const Wall& wall, Index lower, const BoxFrame& frame) const;
  bool ends_before(Index patch, const Bound& wall, const Box& box) const;
  bool shows_first(Index patch, Index other, const BoxFrame& box) const;
  bool lies_in(Index lower, Index upper) const;
  bool hidden_beside(Index lower, Index upper, const BoxFrame& frame, Real least_up = 0, Real allowed = 0,
                     Real most_up = endless) const;
  bool hidden_below_face(Index lower, Index upper, const BoxFrame& frame) const;
  struct Vector {
    Real x, y, z;
  };
  /// Of an edge: unit, from its first vertex to its second.
  Vector direction(Index edge) const {
    const Patch& f = patches_[edge];
    return {f.flat * f.gx, f.flat * f.gy, f.flat * f.m};
  }
  /// Places x with (x - (at, z)) . normal > 0.
  struct HalfSpace {
    Point at;
    Real z;
    Vector normal;
  };
  Real most_beyond(Index edge, const HalfSpace& part, const BoxFrame& frame) const;
  std::optional<HalfSpace> outside_at_vertex(Index first, Index second, const BoxFrame& frame) const;
  std::size_t outside_of_crossing(Index first, Index second, const BoxFrame& frame, HalfSpace out[2]) const;
  std::size_t contacts(Index patch, const Box& box, Vector* out) const;
  std::size_t normals(Index patch, const Box& box, Vector* out) const;
  bool hidden_by_feature(Index lower, std::span<const Index> uppers, const BoxFrame& frame) const;
  bool hidden_by_axis(Index lower, Index upper, const Box& box) const;
  bool hidden_by_balls(Index patch, std::span<const Index> labels, const Box& box) const;
  bool curve_function(Index own, Index other, std::span<const Vector> places, std::span<const Vector> normals,
                      Real* value, Real& slack) const;
  Real outside(const Bound& wall, Point p) const;
  Real inset_of(Index body, const Wall& wall, const Box& box, const std::array<Real, 4>& plane) const;
  bool hidden_beyond(Index patch, const Wall& wall, Real inset, std::span<const Index> others,
                     const BoxFrame& frame) const;
  bool lies_inside(Index patch, const Bound& wall, Real inset, const Box& box) const;
  bool beside_beyond(Index patch, const Bound& wall, Real inset, std::span<const Index> others, const Box& box) const;
  bool back_to_back(const Bound& a, const Bound& b, const Box& box, Real inset) const;
  bool domain_covers(Index patch, const BoxFrame& box) const;
  bool domain_meets(Index patch, const BoxFrame& box) const;
  bool lies_beyond(const Bound& bound, const BoxFrame& box) const;
  bool lies_beyond_seam(Index sphere, Index edge, const BoxFrame& box, Real least_up) const;
  bool axis_meets(Index edge, const BoxFrame& box) const;
  GradientRange sphere_gradient(Point at, const Box& box, Real factor) const;
  Curvature round_curvature(Real x, Real y, Real far) const;

  PatchSet<Real>& patches_;
  Real tolerance_, smallest_cell_, fine_cell_, smallest_stretch_, noise_, rim_width_, least_up_, thickness_;
  bool far_;
  SurfaceCounters& counters_;
  Envelope<DoubleDouble>* finer_;
  std::vector<Index> stack_, kept_;
  std::vector<LineCrossing>* out_ = nullptr;
};

extern template class Envelope<double>;
extern template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
