#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"

namespace krepl {

/// How water runs and how lines are joined.
struct RiverOptions {
  enum class Flow {
    digitised,  ///< from a line's first vertex to its last one, but for the features in `against`
    outlet      ///< towards the outlet, whatever way the lines were digitised
  };
  Flow flow = Flow::digitised;
  /// Flow::digitised: features (by the numbers of the Network) whose lines were digitised against the water.
  std::vector<std::int64_t> against;
  /// Flow::outlet: places where the water leaves; each means the vertex nearest to it. A connected part of the network
  /// that gets none has its outlet guessed: the end of a line from which, looking upstream, the confluences turn least.
  std::vector<Point> outlets;
  /// A free end of a line that is at most this far from another line (in the unit of the coordinates, 0 or more) is
  /// moved to the nearest vertex there, or to the line where no vertex is so near. 0 joins what touches already.
  double snap = 0;
  /// Vertices and crossings are rounded to a grid of at most this pitch (a power of two), so what is nearer together
  /// becomes one. 0, or less than the distance of doubles at the largest coordinate: that distance, which moves hardly
  /// anything.
  double grid = 0;
};

/// What building a RiverNetwork changed, dropped and found.
struct RiverReport {
  // The input.
  std::size_t lines = 0;              ///< lines and rings with two different vertices at least
  std::size_t ignored_points = 0;     ///< points, and lines that are no longer than one
  std::size_t repeated_vertices = 0;  ///< consecutive equal vertices (zero-length segments dropped)
  double input_length = 0;            ///< of all segments as given, repeated ones included
  // Changes.
  std::size_t ends_to_vertices = 0;    ///< free ends moved to a vertex, within RiverOptions::snap
  std::size_t ends_to_lines = 0;       ///< free ends moved to the inside of a segment
  std::size_t crossings = 0;           ///< vertices added where lines cross
  std::size_t touches = 0;             ///< cuts of segments at vertices that lie on them
  std::size_t duplicates = 0;          ///< segments, or parts of them, dropped because another one covers them
  std::size_t opposed_duplicates = 0;  ///< of them, those that ran the other way; the first one in the input counts
  double duplicate_length = 0;
  double largest_move = 0;  ///< of a vertex or crossing: rounding to the grid, and snapping
  double grid = 0;          ///< its pitch
  // Findings.
  std::size_t components = 0;  ///< connected parts
  std::size_t guessed_outlets = 0;
  double outlet_distance = 0;      ///< largest distance from a given outlet to its vertex
  std::size_t turned_reaches = 0;  ///< Flow::outlet: reaches that were digitised against the flow for the most part
  std::size_t cycle_reaches = 0;   ///< reaches that close a directed cycle
  std::size_t rivers = 0;          ///< main stems
};

/// Rivers with their tributaries as a graph, taken apart into sub-rivers [javgal2006, section 3.1].
///
/// A *node* is an end of a line, or a vertex where three or more lines meet, or where the flow of two collides or
/// parts, or an outlet. A *reach* runs from node to node with the flow. A *fusion vertex* is a node that several
/// reaches run into. A *sub-river* is a chain of reaches from a source to a drain: it starts where nothing runs in or
/// where water branches off, and ends where nothing runs out or where it joins a longer one. It visits no vertex twice,
/// but for a loop, which ends where it began. Every reach belongs to exactly one sub-river.
///
/// Any lines will do: crossing, overlapping, repeated, looping, disconnected, braided, with many outlets. Lines are cut
/// where they cross or touch; vertices stay where they are but for rounding to a grid (RiverReport::grid) and for the
/// ends of lines within RiverOptions::snap. A cut segment is within RiverReport::grid of what it was.
class RiverNetwork {
 public:
  using Index = std::uint32_t;

  struct Node {
    Point at;
    std::uint32_t in, out;  ///< reaches that end and that start here
    bool is_source() const { return in == 0; }
    bool is_drain() const { return out == 0; }
    bool is_fusion() const { return in > 1; }
    bool is_bifurcation() const { return out > 1; }
  };

  struct Reach {
    Index from, to;  ///< nodes; the same one for a loop
    double length;
    std::int64_t feature;  ///< the input feature that most of it comes from
    Index sub_river;
    /// Strahler's [strahler1957]: 1 at sources; where at least two of the highest order m meet, m + 1; else m. What
    /// branches off carries its river's order, but does not raise any order further down, so that a braid that unites
    /// again stays what it was.
    std::uint32_t order;
    /// Left out when lengths and orders are told, so that there is no cycle; a sub-river of its own.
    bool closes_cycle;
  };

  struct SubRiver {
    Index from, to;  ///< nodes
    double length;
    std::uint32_t order;              ///< of its last reach
    std::optional<Index> downstream;  ///< the sub-river that it joins at its end
    Index stem;                       ///< the main stem that its water comes to, or comes from if it only branches off
    bool is_stem;                     ///< a main stem: it joins no other and branches off none
    std::int64_t feature;             ///< the input feature that most of it comes from
  };

  /// Errors: no line at all; `snap` or `grid` negative or not finite; an outlet that is not finite; cancelled. O(n log
  /// n) but for lines that cross massively (see docs/rivers.md). The same input gives the same result for any number of
  /// threads.
  static Result<RiverNetwork> build(const Network& network, const RiverOptions& options = {},
                                    const Context& context = {});

  std::span<const Node> nodes() const { return nodes_; }
  std::span<const Reach> reaches() const { return reaches_; }
  /// The longest first.
  std::span<const SubRiver> sub_rivers() const { return sub_rivers_; }
  /// Reaches of a sub-river, downstream.
  std::span<const Index> reaches_of(Index sub_river) const;
  /// Vertices of a reach from its `from` to its `to`, at least two, in absolute coordinates.
  std::span<const Point> reach_line(Index reach) const;
  std::vector<Point> sub_river_line(Index sub_river) const;
  /// Lines of these sub-rivers as input for zones; a line's feature is the sub-river's number. Error: none given.
  Result<Network> network(std::span<const Index> sub_rivers, const Context& context = {}) const;

  const RiverReport& report() const { return report_; }

 private:
  friend class RiverBuilder;
  std::vector<Node> nodes_;
  std::vector<Reach> reaches_;
  std::vector<SubRiver> sub_rivers_;
  std::vector<Point> points_;       // of all reaches, one after the other
  std::vector<Index> reach_begin_;  // per reach, and the end
  std::vector<Index> member_, member_begin_;
  RiverReport report_;
};

}  // namespace krepl
