#include "incremental/parts.hpp"

#include <algorithm>

#include "model/terrain_window.hpp"

namespace krepl::incremental {

using FeatureKind = Terrain::FeatureKind;

namespace {

EdgePart edge_part(Index a, Index b, Vector at, Vector end) {
  EdgePart e{};
  e.a = a, e.b = b, e.at = at, e.end = end;
  e.length = length(end - at);
  e.direction = (1 / e.length) * (end - at);
  e.part = none;
  const Real flat = std::sqrt(e.direction.x * e.direction.x + e.direction.y * e.direction.y);
  if (at.x == end.x && at.y == end.y) return e;
  e.aside = {e.direction.y / flat, -e.direction.x / flat, 0};
  e.up = cross(e.aside, e.direction);
  return e;
}

TrianglePart triangle_part(const TerrainWindow& window, const TerrainWindow::Face& face) {
  TrianglePart t{};
  t.vertical = face.vertical;
  t.part = none;
  for (std::size_t k = 0; k < 3; ++k) {
    t.vertex[k] = face.vertex[k];
    t.edge[k] = face.edge[k];
    t.corner[k] = Vector(window.vertices()[face.vertex[k]].at);
    t.box.add(t.corner[k]);
  }
  const Vector n = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
  t.turn = n.z;
  t.normal = unit(n.z < 0 ? -n : n);
  if (t.vertical) t.normal = unit({t.normal.x, t.normal.y, 0});
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector p = t.corner[k], d = unit(t.corner[(k + 1) % 3] - p), w = t.corner[(k + 2) % 3] - p;
    t.inward[k] = unit(w - dot(w, d) * d);
    t.along[k] = t.corner[(k + 1) % 3] - p;
    t.per_square[k] = 1 / dot(t.along[k], t.along[k]);
    const Real flat = t.along[k].x * t.along[k].x + t.along[k].y * t.along[k].y;
    t.per_flat_square[k] = flat > 0 ? 1 / flat : 0;
  }
  return t;
}

}  // namespace

Parts::Parts(const Terrain& terrain, double radius) : radius_(radius), scale_(std::max(radius, terrain.extent())) {
  TerrainWindow window;
  const double margin = terrain.extent();
  window.fill(terrain, {terrain.lowest().x - margin, terrain.lowest().y - margin},
              {terrain.highest().x + margin, terrain.highest().y + margin});
  const auto add = [&](FeatureKind kind, Index feature, Index item, std::initializer_list<Vector> corners) {
    Part p{kind, feature, item, {}, {}, below_everything, below_everything};
    p.low = -p.low;
    for (const Vector c : corners) {
      p.box.add(c);
      p.low = std::min(p.low, c.z), p.high = std::max(p.high, c.z);
    }
    p.box = p.box.grown(radius_);
    p.high += radius_;
    parts_.push_back(std::move(p));
    return Index(parts_.size() - 1);
  };
  for (const auto& face : window.faces()) {
    TrianglePart t = triangle_part(window, face);
    const auto item = Index(triangles_.size());
    if (!t.vertical) t.part = add(FeatureKind::face, face.feature, item, {t.corner[0], t.corner[1], t.corner[2]});
    triangles_.push_back(t);
    if (t.part != none) parts_[t.part].triangles = {item};
  }
  for (const auto& edge : window.edges()) {
    EdgePart e = edge_part(edge.a, edge.b, Vector(window.vertices()[edge.a].at), Vector(window.vertices()[edge.b].at));
    if (e.at.x != e.end.x || e.at.y != e.end.y)
      e.part = add(FeatureKind::edge, edge.feature, Index(edges_.size()), {e.at, e.end});
    edges_.push_back(e);
  }
  for (const auto& vertex : window.vertices()) {
    const Vector at(vertex.at);
    vertices_.push_back({at, add(FeatureKind::vertex, vertex.feature, Index(vertices_.size()), {at})});
  }
  for (Index t = 0; t < triangles_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (const Index e = edges_[triangles_[t].edge[k]].part; e != none) parts_[e].triangles.push_back(t);
      parts_[vertices_[triangles_[t].vertex[k]].part].triangles.push_back(t);
    }
  }
}

bool Parts::continue_smoothly(Index first, Index second) const {
  std::size_t common = 0;
  const std::vector<Index> a = corners(first), b = corners(second);
  for (const Index v : a) common += std::find(b.begin(), b.end(), v) != b.end();
  const bool face = parts_[first].kind == FeatureKind::face || parts_[second].kind == FeatureKind::face;
  return common >= (face ? std::min({a.size(), b.size(), std::size_t(2)}) : 1) || are_in_one_line(first, second);
}

Real Parts::height(Index part, Vector place) const {
  const Part& p = parts_[part];
  if (!p.box.contains(place)) return below_everything;
  if (p.kind == FeatureKind::vertex) {
    const Vector at = vertices_[p.item].at;
    const Real x = place.x - at.x, y = place.y - at.y, under = radius_ * radius_ - (x * x + y * y);
    return under > 0 ? at.z + std::sqrt(under) : below_everything;
  }
  if (p.kind == FeatureKind::edge) {
    const EdgePart& e = edges_[p.item];
    const Real beside = (place.x - e.at.x) * e.aside.x + (place.y - e.at.y) * e.aside.y;
    const Real under = radius_ * radius_ - beside * beside;
    if (!(under > 0)) return below_everything;
    // The ball's centre is at + s direction + beside aside + sqrt(under) up, straight over the place.
    const Real rise = std::sqrt(under), flat = e.up.z;
    const Real along = ((place.x - e.at.x) * -e.aside.y + (place.y - e.at.y) * e.aside.x);
    const Real s = (along + rise * e.direction.z) / flat;
    if (s < 0 || s > e.length) return below_everything;
    return e.at.z + s * e.direction.z + rise * e.up.z;
  }
  const TrianglePart& t = triangles_[p.item];
  const Vector base = t.corner[0] + radius_ * t.normal;
  const Real x = place.x - base.x, y = place.y - base.y;
  const Vector c{place.x, place.y, base.z - (t.normal.x * x + t.normal.y * y) / t.normal.z};
  for (std::size_t k = 0; k < 3; ++k) {
    if (dot(c - t.corner[k], t.inward[k]) < 0) return below_everything;
  }
  return c.z;
}

Vector Parts::contact(Index part, Vector c) const {
  const Part& p = parts_[part];
  if (p.kind == FeatureKind::vertex) return vertices_[p.item].at;
  if (p.kind == FeatureKind::edge) {
    const EdgePart& e = edges_[p.item];
    return e.at + dot(c - e.at, e.direction) * e.direction;
  }
  const TrianglePart& t = triangles_[p.item];
  return c - dot(c - t.corner[0], t.normal) * t.normal;
}

bool Parts::are_in_one_line(Index first, Index second) const {
  constexpr Real parallel = 1e-12L;
  if (parts_[first].kind != FeatureKind::edge || parts_[second].kind != FeatureKind::edge) return false;
  const EdgePart &e = edge_of(first), &f = edge_of(second);
  const Vector between = f.at - e.at;
  return length(cross(e.direction, f.direction)) <= parallel && length(cross(between, e.direction)) <= parallel * length(between);
}

std::vector<Index> Parts::corners(Index part) const {
  const Part& p = parts_[part];
  if (p.kind == FeatureKind::vertex) return {p.item};
  if (p.kind == FeatureKind::edge) return {edges_[p.item].a, edges_[p.item].b};
  const auto& v = triangles_[p.item].vertex;
  return {v.begin(), v.end()};
}

Real Parts::prism_distance(Index triangle, Vector c) const {
  const TrianglePart& t = triangles_[triangle];
  const Real above = dot(c - t.corner[0], t.normal);
  bool over = true, inside = !t.vertical;
  for (std::size_t k = 0; k < 3 && over; ++k) over = dot(c - t.corner[k], t.inward[k]) >= 0;
  if (over && above >= 0) return above;
  Real square = over ? above * above : std::numeric_limits<Real>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector d = t.along[k], w = c - t.corner[k];
    const Real s = std::clamp(dot(w, d) * t.per_square[k], Real(0), Real(1));
    const Vector off = w - s * d;
    square = std::min(square, dot(off, off));
    if (t.per_flat_square[k] == 0) continue;
    // The wall below the edge, where its nearest point in the plane is not above the edge.
    const Real share = std::clamp((w.x * d.x + w.y * d.y) * t.per_flat_square[k], Real(0), Real(1));
    const Real x = w.x - share * d.x, y = w.y - share * d.y;
    if (w.z <= share * d.z) square = std::min(square, x * x + y * y);
    inside = inside && (d.x * w.y - d.y * w.x) * t.turn >= 0;
  }
  return inside && above <= 0 ? 0 : std::sqrt(square);
}

}  // namespace krepl::incremental
