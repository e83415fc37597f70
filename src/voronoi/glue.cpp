#include "voronoi/glue.hpp"

namespace krepl::voronoi {

Index Borders::before(Index face, Index link) const {
  if (link == first[face]) {
    if (!is_closed(face) || count[face] == 1) return Diagram::base;
    return neighbour(links[link].label, links[first[face] + count[face] - 1].label);
  }
  return neighbour(links[link].label, links[link - 1].label);
}

Index Borders::after(Index face, Index link) const {
  if (link + 1 == first[face] + count[face]) {
    if (!is_closed(face) || count[face] == 1) return Diagram::base;
    return neighbour(links[link].label, links[first[face]].label);
  }
  return neighbour(links[link].label, links[link + 1].label);
}

Index Borders::twin(Index face, Index link) const {
  const Index other = links[link].label;
  if (other == none) return none;
  const Index p = before(face, link), n = after(face, link);
  Index found = none;
  for (Index i = first[other]; i < first[other] + count[other]; ++i) {
    if (links[i].label != face || before(other, i) != n || after(other, i) != p) continue;
    if (found != none) return none;
    found = i;
  }
  return found;
}

}  // namespace krepl::voronoi
