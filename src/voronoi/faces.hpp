#pragma once

#include <span>
#include <vector>

#include "voronoi/reach.hpp"

namespace krepl::voronoi {

/// A stretch of a face's border: the neighbour (none: the horizon, the face is unbounded), and where it ends.
struct Link {
  Index label = none;
  double clearance = 0;  ///< distance of the end from the sites
  double minimum = 0;    ///< the least distance along the link
  Point end{};           ///< relative to the network's origin
};

/// Counts for --verbose.
struct FaceCounters {
  std::uint64_t candidates = 0;  ///< sites looked at closely
};

/// Computes faces one at a time: the site's neighbours are searched in a tree, the face is the lower envelope of the
/// bisectors. The links of a face stand in counter-clockwise order, from the perpendicular at the site's start to that
/// at its end; an isolated vertex has a closed border.
class FaceBuilder {
 public:
  FaceBuilder(const Sites& sites, const SiteBoxes& boxes)
      : sites_(sites),
        boxes_(boxes),
        side_(sites),
        vertex_(sites),
        twofold_side_(sites),
        twofold_vertex_(sites),
        precise_side_(sites),
        precise_vertex_(sites),
        reach_(0x1p-45 * sites.instance().extent()) {}

  /// Appends the face of an element in double precision. Returns false if it is certainly wrong: take build_precisely.
  /// `hints`: likely neighbours. Sides should come in order.
  bool build(Index element, std::span<const Index> hints, std::vector<Link>& out);
  enum class Precision : char { plain = 0, twofold = 1, quadruple = 2, widest = 3 };
  /// The same in pairs of doubles, quadruple or 320-bit precision of the moved vertices, among the sites that come near
  /// in double precision.
  void build_precisely(Index element, Precision precision, std::vector<Link>& out);

  FaceCounters counters;

 private:
  template <class Cell>
  void gather(Cell& cell, Index around, Vector<double> base, Vector<double> from);
  template <class Real>
  void build_with(SideCell<Real>& side, VertexCell<Real>& vertex, Index element, std::vector<Link>& out);
  template <class Cell, class Precise>
  void gather_precisely(const Cell& cell, Precise& precise, Vector<double> base);
  bool find_candidates(Index element, std::span<const Index> hints);
  SiteBoxes::Box site_box(Index site) const;
  Index site_of(Index label) const;
  void remember(Index element);
  template <class Real>
  bool write(const SideCell<Real>& cell, std::vector<Link>& out) const;
  template <class Real>
  bool write(const VertexCell<Real>& cell, std::vector<Link>& out) const;

  const Sites& sites_;
  const SiteBoxes& boxes_;
  SideCell<double> side_;
  VertexCell<double> vertex_;
  SideCell<Twofold> twofold_side_;
  VertexCell<Twofold> twofold_vertex_;
  SideCell<quad> precise_side_;
  VertexCell<quad> precise_vertex_;
  Reach reach_;
  SiteBoxes::Memory memory_;
  std::vector<Index> candidates_, near_, seeds_;
  struct Recent {
    Vector<double> normal{};
    std::vector<Index> sites;
  };
  Recent recent_[2];  // around the last two sides
};

}  // namespace krepl::voronoi
