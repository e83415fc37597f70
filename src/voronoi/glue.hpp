#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "voronoi/diagram.hpp"

namespace krepl::voronoi {

/// The borders of all faces while they are brought to agree: a face that is done again moves to the end.
class Borders {
 public:
  explicit Borders(const Sites& sites) : sites_(sites), in_(sites.instance()), horizon_(sites.horizon()) {}

  std::vector<Link> links;
  std::vector<Index> first, count;  // per face

  std::span<const Link> border(Index face) const { return {links.data() + first[face], count[face]}; }
  /// The link of the other face that is the same stretch: between the same neighbours, in the opposite order; at an end
  /// where more than three faces meet, neighbours may differ and the place is the same. None if there is none, or if two
  /// would do.
  Index twin(Index face, Index link) const;
  /// Room to remember the twins of all links found from now on: a face that stays where it is keeps them. O(faces), and
  /// sorts the links of faces with many: each of their neighbours looks for its own.
  void remember_twins();
  /// True if the link has its twin, or lies along the horizon and has no neighbour.
  bool is_sound(Index face, Index link) const {
    return links[link].label == none ? links[link].minimum > horizon_ / 2 : twin(face, link) != none;
  }
  /// A link that the other face sees as well but that is too short for its own numbers: two links that it separates
  /// follow each other there, and end where this one lies. Puts it in between. Returns false if the other face does not
  /// look like that.
  bool insert_twin(Index face, Index link, double tolerance);
  /// The reverse: leaves a link out that the other face does not see, if it is shorter than the tolerance.
  bool remove_short(Index face, Index link, double tolerance);
  /// What stands before and after a link of a face; site_itself at the site itself and where segments cross.
  Index before(Index face, Index link) const;
  Index after(Index face, Index link) const;

 private:
  Index find_twin(Index face, Index link) const;
  template <class Visit>
  void each_labelled(Index face, Index label, Visit&& visit) const;
  struct Spot {
    Point place;
    double clearance;
  };
  Spot start(Index face, Index link) const;
  Spot end(Index link) const { return {links[link].end, links[link].clearance}; }
  bool coincide(Spot a, Spot b) const;
  bool is_closed(Index face) const { return !in_.is_side(face) && in_.sector(in_.vertex_of(face)).before == face; }
  /// The two sides of one segment follow each other where it crosses the face's own.
  Index neighbour(Index label, Index next) const {
    return next == (label ^ 1u) && label != none && next != none && in_.is_side(label) ? site_itself : next;
  }

  const Sites& sites_;
  const Instance& in_;
  double horizon_;
  struct ByLabel {
    Index first = none;  // where the face stood: its links stay as they are there
    std::vector<Index> links;
  };
  std::unordered_map<Index, ByLabel> by_label_;  // faces with many links
  mutable std::vector<Index> twins_;  // of links, as far as they are known; written by whoever asks for that link
};

/// Gives every end of a link its vertex; links that end in the same vertex share it. Where the faces around a vertex do
/// not agree on its place to a few units in the last place, it is evaluated in quadruple precision.
void place_vertices(const Sites& sites, const Borders& borders, const Context& context, Diagram& diagram);

}  // namespace krepl::voronoi
