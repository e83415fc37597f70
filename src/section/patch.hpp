#pragma once

#include "krepl/section.hpp"

namespace krepl::section {

using Index = Surface::Index;
inline constexpr Index none = Surface::none;

/// A straight line of the plane: base + t direction, direction of unit length.
struct Line {
  Point base, direction;
  double along(Point p) const { return (p.x - base.x) * direction.x + (p.y - base.y) * direction.y; }
  /// Positive on the left.
  double aside(Point p) const { return (p.y - base.y) * direction.x - (p.x - base.x) * direction.y; }
};

/// The plane, cylinder or sphere of a patch, and its cuts by planes.
class Patch {
 public:
  Patch(const Terrain& terrain, Index feature, double radius, double scale);

  /// Of the ball's centre; beyond the silhouette, that of the silhouette.
  double height(Point p) const;
  /// The greatest height of the cylinder of a horizontal edge, or of a sphere; -infinity if there is none.
  double top() const;

  /// Order of points along the level curve, the higher side on its left. A cylinder with a horizontal axis has two
  /// runs.
  struct Place {
    int run;
    double along;
    friend auto operator<=>(const Place&, const Place&) = default;
  };
  Place place_at_level(Point p, double level) const;
  /// Of a sphere: just inside of the level circle, at an angle.
  Point on_level_circle(double level, double angle) const;
  /// The part of the level curve from start to end in that order; on a sphere, of any number of turns.
  CutPiece level_piece(Point3 start, Point3 end) const;
  /// All of it, for a sphere.
  CutPiece level_circle(double level) const;
  /// Of a vertical cut, along the line.
  CutPiece line_piece(Point3 start, Point3 end, const Line& line) const;

  bool is_sphere() const { return kind_ == Terrain::FeatureKind::vertex; }
  Point at() const { return {at_.x, at_.y}; }

 private:
  double along(Point p) const { return (p.x - at_.x) * g_.x + (p.y - at_.y) * g_.y; }
  double aside(Point p) const { return (p.y - at_.y) * g_.x - (p.x - at_.x) * g_.y; }
  double angle(Point3 p) const;
  bool is_flat(double from, double to) const;

  Terrain::FeatureKind kind_;
  double radius_, scale_;
  Point3 at_;
  Point3 normal_{};          // face: unit, upwards
  Point g_{};                // edge: unit direction in the plane
  double m_ = 0, q_ = 1;     // edge: rise per unit length in the plane, sqrt(1 + m^2)
  bool horizontal_ = false;  // edge: as far as can be told
};

}  // namespace krepl::section
