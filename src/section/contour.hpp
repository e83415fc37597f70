#pragma once

#include "section/tracing.hpp"

namespace krepl::section {

/// One contour of a surface, ring by ring.
class ContourTracer {
 public:
  ContourTracer(const Parts& parts, double level, const ContourOptions& options);
  Result<Contour> run();

 private:
  /// A rim near the level: its crossings part it into stretches, numbered from first_stretch on. Where one side of a
  /// stretch is high and the other low, the contour runs below the rim.
  struct Rim {
    Index edge, first_crossing, crossing_count;
    bool left_starts_high, right_starts_high;
  };
  struct Stretch {
    std::size_t rim = 0;
    Index number = 0;
    bool forwards = true;  ///< along half-edge 2e
  };

  bool is_high(Index corner) const { return parts_.corner_height(corner) >= level_; }
  void collect_edges();
  void move_off_vertices();
  void cross_edge(Index e);
  void cross_rim(Index e);
  bool is_wall(const Rim& rim, Index stretch) const;
  std::size_t visited_index(const Stretch& s) const { return rims_[s.rim].first_crossing + s.rim + s.number; }
  Stretch stretch_from(Index crossing) const;
  Stretch stretch_after(Index half_edge) const;
  std::size_t find_rim(Index edge) const;
  bool follow(Index crossing);
  bool trace();
  Index add_wall(Stretch stretch);
  void add_patch_piece(Index from, Index to);
  void add_domes();
  void end_ring();
  Point3 at_level(Point3 p) const { return {p.x, p.y, contour_.level}; }

  const Parts& parts_;
  const ContourOptions& options_;
  double level_;  ///< moved off vertices
  Contour contour_;
  Tracing tracing_;
  std::vector<Index> edges_;
  std::vector<Rim> rims_;
  std::vector<bool> entered_, walked_;
};

}  // namespace krepl::section
