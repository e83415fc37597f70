#pragma once

#include <vector>

#include "solid/topology.hpp"

namespace krepl::solid {

/// How two faces meet, and the corners of the solid along the column over each vertex of the plane: where faces meet in
/// a wall they have corners of their own, one above the other.
class Borders {
 public:
  using Index = Surface::Index;
  static constexpr Index none = Surface::none;

  enum class Meeting {
    shared,  ///< in one edge
    wall,    ///< in a vertical wall between an upper and a lower edge
    outline  ///< a face and nothing: the surface ends there, or a wall goes down to the floor
  };

  Borders(const Surface& surface, const Topology& topology, double tolerance);

  Meeting meeting(Index h) const { return Meeting(meeting_[h]); }
  /// Of a wall or outline: whether the face of half-edge h is the upper one.
  bool is_upper(Index h) const { return upper_[h]; }
  /// The corner of h's face at h's origin; none where the face touches nothing.
  Index corner(Index h) const { return corner_[h]; }
  /// The same at h's end.
  Index end_corner(Index h) const { return corner_[topology_->next(h)]; }
  const std::vector<Point3>& corners() const { return place_; }
  /// Corners over the origin of h, the highest first.
  std::vector<Index> column(Index h) const;

 private:
  void find_meetings(double tolerance);
  void find_corners(double tolerance);
  std::vector<Index> around(Index h) const;
  void find_column(const std::vector<Index>& around, double tolerance);
  double height(const std::vector<Index>& around, const std::vector<std::size_t>& group, std::size_t wanted) const;

  const Surface* surface_;
  const Topology* topology_;
  std::vector<std::uint8_t> meeting_;
  std::vector<bool> upper_;
  std::vector<Index> corner_;
  std::vector<Point3> place_;
};

}  // namespace krepl::solid
