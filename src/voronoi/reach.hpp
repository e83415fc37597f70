#pragma once

#include <vector>

#include "voronoi/side_cell.hpp"
#include "voronoi/site_boxes.hpp"
#include "voronoi/vertex_cell.hpp"

namespace krepl::voronoi {

/// Which disks about a face's border are known to be empty, as neighbouring faces have been found already: those along an
/// arc of the border between its ends, and those where arcs meet (before the arc of the same number, and one at the end).
struct KnownEmpty {
  std::vector<char> arcs, joints;
  void assign(std::size_t count, char value) { arcs.assign(count, value), joints.assign(count + 1, value); }
};

/// Which boxes may hold a site that cuts a face as found so far: those that meet one of the empty disks about the
/// face's border. Along a bisector with a point, all disks lie in the two at its ends; along one with a line also in
/// the strip between the line's places that these two touch. Told a little too often (by 1e-9 of the disk or, if that is
/// less, of the extent), so that ties are seen. Coordinates are relative to the place given as base.
class Reach {
 public:
  explicit Reach(double extent) : slack_(0x1p-45 * extent), most_(extent) {}
  /// `frame`: the same cell in double precision. Disks known to be empty are left out.
  template <class Real>
  void update(const SideCell<Real>& cell, const SideCell<double>& frame, Vector<double> base, const KnownEmpty& known);
  template <class Real>
  void update(const VertexCell<Real>& cell, const VertexCell<double>& frame, Vector<double> base,
              const KnownEmpty& known);

  bool meets(const SiteBoxes::Box& box) const;
  /// True if nothing can meet it.
  bool is_empty() const { return disks_.empty() && strips_.empty() && sectors_.empty(); }
  /// True if the face still reaches the horizon.
  bool is_open() const { return open_; }
  /// A box around all empty disks.
  const SiteBoxes::SearchWindow& window() const { return window_; }

 private:
  static constexpr double wider = 1 + 1e-9;

  struct Disk {
    Vector<double> centre;
    double square;
  };
  /// Places that lie up to `height` from a line on the side of `normal`, between two parameters along it.
  struct Strip {
    Vector<double> origin, normal;
    double low, high, height;
  };
  /// Between two directions, counter-clockwise.
  struct Sector {
    Vector<double> first, last;
  };

  void start(Vector<double> base);
  void add_disk(Vector<double> centre, double radius);
  void add_strip(Vector<double> p, Vector<double> q, Vector<double> normal, double height);
  void widen(Vector<double> centre, double half);
  void close();

  double slack_;  // by which boxes are widened, so that what only the move of vertices brings near is seen
  double most_;   // no site lies farther from a place on a disk that touches one
  bool open_ = false;
  Vector<double> base_{};
  std::vector<Disk> disks_;
  std::vector<Strip> strips_;
  std::vector<Sector> sectors_;
  Vector<double> low_{}, high_{};
  SiteBoxes::SearchWindow window_;
};

}  // namespace krepl::voronoi
