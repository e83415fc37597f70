#pragma once

#include <vector>

#include "krepl/drop_cutter.hpp"
#include "model/terrain_window.hpp"
#include "terrain/drop_cutter_search.hpp"
#include "terrain/drop_cutter_shortlist.hpp"

namespace krepl::drop {

struct LowerBound;

/// Finds the triangles that a ball or another cutter may touch while its place moves along a stretch of a line. Keeps buffers and what
/// was touched last: one for each thread. The cutter must outlive it.
class StretchSearch {
 public:
  explicit StretchSearch(const DropCutter& cutter) : cutter_(cutter) {}

  const DropCutter& cutter() const { return cutter_; }
  /// About how far apart samples or vertices are.
  double cell() const;

  /// Replaces `parts` by triangles among which are all that the ball touches over any place between `from` and `to`
  /// with its centre (tip) above `floor`. False, and `parts` is of no use, if these are too many for a short list.
  bool list(Point from, Point to, double floor, std::vector<Part>& parts);
  /// As list(), for cutters that are no balls, with what the tool touches in the middle or at an end made `more` higher in place of all
  /// that is below that: base() is its tangent plane then, and `parts` are the triangles that may be higher than that.
  bool list(Point from, Point to, double floor, double more, std::vector<Part>& parts);
  /// Triangles among which are all on which the tool may rest higher than `floor` over some place of a rectangle, however many.
  void list_rectangle(Point low, Point high, double floor, std::vector<Part>& parts);
  /// The triangle that the tool rests on over a place; false if there is none.
  bool find_touched(Point place, Part& part);
  /// All triangles within R of the stretch, however many.
  void list_all(Point from, Point to, std::vector<Part>& parts);

  /// A plane over the stretch listed last: the tool rests nowhere lower than it, less `more`.
  struct Base {
    bool is_known = false;
    Point place{};
    double height = 0;  ///< over the place
    Point slope{};
  };
  const Base& base() const { return base_; }

  /// Whether the tool touched anything over the middle of the stretch listed last.
  bool touches() const { return touches_; }

 private:
  template <class Tree>
  LowerBound lower_bound(const Tree& tree, const Ball& ball, Point from, Point to, double half_x, double half_y,
                         double floor);
  template <class Tree>
  LowerBound lower_bound(const Tree& tree, const ProfileTool& tool, Point from, Point to, double half_x, double half_y,
                         double floor);

  const DropCutter& cutter_;
  bool touches_ = false;
  Base base_;
  Point last_place_;
  DropCutter::Contact last_;
  Index last_triangle_ = Terrain::none;
  TerrainWindow window_;
  LongList numbers_;
};

}  // namespace krepl::drop
