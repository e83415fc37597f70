#pragma once

#include <vector>

#include "exact_arithmetic.hpp"
#include "support/ball_oracle.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {

/// A place where a ball at rest on a small terrain touches it so that it cannot roll without losing a contact, or where
/// the patch of the surface changes otherwise in more than two ways.
struct ContactPoint {
  Vec center;
  /// Surely a vertex of the surface. Others may be one: where the contacts lie so specially that only terms of second
  /// order tell.
  bool certain;
};

/// All places that can be vertices of the surface, walls left out, by brute force over features and triples of features
/// in 60 digits: centres at distance R from three supporting planes, lines and points, kept if the contacts lie on the
/// features below them and nothing is nearer or above. For up to a hundred features.
class ExactContacts {
 public:
  explicit ExactContacts(const SmallTerrain& c);

  const std::vector<ContactPoint>& points() const { return points_; }
  /// Distance of the nearest triangle.
  Real distance(const Vec& p) const;
  /// Distance of one feature that is given by its corners.
  static Real distance(const std::vector<Vec>& corners, const Vec& p);
  /// The unit normals of all contacts of a ball here, one for each place that is touched within the slack, have rank 3.
  bool rigid(const Vec& center, const Real& slack) const;

 private:
  struct Feature {
    std::vector<Vec> corners;
    std::vector<std::size_t> vertices;  ///< their numbers, ascending
    Vec direction;                      ///< unit: of an edge along it, of a face its upward normal
    bool flat = false;                  ///< an edge between coplanar faces
    bool visible = true;                ///< can be touched from above
  };
  void number_features(const std::vector<SmallTerrain::Triangle>& triangles);
  void classify_edges();
  void corners();
  void seams();
  void triples();

  void on_three(const Feature& f, const Feature& g, const Feature& h);
  void beside_line(const Feature& line, const Feature& g, const Feature& h);
  void without_line(const std::vector<const Feature*>& three);
  void on_seam(const Feature& face, const Feature& edge, const Feature& other);
  void on_arc(const Feature& edge, const Vec& end, const Feature& other);

  /// Keeps a centre if a ball can rest there.
  void examine(const Vec& center);
  bool certain(const Vec& center) const;
  static Vec foot(const Feature& f, const Vec& p);
  static bool incident(const Feature& f, const Feature& g);
  bool far(const Feature& f, const Feature& g) const;

  /// Whether the ball about p touches the feature so that it would cut into it if the feature went on beyond its ends:
  /// in the inside, or at an end at right angles to it.
  bool in_touch(const Feature& f, const Vec& p, const Real& slack) const;

  Real radius_, slack_;
  BallOracle quick_;
  std::vector<Feature> features_;
  std::vector<Feature> vertical_;  ///< triangles that cannot be touched inside
  std::vector<ContactPoint> points_;
};

}  // namespace krepl::test
