#pragma once

#include <algorithm>
#include <cmath>
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
  bool is_empty() const { return disks_.empty() && base_strips_.empty() && strips_.empty() && sectors_.empty(); }
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
  /// Of a side, along its own line: from the base, `height` up on the side's side.
  struct BaseStrip {
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
  /// Around a strip that stands on p q.
  void widen(Vector<double> p, Vector<double> q, Vector<double> up);
  void close();

  double slack_;  // by which boxes are widened, so that what only the move of vertices brings near is seen
  double most_;   // no site lies farther from a place on a disk that touches one
  bool open_ = false;
  Vector<double> base_{};
  bool of_side_ = false;
  Vector<double> outwards_{};  // of a side: all disks touch its line from there
  double below_ = 0;           // of a side: how far its disks reach over the line, as they are widened
  std::vector<Disk> disks_;
  std::vector<BaseStrip> base_strips_;
  std::vector<Strip> strips_;
  std::vector<Sector> sectors_;
  Vector<double> low_{}, high_{};
  SiteBoxes::SearchWindow window_;
};

/// How far a box reaches in a direction of length 1.
inline double half_along(Vector<double> half, Vector<double> d) { return std::abs(d.x) * half.x + std::abs(d.y) * half.y; }

inline bool Reach::meets(const SiteBoxes::Box& box) const {
  const Vector<double> c = box.centre - base_, h = box.half;
  double up = 0, up_half = 0;
  if (of_side_) {  // half of all boxes are on the wrong side
    up = dot(c, outwards_), up_half = half_along(h, outwards_);
    if (up + up_half < -below_) return false;
  }
  for (const Disk& d : disks_) {
    const double dx = std::max(std::abs(c.x - d.centre.x) - h.x, 0.0),
                 dy = std::max(std::abs(c.y - d.centre.y) - h.y, 0.0);
    if (dx * dx + dy * dy <= d.square) return true;
  }
  if (!base_strips_.empty()) {
    const double along = outwards_.x * c.y - outwards_.y * c.x, half = half_along(h, {outwards_.y, outwards_.x});
    for (const BaseStrip& s : base_strips_) {
      if (up - up_half <= s.height && along + half >= s.low && along - half <= s.high) return true;
    }
  }
  for (const Strip& s : strips_) {
    const Vector<double> v = c - s.origin, n = s.normal;
    const double above = dot(v, n), half = half_along(h, n);
    if (above + half < -slack_ || above - half > s.height) continue;
    const double along = n.x * v.y - n.y * v.x, half_width = half_along(h, {n.y, n.x});
    if (along + half_width >= s.low && along - half_width <= s.high) return true;
  }
  const auto highest = [&](Vector<double> d) { return dot(d, c) + half_along(h, d); };
  for (const Sector& s : sectors_) {
    if (highest({-s.first.y, s.first.x}) >= -slack_ && highest({s.last.y, -s.last.x}) >= -slack_) return true;
  }
  return false;
}

}  // namespace krepl::voronoi
