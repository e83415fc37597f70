#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>

#include "krepl/context.hpp"
#include "krepl/cutter.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"
#include "krepl/terrain.hpp"

namespace krepl {

/// Lowers a ball or another cutter onto a terrain and says how high it comes to rest, and what it touches there. For a
/// ball, that is the height of the boundary of terrain (+) ball over a place of the plane.
///
/// The height is that of the highest of all tools that touch the upper side of some triangle from above. For balls:
/// planes moved by R along their normals, cylinders about edges, spheres about vertices (docs/drop_cutter.md); other
/// cutters, which are bodies of revolution with a convex profile, in docs/cutters.md. Their shank reaches as high as
/// the terrain does. What is at distance R from the axis counts as touched, to within 2^-50 S. It is found by a search in a
/// hierarchy of blocks, each bounded by its highest point and by a tilted plane above it, and evaluated in double
/// precision, or in quadruple precision where that would lose digits (steep triangles, slivers, the rim of the ball):
/// correct to 1e-12 S, with S the largest of the radius and the absolute coordinates.
///
/// The hierarchy does not depend on the radius, and is shared by cutters that are made from one another. A DropCutter is
/// immutable: any number of threads may use one at the same time. All coordinates are relative to terrain().origin().
class DropCutter {
 public:
  using Index = Terrain::Index;

  /// Where the tool rests.
  struct Contact {
    /// Of a ball's centre, of another cutter's tip (Cutter::control_height()); -infinity if the tool touches nothing
    /// (no part of the terrain within R of the place).
    double height = -std::numeric_limits<double>::infinity();
    /// Touched point of the terrain: at distance R from the ball's centre, or on the cutter's lower side. If a cutter
    /// touches a stretch of an edge or a part of a face (flat on a level face, a cone on a roof of its own slope): the
    /// point of the feature that is nearest to the axis. Without meaning if the tool touches nothing.
    Point3 point;
    /// The feature of lowest dimension that holds the touched point: a vertex or edge if the point lies on it (within 2^-46 S),
    /// else a face. If the ball touches several places at once, heights equal in double precision: the feature of lowest
    /// dimension, then of lowest number. Terrain::none if the ball touches nothing.
    Index feature = Terrain::none;

    bool touches() const { return feature != Terrain::none; }
    friend bool operator==(const Contact&, const Contact&) = default;
  };

  /// Places in rows: place (column, row) is first + (column * step_x, row * step_y). Steps may be zero or negative.
  struct Raster {
    Point first;
    double step_x = 1, step_y = 1;
    std::size_t columns = 0, rows = 0;
    Point place(std::size_t column, std::size_t row) const {
      return {first.x + double(column) * step_x, first.y + double(row) * step_y};
    }
  };

  /// Errors: radius not finite and positive (usage); radius or coordinates finer or coarser than double precision can hold
  /// together (radius outside 2^-50 .. 2^50 times the terrain's extent; extent outside 1e-20 .. 1e30); cancelled.
  ///
  /// Linear time, some 15 ns a sample of a grid and 200 ns a triangle of a mesh. Memory: 1.1 bytes a sample, 53 bytes a
  /// triangle.
  static Result<DropCutter> build(std::shared_ptr<const Terrain> terrain, double radius, const Context& context = {});

  /// With any cutter. Errors: of its radius, as above; a corner radius below 2^-50 of the radius (usage).
  static Result<DropCutter> build(std::shared_ptr<const Terrain> terrain, const Cutter& cutter,
                                  const Context& context = {});

  /// The same terrain with a ball of another size, or another cutter. Constant time. Errors: as build().
  Result<DropCutter> with_radius(double radius) const;
  Result<DropCutter> with_cutter(const Cutter& cutter) const;

  double radius() const { return cutter_.radius(); }
  const Cutter& cutter() const { return cutter_; }
  const Terrain& terrain() const { return *terrain_; }

  /// One place. A place that is not finite touches nothing. Expected O(log n); at worst (a hollow that fits the ball) linear
  /// in the number of triangles within R.
  Contact at(Point place) const;

  /// Many places, with the same bits as one by one, on context.threads threads. Neighbours in the order given help each other;
  /// if it has many jumps longer than R, the places are taken along a Hilbert curve (16 bytes a place for the time).
  /// Errors: contacts.size() != places.size() (usage); cancelled.
  Status at(std::span<const Point> places, std::span<Contact> contacts, const Context& context = {}) const;

  /// All places of a raster, row by row, with the same bits as one by one; for balls the fastest way. Errors as above.
  Status at(const Raster& raster, std::span<Contact> contacts, const Context& context = {}) const;

 private:
  friend class DropCutterAccess;
  class Hierarchy;
  template <class Tree, class Tool>
  class TileWork;
  DropCutter(std::shared_ptr<const Terrain> terrain, std::shared_ptr<const Hierarchy> hierarchy, const Cutter& cutter)
      : terrain_(std::move(terrain)), hierarchy_(std::move(hierarchy)), cutter_(cutter) {}
  /// Calls work(tree, tool): the hierarchy's tree, and the ball or cutter without a place.
  template <class Work>
  auto with_tools(const Work& work) const;

  std::shared_ptr<const Terrain> terrain_;
  std::shared_ptr<const Hierarchy> hierarchy_;
  Cutter cutter_;
};

}  // namespace krepl
