#include "solid/columns.hpp"

#include <algorithm>

namespace krepl::solid {

namespace {
using Meeting = Borders::Meeting;
}

Columns::Columns(const Surface& surface, const Topology& topology, const Borders& borders, std::optional<double> floor,
                 BrepBuilder& builder)
    : surface_(surface), topology_(topology), borders_(borders), floor_height_(floor), builder_(builder) {
  for (const Point3 p : borders.corners()) builder.add_corner(p);
  for (Index h = 0; h < topology.half_edge_count(); ++h)
    if (topology.has(h) && has_wall(h) && !edges_.contains(h)) make(h);
}

bool Columns::has_wall(Index h) const {
  const Meeting meeting = borders_.meeting(h);
  return meeting == Meeting::wall || (meeting == Meeting::outline && floor_height_);
}

int Columns::corner_or_floor(Index corner, Index h) const {
  return corner == Surface::none ? floor_.at(h) : int(corner);
}

/// For each stretch between two corners, the walls that pass through it.
std::vector<std::vector<Columns::Crossing>> Columns::crossings(const Column& column) const {
  std::vector<std::vector<Crossing>> stretches(column.corners.size() - 1);
  const auto place = [&](int corner) {
    return std::size_t(std::find(column.corners.begin(), column.corners.end(), corner) - column.corners.begin());
  };
  for (std::size_t i = 0; i < column.around.size(); ++i) {
    const Index h = column.around[i];
    if (!has_wall(h)) continue;
    const int after = corner_or_floor(borders_.corner(h), h);
    const int before = corner_or_floor(borders_.end_corner(topology_.twin(h)), h);
    const bool rising = borders_.is_upper(h);
    for (std::size_t k = place(rising ? after : before); k < place(rising ? before : after); ++k)
      stretches[k].push_back({i, rising});
  }
  return stretches;
}

/// Whether the solid goes on from one wall counter-clockwise to the other.
bool Columns::encloses(const Column& column, Crossing from, Crossing to) const {
  for (std::size_t i = from.place; i != to.place; i = (i + 1) % column.around.size())
    if (surface_.face_feature(topology_.face(column.around[i])) == Surface::none) return false;
  return true;
}

void Columns::make(Index h) {
  Column column;
  Index g = h;
  do column.around.push_back(g);
  while ((g = topology_.twin(topology_.previous(g))) != h);
  for (const Index c : borders_.column(h)) column.corners.push_back(int(c));
  const auto outline = [&](Index a) { return borders_.meeting(a) == Meeting::outline; };
  if (floor_height_ && std::any_of(column.around.begin(), column.around.end(), outline)) {
    Point3 p = builder_.corner(column.corners.back());
    p.z = *floor_height_;
    column.corners.push_back(builder_.add_corner(p));
    for (const Index a : column.around) floor_[a] = column.corners.back();
  }
  for (const Index a : column.around)
    if (has_wall(a)) edges_[a];
  const auto stretches = crossings(column);
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const int low = column.corners[k + 1], high = column.corners[k];
    const auto new_edge = [&] {
      return builder_.add_edge(line_between(builder_.corner(low), builder_.corner(high)), low, high);
    };
    const auto& walls = stretches[k];
    std::vector<int> edge(walls.size(), -1);
    for (std::size_t i = 0; i < walls.size(); ++i) {
      const std::size_t following = (i + 1) % walls.size();
      if (!walls[i].rising || walls[following].rising || !encloses(column, walls[i], walls[following])) continue;
      edge[i] = edge[following] = new_edge();
    }
    for (std::size_t i = 0; i < walls.size(); ++i) {
      if (edge[i] < 0) edge[i] = new_edge();
      edges_[column.around[walls[i].place]].push_back(edge[i]);
    }
  }
}

}  // namespace krepl::solid
