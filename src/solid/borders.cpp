#include "solid/borders.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solid/patch.hpp"

namespace krepl::solid {

using Index = Borders::Index;

Borders::Borders(const Surface& surface, const Topology& topology, double tolerance)
    : surface_(&surface), topology_(&topology) {
  find_meetings(tolerance);
  find_corners(tolerance);
}

void Borders::find_meetings(double tolerance) {
  const std::size_t count = topology_->half_edge_count();
  meeting_.assign(count, std::uint8_t(Meeting::shared));
  upper_.assign(count, false);
  for (Index h = 0; h < count; ++h) {
    if (!topology_->has(h)) continue;
    const Index t = topology_->twin(h);
    const Index own = surface_->face_feature(topology_->face(h)), other = surface_->face_feature(topology_->face(t));
    if (other == none) {
      meeting_[h] = meeting_[t] = std::uint8_t(Meeting::outline);
      upper_[h] = own != none;
      continue;
    }
    const auto is_rim = [&](Index g) { return surface_->edge(g / 2).kind == Surface::EdgeKind::rim; };
    if (t < h || own == none || (!is_rim(h) && !is_rim(t))) continue;
    // Which is higher is told by heights, for the two may be left of faces that are gone.
    double gap = 0, apart = 0;
    for (const Point3 p : surface_->curve(h / 2, 9)) {
      const Point3 own_point{p.x, p.y, height_over(*surface_, own, p)},
          other_point{p.x, p.y, height_over(*surface_, other, p)};
      gap += own_point.z - other_point.z;
      apart = std::max(apart, std::fabs(own_point.z - other_point.z));
    }
    if (apart <= tolerance) continue;
    meeting_[h] = meeting_[t] = std::uint8_t(Meeting::wall);
    upper_[h] = gap > 0;
    upper_[t] = !(gap > 0);
  }
}

/// The half-edges that start where h does, counter-clockwise.
std::vector<Index> Borders::around(Index h) const {
  std::vector<Index> result;
  Index g = h;
  do result.push_back(g);
  while ((g = topology_->twin(topology_->previous(g))) != h);
  return result;
}

void Borders::find_corners(double tolerance) {
  const std::size_t count = topology_->half_edge_count();
  corner_.assign(count, none);
  place_.reserve(surface_->subdivision().vertex_count);
  std::vector<bool> seen(count);
  for (Index h = 0; h < count; ++h) {
    if (!topology_->has(h) || seen[h]) continue;
    const std::vector<Index> all = around(h);
    for (const Index g : all) seen[g] = true;
    find_column(all, tolerance);
  }
}

/// Height of a corner's group of half-edges: that of the first edge that starts there and is no wall's, else of the
/// patch.
double Borders::height(const std::vector<Index>& around, const std::vector<std::size_t>& group,
                       std::size_t wanted) const {
  const Point3 p = surface_->vertex(topology_->origin(around[0]));
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Index h = around[i];
    if (group[i] != wanted || meeting(h) != Meeting::shared || surface_->edge(h / 2).kind == Surface::EdgeKind::rim)
      continue;
    const std::vector<Point3> curve = surface_->curve(h / 2, 3);
    return h % 2 == 0 ? curve.front().z : curve.back().z;
  }
  return height_over(*surface_, surface_->face_feature(topology_->face(around[wanted])), p);
}

void Borders::find_column(const std::vector<Index>& around, double tolerance) {
  // Sector i lies counter-clockwise of half-edge i; the next half-edge parts it from the next sector.
  const std::size_t count = around.size();
  std::vector<std::size_t> group(count);
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto join = [&](std::size_t a, std::size_t b) {
    const std::size_t low = std::min(group[a], group[b]), high = std::max(group[a], group[b]);
    for (std::size_t& g : group) g = g == high ? low : g;
  };
  for (std::size_t i = 0; i < count; ++i)
    if (meeting(around[i]) == Meeting::shared) join(i, (i + count - 1) % count);

  struct Level {
    std::size_t group;
    double height;
  };
  std::vector<Level> levels;
  for (std::size_t i = 0; i < count; ++i)
    if (group[i] == i && surface_->face_feature(topology_->face(around[i])) != none)
      levels.push_back({i, height(around, group, i)});
  std::sort(levels.begin(), levels.end(),
            [](Level a, Level b) { return a.height != b.height ? a.height > b.height : a.group < b.group; });
  Point3 p = surface_->vertex(topology_->origin(around[0]));
  double before = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (i == 0 || before - levels[i].height > tolerance) {
      if (i > 0) p.z = std::min(p.z, levels[i].height);  // the highest has the height of the surface's vertex
      place_.push_back(p);
      before = levels[i].height;
    }
    for (std::size_t k = 0; k < count; ++k)
      if (group[k] == levels[i].group) corner_[around[k]] = Index(place_.size() - 1);
  }
}

std::vector<Index> Borders::column(Index h) const {
  std::vector<Index> corners;
  for (const Index g : around(h))
    if (corner_[g] != none) corners.push_back(corner_[g]);
  std::sort(corners.begin(), corners.end());  // numbered from the highest on
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

}  // namespace krepl::solid
