#pragma once

#include <vector>

#include "krepl/drop_cutter.hpp"
#include "model/terrain_window.hpp"
#include "terrain/drop_cutter_search.hpp"

namespace krepl::drop {

/// Finds the triangles that a ball may touch while its place moves along a stretch of a line. Keeps buffers and what
/// was touched last: one for each thread. The cutter must outlive it.
class StretchSearch {
 public:
  explicit StretchSearch(const DropCutter& cutter) : cutter_(cutter) {}

  const DropCutter& cutter() const { return cutter_; }
  /// About how far apart samples or vertices are.
  double cell() const;

  /// Replaces `parts` by triangles among which are all that the ball touches over any place between `from` and `to`
  /// with its centre above `floor`. False, and `parts` is of no use, if these are too many for a short list.
  bool list(Point from, Point to, double floor, std::vector<Part>& parts);
  /// All triangles within R of the stretch, however many.
  void list_all(Point from, Point to, std::vector<Part>& parts);

  /// Whether the ball touched anything over the middle of the stretch listed last.
  bool touches() const { return touches_; }

 private:
  const DropCutter& cutter_;
  bool touches_ = false;
  Point last_place_;
  DropCutter::Contact last_;
  Index last_triangle_ = Terrain::none;
  TerrainWindow window_;
};

}  // namespace krepl::drop
