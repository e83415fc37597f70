#pragma once

#include <span>
#include <unordered_map>
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

/// In place of a neighbour: the site itself, or a crossing of segments.
inline constexpr Index site_itself = none - 1;

/// What a finished face tells about the face of a neighbour: there, a link with `face` stands between `before` and
/// `after`, and the disks along it are empty.
struct Hint {
  Index face, before, after;
};
/// More hints than this about one face are in the order of the faces that tell them.
inline constexpr std::size_t few_hints = 16;

/// Counts for --verbose.
struct FaceCounters {
  std::uint64_t candidates = 0;  ///< sites looked at closely
  std::uint64_t searched = 0;    ///< faces that the hints did not settle
};

/// Computes faces one at a time: the face is the lower envelope of the bisectors with the site's neighbours. Those are
/// told by the faces around it that are finished, and searched for in a tree where no such face tells. The links of a face
/// stand in counter-clockwise order, from the perpendicular at the site's start to that at its end; an isolated vertex
/// has a closed border.
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
        reach_(sites.instance().extent()) {}

  /// Appends the face of an element in double precision. Returns false if it is certainly wrong: take build_among.
  /// Sides should come in order.
  bool build(Index element, std::span<const Hint> hints, std::vector<Link>& out);
  enum class Precision : char { plain = 0, twofold = 1, quadruple = 2, widest = 3 };
  /// The same in pairs of doubles, quadruple or 320-bit precision of the moved vertices: among the given elements only,
  /// or among all sites that come near.
  void build_among(Index element, std::span<const Index> labels, Precision precision, std::vector<Link>& out);
  void build_precisely(Index element, Precision precision, std::vector<Link>& out);

  FaceCounters counters;

 private:
  template <class Cell>
  void gather(Cell& cell, std::span<const Hint> hints, Vector<double> base);
  template <class Cell>
  bool gather_by_search(Cell& cell, std::span<const Hint> hints, Vector<double> base);
  bool begin_next_piece(bool split, std::span<const Hint> hints, Vector<double> base);
  struct Taken {
    Index site;
    SiteParts parts;
  };
  Taken& taken(Index site);
  template <class Cell>
  bool take(Cell& cell, Index site, SiteParts parts);
  template <class Cell>
  bool take(Cell& cell, Index label);
  template <class Cell>
  void judge(const Cell& cell, std::span<const Hint> hints, Vector<double> base);
  void find_known(std::span<const Hint> hints, Index before, Index after);
  bool find_seeds_beside_the_open();
  template <class Real>
  void build_with(SideCell<Real>& side, VertexCell<Real>& vertex, Index element, std::span<const Index> labels,
                  std::vector<Link>& out);
  template <class Real>
  void search_with(SideCell<Real>& side, VertexCell<Real>& vertex, Index element, std::vector<Link>& out);
  template <class Cell, class Precise>
  void gather_precisely(const Cell& cell, Precise& precise, Vector<double> base);
  bool find_candidates(Index element, std::span<const Hint> hints);
  SiteBoxes::Box site_box(Index site) const;
  void remember(Index element);
  bool is_short(double width, double first, double last) const;
  template <class Real>
  bool write(const SideCell<Real>& cell, std::vector<Link>& out);
  template <class Real>
  bool write(const VertexCell<Real>& cell, std::vector<Link>& out);

  const Sites& sites_;
  const SiteBoxes& boxes_;
  SideCell<double> side_;
  VertexCell<double> vertex_;
  SideCell<Twofold> twofold_side_;
  VertexCell<Twofold> twofold_vertex_;
  SideCell<quad> precise_side_;
  VertexCell<quad> precise_vertex_;
  Reach reach_;
  KnownEmpty known_;
  SiteBoxes::Memory memory_;
  std::vector<Taken> taken_;
  std::unordered_map<Index, std::size_t> taken_at_;  // where in taken_, once these are many
  std::vector<Index> labels_, near_, seeds_;
  std::vector<char> short_;
  struct Recent {
    Vector<double> normal{};
    std::vector<Index> labels;
  };
  Recent recent_[2];  // around the last two sides
};

}  // namespace krepl::voronoi
