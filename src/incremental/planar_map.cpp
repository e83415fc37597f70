#include "incremental/planar_map.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace krepl::incremental {

Index PlanarMap::vertex_at(Vector place) {
  Index nearest = none;
  Real least = tolerance_.weld;
  for (Index v = 0; v < vertices_.size(); ++v) {
    if (std::fabs(vertices_[v].x - place.x) > least) continue;
    const Real d = flat_distance(vertices_[v], place);
    if (d <= least) least = d, nearest = v;
  }
  if (nearest == none) {
    vertices_.push_back(place);
    around_.emplace_back();
    return Index(vertices_.size() - 1);
  }
  return nearest;
}

void PlanarMap::measure(Arc& arc) {
  constexpr int pieces = 16;
  arc.box = {};
  arc.reach = 0;
  const Vector first = arc.point(arc.begin);
  Vector last = first;
  Real longest = 0;
  for (int i = 0; i <= pieces; ++i) {
    const Vector p = arc.point(arc.begin + (arc.end - arc.begin) * Real(i) / pieces);
    arc.box.add(p);
    arc.reach = std::max(arc.reach, flat_distance(first, p));
    longest = std::max(longest, flat_distance(last, p));
    last = p;
  }
  arc.box = arc.box.grown(longest / 2);
}

namespace {

std::optional<Real> passes_between(const Arc& arc, Vector point, Real distance, Real begin, Vector a, Real end,
                                   Vector b) {
  const Real t = (begin + end) / 2;
  const Vector m = arc.point(t);
  const Real size = flat_distance(a, b), bend = 2 * flat_distance(m, Real(0.5) * (a + b));
  if (flat_distance(m, point) > size / 2 + bend + distance) return std::nullopt;
  if (size + bend < distance / 4 || t == begin || t == end) {
    if (flat_distance(m, point) <= distance) return t;
    return std::nullopt;
  }
  if (const auto found = passes_between(arc, point, distance, begin, a, t, m)) return found;
  return passes_between(arc, point, distance, t, m, end, b);
}

}  // namespace

std::optional<Real> PlanarMap::passes(const Arc& arc, Vector point, Real distance) {
  if (!arc.box.grown(distance).contains(point)) return std::nullopt;
  constexpr int pieces = 8;
  for (int i = 0; i < pieces; ++i) {
    const Real a = arc.begin + (arc.end - arc.begin) * Real(i) / pieces;
    const Real b = i + 1 == pieces ? arc.end : arc.begin + (arc.end - arc.begin) * Real(i + 1) / pieces;
    if (const auto t = passes_between(arc, point, distance, a, arc.point(a), b, arc.point(b))) return t;
  }
  return std::nullopt;
}

std::vector<Arc> PlanarMap::take(const Box& box) {
  std::vector<Arc> taken, left;
  for (Arc& arc : arcs_) (arc.box.meets(box) ? taken : left).push_back(std::move(arc));
  arcs_ = std::move(left);
  return taken;
}

namespace {

/// Where an arc, followed from one end, is first so far from a vertex. None if it never is.
std::optional<Vector> leaves_circle(const Arc& arc, bool from_end, Vector center, Real radius) {
  constexpr int pieces = 64;
  const auto at = [&](Real share) {
    return arc.point(from_end ? arc.end - share * (arc.end - arc.begin) : arc.begin + share * (arc.end - arc.begin));
  };
  Real inside = 0;
  for (int i = 1; i <= pieces; ++i) {
    Real outside = Real(i) / pieces;
    if (flat_distance(at(outside), center) < radius) {
      inside = outside;
      continue;
    }
    for (int k = 0; k < 70; ++k) {
      const Real middle = (inside + outside) / 2;
      (flat_distance(at(middle), center) < radius ? inside : outside) = middle;
    }
    return at(outside);
  }
  return std::nullopt;
}

}  // namespace

/// Sorts the half-edges around a vertex by where their arcs leave a circle. False if their labels do not fit then.
bool PlanarMap::turn_order(Index v, Real radius) {
  struct Exit {
    Real angle;
    Index half_edge;
  };
  std::vector<Exit> exits;
  const Vector center = vertices_[v];
  for (const Index h : around_[v]) {
    const Arc& arc = arcs_[h / 2];
    const auto p = leaves_circle(arc, h % 2 == 1, center, std::min(radius, 0.9L * arc.reach));
    if (!p) return false;
    exits.push_back({std::atan2(p->y - center.y, p->x - center.x), h});
  }
  std::sort(exits.begin(), exits.end(), [](const Exit& a, const Exit& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.half_edge < b.half_edge;
  });
  bool fits = true;
  for (std::size_t i = 0; i < exits.size(); ++i) {
    around_[v][i] = exits[i].half_edge;
    const Index after = exits[(i + 1) % exits.size()].half_edge;
    fits = fits && label(exits[i].half_edge) == label(after ^ 1u);
  }
  return fits;
}

std::optional<Fault> PlanarMap::order_around(Index v) {
  std::vector<Real> reach;
  for (const Index h : around_[v]) reach.push_back(arcs_[h / 2].reach);
  std::sort(reach.begin(), reach.end());
  reach.erase(std::unique(reach.begin(), reach.end()), reach.end());
  // Curves that are tangent part with the square of the distance, so the circle is as large as it can be: as the
  // shortest arc, then, if others are tangent that close, as longer ones, where shorter arcs count as they point.
  for (const Real most : reach) {
    for (const Real share : {0.3L, 0.03L, 0.003L, 0.0003L, 0.9L}) {
      if (turn_order(v, share * most)) return std::nullopt;
    }
  }
  return Fault{"labels around a vertex do not agree", vertices_[v]};
}

std::optional<Fault> PlanarMap::put(std::vector<Arc> arcs) {
  for (Arc& arc : arcs) arcs_.push_back(std::move(arc));
  for (auto& around : around_) around.clear();
  for (Index a = 0; a < arcs_.size(); ++a) {
    for (const Index side : {0u, 1u}) around_[arcs_[a].vertex[side]].push_back(2 * a + side);
  }
  next_.assign(2 * arcs_.size(), none);
  for (Index v = 0; v < vertices_.size(); ++v) {
    if (around_[v].empty()) continue;
    Real height = below_everything;  // of the uppermost arc: others may end in the wall below
    for (const Index h : around_[v])
      height = std::max(height, arcs_[h / 2].point(h % 2 == 0 ? arcs_[h / 2].begin : arcs_[h / 2].end).z);
    vertices_[v].z = height;
    if (auto fault = order_around(v)) return fault;
    const auto& around = around_[v];
    for (std::size_t i = 0; i < around.size(); ++i) next_[around[i] ^ 1u] = around[i > 0 ? i - 1 : around.size() - 1];
  }
  return check_loops();
}

std::optional<Fault> PlanarMap::check_loops() {
  std::vector<bool> seen(next_.size(), false);
  std::vector<Index> root(vertices_.size());
  std::iota(root.begin(), root.end(), Index{0});
  const std::function<Index(Index)> find = [&](Index v) { return root[v] == v ? v : root[v] = find(root[v]); };
  std::size_t loops = 0, vertices = 0, components = 0;
  for (Index h = 0; h < next_.size(); ++h) {
    root[find(origin(h))] = find(origin(h ^ 1u));
    if (seen[h]) continue;
    ++loops;
    for (Index g = h; !seen[g]; g = next_[g]) {
      seen[g] = true;
      if (label(g) != label(h)) return Fault{"labels along a loop do not agree", vertices_[origin(g)]};
    }
  }
  for (Index v = 0; v < vertices_.size(); ++v) {
    if (around_[v].empty()) continue;
    ++vertices;
    components += find(v) == v;
  }
  if (vertices + loops != arcs_.size() + 2 * components) {
    return Fault{"Euler's formula does not hold", arcs_.empty() ? Vector{} : vertices_[arcs_.back().vertex[0]]};
  }
  return std::nullopt;
}

}  // namespace krepl::incremental
