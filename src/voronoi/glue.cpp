#include "voronoi/glue.hpp"

#include <algorithm>
#include <cmath>

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

bool Borders::insert_twin(Index face, Index link, double tolerance) {
  const Link l = links[link];
  if (link == first[face] || l.label == none) return false;
  const Index p = before(face, link), n = after(face, link), other = l.label;
  const Point start = links[link - 1].end;
  const auto near = [&](Point a, Point b) {
    return std::abs(a.x - b.x) <= tolerance && std::abs(a.y - b.y) <= tolerance;
  };
  for (Index i = first[other]; i + 1 < first[other] + count[other]; ++i) {
    if (links[i].label != n || links[i + 1].label != p || !near(links[i].end, l.end) || !near(links[i].end, start))
      continue;
    const Index begin = Index(links.size());
    const std::vector<Link> old(border(other).begin(), border(other).end());
    links.insert(links.end(), old.begin(), old.begin() + (i + 1 - first[other]));
    links.push_back({face, links.back().clearance, links.back().clearance, links.back().end});
    links.insert(links.end(), old.begin() + (i + 1 - first[other]), old.end());
    first[other] = begin;
    ++count[other];
    return true;
  }
  return false;
}

bool Borders::remove_short(Index face, Index link, double tolerance) {
  const Index begin = first[face], end = begin + count[face];
  if (link == begin || link + 1 == end) return false;
  const Point p = links[link - 1].end, q = links[link].end;
  const double climb = std::abs(links[link - 1].clearance - links[link].clearance);
  if (!(std::abs(p.x - q.x) <= tolerance && std::abs(p.y - q.y) <= tolerance && climb <= tolerance)) return false;
  std::vector<Link> kept(links.begin() + begin, links.begin() + link);
  std::vector<Link> rest(links.begin() + link + 1, links.begin() + end);
  if (kept.back().label == rest.front().label) {  // one link again
    rest.front().minimum = std::min(rest.front().minimum, kept.back().minimum);
    kept.pop_back();
  }
  first[face] = Index(links.size());
  count[face] = Index(kept.size() + rest.size());
  links.insert(links.end(), kept.begin(), kept.end());
  links.insert(links.end(), rest.begin(), rest.end());
  return true;
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
