#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "section/patch.hpp"

namespace krepl::section {

/// What is known of a surface before it is cut.
struct Parts {
  struct Box {
    Point3 low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};
    void add(Point3 p);
    void add(const Box& b);
    void widen(double by);
  };
  /// A face on a sphere in which a whole level circle may lie.
  struct Dome {
    Index face;
    double low, top;  ///< heights of the sphere's centre and of its highest point
    bool holds_top;   ///< the highest point lies in the face
  };

  static constexpr double infinite = std::numeric_limits<double>::infinity();
  static constexpr Index arity = 8;

  explicit Parts(std::shared_ptr<const Surface> s);

  const Subdivision& topology() const { return surface->subdivision(); }
  Patch patch(Index face) const { return {surface->terrain(), surface->face_feature(face), surface->radius(), scale}; }
  bool is_rim(Index edge) const { return surface->edge(edge).kind == Surface::EdgeKind::rim; }
  /// Height of the face's patch where half-edge h starts. -infinity for a face without a patch.
  double corner_height(Index h) const;
  /// Of the face of `h`; the half-edge of that corner on the other side of h.
  Index corner_beyond(Index h) const { return topology().next[Subdivision::twin(h)]; }
  /// What edge e is certainly in, down to the foot of a wall.
  Box edge_box(Index e) const;
  /// True if the face's border goes around a place.
  bool face_holds(Index face, Point p) const;

  /// Calls visit(e) for the edges, ascending, whose boxes and those around them fulfil a condition.
  template <class Condition, class Visit>
  void each_edge(const Condition& meets, const Visit& visit) const {
    if (!levels.empty()) descend(levels.size() - 1, 0, meets, visit);
  }

  bool build(const Context& context);

  std::shared_ptr<const Surface> surface;
  double scale = 0;
  double shift = 0;  ///< by which levels and lines are moved off vertices
  struct LowerCorner {
    Index half_edge;
    double height;
  };
  std::vector<LowerCorner> lower_corners;  ///< ascending; at the feet of walls
  std::vector<std::vector<Box>> levels;    ///< levels[0]: a box for each `arity` edges, and so on up to one box
  std::vector<Dome> domes;                 ///< ascending

 private:
  template <class Condition, class Visit>
  void descend(std::size_t level, std::size_t index, const Condition& meets, const Visit& visit) const {
    if (!meets(levels[level][index])) return;
    const std::size_t first = index * arity;
    const std::size_t count = level == 0 ? topology().edge_count() : levels[level - 1].size();
    for (std::size_t i = first; i < std::min(first + arity, count); ++i) {
      if (level > 0)
        descend(level - 1, i, meets, visit);
      else if (meets(edge_box(Index(i))))
        visit(Index(i));
    }
  }
  void find_lower_corners();
  bool find_boxes(const Context& context);
  bool find_domes(const Context& context);
  std::optional<Dome> dome(Index face) const;
};

}  // namespace krepl::section
