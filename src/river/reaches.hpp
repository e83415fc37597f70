#pragma once

#include <vector>

#include "river/lines.hpp"

namespace krepl::river {

/// Edges put together to chains between nodes.
struct Reaches {
  struct Reach {
    Index from, to;           // nodes
    std::size_t first, last;  // places in `chain`
    double length;
    double against;        // of this length, what was digitised the other way
    std::int64_t feature;  // of most of it; the lowest one of several
  };
  std::vector<Index> node;  // per node: its vertex; ascending
  std::vector<Reach> reaches;
  std::vector<Index> chain;  // vertices of all reaches

  void turn(Reach& reach);
};

/// Nodes are the vertices with another number of edges than two, those in `more`, if `directed` those where the edges
/// do not go on in one sense, and the lowest vertex of a ring that has none of these. If `directed`, reaches have the
/// sense of their edges, else that of the longer part of them.
Reaches make_reaches(const Edges& edges, const std::vector<Index>& more, bool directed);

/// Turns the reaches so that all water comes to an outlet: each part of the network is drained through those of
/// `outlets` (nodes) that lie on it; a part without gets one by guess_outlet. Reaches run from the end that is further
/// from the outlet, along the network, to the nearer one, so there are no cycles but loops.
void direct_to_outlets(Reaches& reaches, const Edges& edges, const std::vector<Index>& outlets, RiverReport& report);

/// The node of a connected part of the network (given by its nodes) that its water most probably leaves by.
///
/// Tributaries come in at acute angles. Of all ends of lines, the one is taken for which the sum of cosines of the
/// turns that water makes in confluences on its way down is greatest. A spanning tree of the part is looked at; linear
/// time.
class OutletGuess {
 public:
  OutletGuess(const Reaches& reaches, const Edges& edges);
  Index outlet(const std::vector<Index>& nodes);

 private:
  struct Arm {
    Index node;     // at the other end
    Point heading;  // unit vector out of this one
    Point heading_there;
  };
  Point heading(const Reaches::Reach& reach, bool at_end, const Edges& edges) const;
  double gain(Index node, Point heading_down) const;

  const Reaches& reaches_;
  std::vector<std::vector<Arm>> arms_;  // of the spanning forest
  std::vector<std::uint32_t> degree_;
  std::vector<bool> arrives_;  // a reach was digitised to the node
  std::vector<Point> sum_;     // of the headings of the arms
};

}  // namespace krepl::river
