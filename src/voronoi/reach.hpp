#pragma once

#include <vector>

#include "voronoi/side_cell.hpp"
#include "voronoi/site_boxes.hpp"
#include "voronoi/vertex_cell.hpp"

namespace krepl::voronoi {

/// Which boxes may hold a site that cuts a face as found so far: those that meet one of the empty disks about the face's
/// border. Told a little too often (by 1e-9 of the disk and 2^-45 of the extent), so that ties are seen.
class Reach {
 public:
  /// `slack`: by how much boxes are widened, so that what only the move of vertices brings near is seen.
  explicit Reach(double slack) : slack_(slack) {}
  /// `base`: the place the cell's coordinates are relative to. `frame`: the same cell in double precision.
  template <class Real>
  void update(const SideCell<Real>& cell, const SideCell<double>& frame, Vector<double> base);
  template <class Real>
  void update(const VertexCell<Real>& cell, const VertexCell<double>& frame, Vector<double> base);
  /// A box around all empty disks.
  const SiteBoxes::Box& window() const { return window_; }
  bool meets(const SideCell<double>& cell, const SiteBoxes::Box& box, Vector<double> base) const;
  bool meets(const VertexCell<double>& cell, const SiteBoxes::Box& box, Vector<double> base) const;

 private:
  static constexpr double wider = 1 + 1e-9;

  /// The border between two parameters, its largest height in between, and that of all.
  struct Stretch {
    double begin, end, height;
    Vector<double> first, last;  // vertices: unit vectors of begin and end
  };
  static bool side_meets(const Stretch& s, Vector<double> low, Vector<double> high);
  static bool vertex_meets(const Stretch& s, Vector<double> centre, Vector<double> half);

  double slack_;
  void widen(Vector<double> centre, Vector<double> half);
  void close_window();

  std::vector<Stretch> stretches_;
  Vector<double> low_{}, high_{};
  SiteBoxes::Box window_{};
  Stretch whole_{};
};

}  // namespace krepl::voronoi
