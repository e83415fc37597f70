#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"
#include "krepl/terrain.hpp"

/// Free space: where a disk may be among obstacles of the plane, where a ball may be above a terrain, how much room is
/// left there, and where a straight motion first cuts in (thesis chapters 3 and 4: outside the Minkowski sum;
/// docs/free.md).
///
/// A placement is free if the centre is not inside the sum of obstacle and disk or ball: touching is free. Clearance is
/// the signed distance to contact: the centre's distance from the obstacle, less R, so free is clearance >= 0. It is
/// correct to 1e-13 S, and what is within 2^-46 S of contact counts as touching: its clearance is 0. S is the largest
/// of R and the absolute coordinates of obstacle and placement, after the input's origin is taken off. All coordinates
/// here are the input's own.
///
/// Objects are immutable: any number of threads may use one at the same time.
namespace krepl {

/// Free space of a disk among lines, points and filled polygons.
class DiskFreeSpace {
 public:
  struct Contact {
    /// Where the centre lies inside a polygon: -(R + the distance to the nearest line or point of the input). NaN if
    /// the placement is not finite.
    double clearance = std::numeric_limits<double>::quiet_NaN();
    Point point;  ///< the nearest point of the lines, outlines and points; of several the one of lowest number
    bool at_vertex = false;  ///< it is a vertex of the input (to within 2^-46 S), else on a segment
    /// Feature, part and vertex (of a segment the first one) that the point belongs to.
    Network::Source source;

    bool free() const { return clearance >= 0; }
  };

  /// Where a motion first cuts in.
  struct Cut {
    std::size_t leg = 0;  ///< of a polyline: from points[leg] to points[leg + 1]
    double t = 0;         ///< in [0, 1] of the leg
    Point place;          ///< of the centre
    Contact contact;      ///< there
  };

  /// Errors: radius not finite and positive (usage); coordinates or radius beyond 1e100, radius below 1e-100;
  /// cancelled. Linear time; some 40 bytes a segment.
  static Result<DiskFreeSpace> build(std::shared_ptr<const Network> network, double radius,
                                     const Context& context = {});

  double radius() const { return radius_; }
  const Network& network() const { return *network_; }

  /// Expected O(log n); at worst (a circle's outline about the placement) linear.
  Contact clearance(Point place) const;
  bool is_free(Point place) const { return clearance(place).free(); }
  /// The same for many placements, with the same bits for any number of threads. Errors: contacts.size() !=
  /// places.size() (usage); cancelled.
  Status clearance(std::span<const Point> places, std::span<Contact> contacts, const Context& context = {}) const;

  /// Where the disk, moving straight, first cuts into an obstacle: it touches there, and goes on to cut in by more than
  /// 2^-46 S. Touching alone does not end a motion: a disk may slide along a wall. At t = 0 if it is not free at the
  /// start. Nothing if all of the motion is free. The root is within 1e-12 S of the boundary of the sum.
  std::optional<Cut> first_contact(Point from, Point to) const;
  /// Where a polyline of placements first fails; nothing if it is free. A single point is a placement.
  std::optional<Cut> first_contact(std::span<const Point> points) const;
  bool is_free(std::span<const Point> points) const { return !first_contact(points); }

 private:
  class Index;
  DiskFreeSpace(std::shared_ptr<const Network> network, std::shared_ptr<const Index> index, double radius)
      : network_(std::move(network)), index_(std::move(index)), radius_(radius) {}
  std::shared_ptr<const Network> network_;
  std::shared_ptr<const Index> index_;
  double radius_;
};

/// Free space of a ball above a terrain or part: everything below the upper side of a triangle is solid. Outside the
/// terrain's domain nothing is.
class BallFreeSpace {
 public:
  struct Contact {
    /// Where the centre itself is in the solid: -(R + how far the upper side is above it, along the vertical). NaN if
    /// the placement is not finite.
    double clearance = std::numeric_limits<double>::quiet_NaN();
    /// The nearest point of the solid: on a triangle, or level with the centre on the wall below an edge or vertex at
    /// the border of the domain or of an overhang. Where the centre is in the solid: the upper side above it.
    Point3 point;
    /// The face, edge or vertex of the terrain that the point lies on (to within 2^-46 S) or below. Of several nearest
    /// points whose distances are equal in double precision that of lowest dimension, then of lowest number.
    Terrain::Index feature = Terrain::none;

    bool free() const { return clearance >= 0; }
  };

  struct Cut {
    std::size_t leg = 0;
    double t = 0;
    Point3 place;
    Contact contact;
  };

  /// Errors: radius not finite and positive, or below 2^-50 of the terrain's extent (usage); coordinates or radius
  /// beyond 1e100, radius below 1e-100; cancelled. Linear time; 3 bytes a sample of a grid, 6 bytes a triangle of a
  /// mesh.
  static Result<BallFreeSpace> build(std::shared_ptr<const Terrain> terrain, double radius,
                                     const Context& context = {});
  /// The same terrain with a ball of another size. Constant time.
  Result<BallFreeSpace> with_radius(double radius) const;

  double radius() const { return radius_; }
  const Terrain& terrain() const { return *terrain_; }

  /// Expected O(log n); at worst (a hollow that fits the ball) linear.
  Contact clearance(Point3 place) const;
  bool is_free(Point3 place) const { return clearance(place).free(); }
  Status clearance(std::span<const Point3> places, std::span<Contact> contacts, const Context& context = {}) const;

  /// As for disks: the first t at which the ball touches and goes on to cut in.
  std::optional<Cut> first_contact(Point3 from, Point3 to) const;
  std::optional<Cut> first_contact(std::span<const Point3> points) const;
  bool is_free(std::span<const Point3> points) const { return !first_contact(points); }

 private:
  class Index;
  BallFreeSpace(std::shared_ptr<const Terrain> terrain, std::shared_ptr<const Index> index, double radius)
      : terrain_(std::move(terrain)), index_(std::move(index)), radius_(radius) {}
  std::shared_ptr<const Terrain> terrain_;
  std::shared_ptr<const Index> index_;
  double radius_;
};

}  // namespace krepl
