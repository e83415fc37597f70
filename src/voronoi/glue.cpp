#include "voronoi/glue.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/pages.hpp"

namespace krepl::voronoi {

Index Borders::before(Index face, Index link) const {
  if (link == first[face]) {
    if (!is_closed(face) || count[face] == 1) return site_itself;
    return neighbour(links[link].label, links[first[face] + count[face] - 1].label);
  }
  return neighbour(links[link].label, links[link - 1].label);
}

Index Borders::after(Index face, Index link) const {
  if (link + 1 == first[face] + count[face]) {
    if (!is_closed(face) || count[face] == 1) return site_itself;
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

Borders::Spot Borders::start(Index face, Index link) const {
  if (link != first[face]) return end(link - 1);
  if (is_closed(face)) return end(first[face] + count[face] - 1);
  return {in_.vertices()[in_.is_side(face) ? in_.ends(face).from : in_.vertex_of(face)], 0};
}

bool Borders::coincide(Spot a, Spot b) const {
  const double least = sites_.coincidence(std::max(a.clearance, b.clearance)), most = 4 * least;
  // Beside a site all is near, and nothing told by that.
  return std::min(a.clearance, b.clearance) > 64 * least && std::abs(a.place.x - b.place.x) <= most && std::abs(a.place.y - b.place.y) <= most &&
         std::abs(a.clearance - b.clearance) <= most;
}

Index Borders::twin(Index face, Index link) const {
  const Index other = links[link].label;
  if (other == none) return none;
  if (link >= twins_.size()) return find_twin(face, link);
  Index& known = twins_[link];
  if (known == none || known - first[other] >= count[other]) known = find_twin(face, link);  // the other moved
  return known;
}

void Borders::remember_twins() {
  constexpr Index many = 64;
  if (twins_.empty()) kernel::reserve_large(twins_, links.capacity());
  twins_.resize(links.size(), none);
  for (Index face = 0; face < count.size(); ++face) {
    if (count[face] <= many) continue;
    ByLabel& sorted = by_label_[face];
    if (sorted.first == first[face] && sorted.links.size() == count[face]) continue;
    sorted.first = first[face];
    sorted.links.resize(count[face]);
    std::iota(sorted.links.begin(), sorted.links.end(), first[face]);
    std::stable_sort(sorted.links.begin(), sorted.links.end(), [&](Index a, Index b) { return links[a].label < links[b].label; });
  }
}

/// Calls visit(link) for the links of a face with a label, in their order.
template <class Visit>
void Borders::each_labelled(Index face, Index label, Visit&& visit) const {
  if (const auto known = by_label_.find(face); known != by_label_.end() && known->second.first == first[face]) {
    const std::vector<Index>& sorted = known->second.links;
    auto i = std::partition_point(sorted.begin(), sorted.end(), [&](Index l) { return links[l].label < label; });
    for (; i != sorted.end() && links[*i].label == label; ++i) visit(*i);
    return;
  }
  for (Index i = first[face]; i < first[face] + count[face]; ++i) {
    if (links[i].label == label) visit(i);
  }
}

Index Borders::find_twin(Index face, Index link) const {
  const Index other = links[link].label;
  const Index p = before(face, link), n = after(face, link);
  Index exact = none, near = none;
  bool several = false, several_exact = false;
  each_labelled(other, face, [&](Index i) {
    const bool starts = before(other, i) == n, stops = after(other, i) == p;
    if (starts && stops) {
      several_exact = exact != none;
      exact = i;
    } else if ((starts || coincide(start(other, i), end(link))) && (stops || coincide(end(i), start(face, link)))) {
      several = near != none;
      near = i;
    }
  });
  if (exact != none) return several_exact ? none : exact;
  return several ? none : near;
}

}  // namespace krepl::voronoi
