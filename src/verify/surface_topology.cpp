// Checks of the index arrays alone.
#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "verify/surface_checks.hpp"

namespace krepl::verify {

namespace {

using Index = SurfaceCase::Index;
using Curve = SubdivisionFile::Curve;
using EdgeKind = SubdivisionFile::EdgeKind;

bool in_range(const SubdivisionFile& file, Rules& rules) {
  const auto below = [](Index i, const auto& list) { return i < list.size(); };
  const auto below_or_none = [](Index i, const auto& list) { return i == SurfaceCase::none || i < list.size(); };
  for (std::size_t h = 0; h < file.half_edges.size(); ++h) {
    const auto& half = file.half_edges[h];
    rules.require(below(half.origin, file.vertices) && below(half.twin, file.half_edges) &&
                      below(half.next, file.half_edges) && below(half.face, file.faces) && below(half.edge, file.edges),
                  "an index out of range in half-edge", h);
  }
  for (std::size_t e = 0; e < file.edges.size(); ++e)
    rules.require(below_or_none(file.edges[e].feature[0], file.features) &&
                      below_or_none(file.edges[e].feature[1], file.features),
                  "a feature out of range in edge", e);
  for (std::size_t f = 0; f < file.faces.size(); ++f)
    rules.require(
        below_or_none(file.faces[f].feature, file.features) && below_or_none(file.faces[f].outer, file.half_edges),
        "an index out of range in face", f);
  for (const Index h : file.inner) rules.require(below(h, file.half_edges), "an inner loop out of range", h);
  rules.require(!file.faces.empty(), "no face", 0);
  rules.require(file.half_edges.size() == 2 * file.edges.size(), "not two half-edges for each of the edges",
                file.edges.size());
  return rules.ok();
}

bool twins_and_next(const SubdivisionFile& file, Rules& rules) {
  std::vector<std::uint8_t> halves(file.edges.size(), 0), before(file.half_edges.size(), 0);
  for (std::size_t h = 0; h < file.half_edges.size(); ++h) {
    const auto& half = file.half_edges[h];
    const auto& twin = file.half_edges[half.twin];
    rules.require(half.twin != h && twin.twin == h, "twins are not mutual at half-edge", h);
    rules.require(twin.edge == half.edge, "twins of different edges at half-edge", h);
    rules.require(++halves[half.edge] <= 2, "more than two half-edges of edge", half.edge);
    rules.require(++before[half.next] == 1, "two predecessors of half-edge", half.next);
    const auto& next = file.half_edges[half.next];
    rules.require(next.origin == twin.origin, "the next half-edge starts elsewhere after half-edge", h);
    rules.require(next.face == half.face, "the face changes along the loop after half-edge", h);
  }
  return rules.ok();
}

/// Seen from above: on a rim a vertex has the height of the upper side, far from the end of an edge that meets the wall below.
void choose_forward(SurfaceCase& surface) {
  const SubdivisionFile& file = surface.file;
  surface.forward.assign(file.edges.size(), SurfaceCase::none);
  for (std::size_t h = file.half_edges.size(); h-- > 0;) {
    const Index e = file.half_edges[h].edge;
    Index& forward = surface.forward[e];
    if (forward == SurfaceCase::none) forward = Index(h);  // the second one, unless the first fits no worse
    const Space<double> start = surface.point(file.edges[e].first);
    const auto off = [&](Index i) {
      const Space<double> d = Space<double>(file.vertices[file.half_edges[i].origin]) - start;
      return d.x * d.x + d.y * d.y;
    };
    if (off(Index(h)) <= off(forward)) forward = Index(h);
  }
}

bool loops(SurfaceCase& surface, Rules& rules) {
  const SubdivisionFile& file = surface.file;
  surface.loop.assign(file.half_edges.size(), SurfaceCase::none);
  for (std::size_t h = 0; h < file.half_edges.size(); ++h) {
    if (surface.loop[h] != SurfaceCase::none) continue;
    const auto number = Index(surface.loop_start.size());
    surface.loop_start.push_back(Index(h));
    for (Index i = Index(h); surface.loop[i] == SurfaceCase::none; i = file.half_edges[i].next)
      surface.loop[i] = number;
  }
  std::vector<std::uint8_t> listed(surface.loop_start.size(), 0);
  surface.loop_outer.assign(surface.loop_start.size(), false);
  const auto list = [&](Index h, std::size_t face, bool outer) {
    rules.require(file.half_edges[h].face == face, "a loop of another face is listed by face", face);
    rules.require(++listed[surface.loop[h]] == 1, "listed twice: the loop of half-edge", h);
    surface.loop_outer[surface.loop[h]] = outer;
  };
  for (std::size_t f = 0; f < file.faces.size(); ++f) {
    rules.require((file.faces[f].outer == SurfaceCase::none) == (f == 0), "face 0 alone has no outer loop: face", f);
    if (file.faces[f].outer != SurfaceCase::none) list(file.faces[f].outer, f, true);
    for (std::uint64_t i = file.faces[f].first_inner; i < file.inner_end(f); ++i) list(file.inner[i], f, false);
  }
  for (std::size_t l = 0; l < listed.size(); ++l)
    rules.require(listed[l] == 1, "not listed by its face: the loop of half-edge", surface.loop_start[l]);
  rules.require(surface.label(0) == SurfaceCase::none, "a feature owns face", 0);
  return rules.ok();
}

/// Euler's formula for each component, and that one of its loops is an inner one: the hole it makes in the face around
/// it.
bool components(SurfaceCase& surface, Rules& rules) {
  const SubdivisionFile& file = surface.file;
  std::vector<Index> parent(file.vertices.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root_of = [&](Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& half : file.half_edges) {
    const Index a = root_of(half.origin), b = root_of(file.half_edges[half.twin].origin);
    parent[std::max(a, b)] = std::min(a, b);
  }
  surface.component.assign(file.vertices.size(), SurfaceCase::none);
  for (Index v = 0; v < file.vertices.size(); ++v) {
    const Index r = root_of(v);
    surface.component[v] = r == v ? Index(surface.components++) : surface.component[r];
  }
  std::vector<std::int64_t> euler(surface.components, 0), inner(surface.components, 0);
  for (const Index c : surface.component) ++euler[c];
  for (const auto& half : file.half_edges)
    if (surface.forward[half.edge] == half.twin) --euler[surface.component[half.origin]];
  for (std::size_t l = 0; l < surface.loop_start.size(); ++l) {
    const Index c = surface.component[file.half_edges[surface.loop_start[l]].origin];
    ++euler[c];
    if (!surface.loop_outer[l]) ++inner[c];
  }
  for (std::size_t c = 0; c < surface.components; ++c) {
    rules.require(euler[c] == 2, "Euler's formula does not hold for component", c);
    rules.require(inner[c] == 1, "not one inner loop of component", c);
  }
  return rules.ok();
}

/// The kinds of curves that two features can make.
bool curve_fits(const SubdivisionFile::Edge& edge, int low, int high) {
  if (edge.curve == Curve::line) return low >= 2;
  if (edge.kind == EdgeKind::rim) return high == 1 && edge.curve == Curve::circle;
  if (edge.kind == EdgeKind::seam) return high == 2 && edge.curve == Curve::circle;
  if (low == 1 && high != 2) return edge.curve == Curve::circle;
  if (low == 1) return edge.curve == Curve::circle || edge.curve == Curve::quartic;
  if (low == 3) return false;
  return edge.curve == Curve::ellipse || edge.curve == Curve::circle || (high == 2 && edge.curve == Curve::quartic);
}

struct KeyHash {
  std::size_t operator()(const FeatureKey& k) const {
    std::uint64_t h = 0;
    for (const std::uint32_t v : k) h = (h ^ v) * 0x9E3779B97F4A7C15u, h ^= h >> 29;
    return h;
  }
};

void features_exist(const SurfaceCase& surface, Rules& rules) {
  std::unordered_map<FeatureKey, bool, KeyHash> found;
  found.reserve(surface.key.size());
  for (std::size_t i = 0; i < surface.key.size(); ++i)
    rules.require(found.emplace(surface.key[i], false).second, "twice in the list: feature", i);
  for (std::size_t t = 0; t < surface.solid.triangle_count(); ++t) {
    const auto& v = surface.solid.triangle(t);
    constexpr std::uint32_t no = Solid::none;
    for (const FeatureKey& key :
         {FeatureKey{v[0], v[1], v[2]}, FeatureKey{v[0], v[1], no}, FeatureKey{v[0], v[2], no},
          FeatureKey{v[1], v[2], no}, FeatureKey{v[0], no, no}, FeatureKey{v[1], no, no}, FeatureKey{v[2], no, no}})
      if (const auto at = found.find(key); at != found.end()) at->second = true;
  }
  for (std::size_t i = 0; i < surface.key.size(); ++i)
    rules.require(found[surface.key[i]], "not a feature of the input: feature", i);
}

}  // namespace

Check check_topology(SurfaceCase& surface) {
  Rules rules("topology");
  if (!in_range(surface.file, rules) || !twins_and_next(surface.file, rules)) return rules.check();
  choose_forward(surface);
  if (loops(surface, rules)) components(surface, rules);
  return rules.check();
}

Check check_labels(const SurfaceCase& surface) {
  Rules rules("features and labels");
  features_exist(surface, rules);
  const SubdivisionFile& file = surface.file;
  for (Index e = 0; e < file.edges.size(); ++e) {
    const auto& edge = file.edges[e];
    const bool rim = edge.kind == EdgeKind::rim;
    std::array<Index, 2> sides{surface.left_label(e), surface.right_label(e)};
    bool agree = true, upper = false;
    for (std::size_t k = 0; k < 2; ++k) {
      if (rim && edge.feature[k] == SurfaceCase::none) continue;
      agree = agree && edge.feature[k] == sides[k] && sides[k] != SurfaceCase::none;
      upper = true;
    }
    rules.require(agree && upper, "its features are not those of the faces beside: edge", e);
    rules.require(rim == (edge.feature[0] == SurfaceCase::none || edge.feature[1] == SurfaceCase::none),
                  "a rim has one feature, others two: edge", e);
    int low = 3, high = 1;
    for (const Index f : edge.feature)
      if (f != SurfaceCase::none)
        low = std::min(low, surface.shape[f].count), high = std::max(high, surface.shape[f].count);
    if (edge.feature[0] != SurfaceCase::none || edge.feature[1] != SurfaceCase::none)
      rules.require(curve_fits(edge, low, high), "features that cannot make such a curve: edge", e);
  }
  for (std::size_t f = 1; f < file.faces.size(); ++f)
    if (file.faces[f].feature == SurfaceCase::none) {
      // A hole is bounded by rims only, and so is the outside.
      Index h = file.faces[f].outer;
      do {
        rules.require(file.edges[file.half_edges[h].edge].kind == EdgeKind::rim, "not a rim around a hole: half-edge",
                      h);
        h = file.half_edges[h].next;
      } while (h != file.faces[f].outer);
    }
  return rules.check();
}

}  // namespace krepl::verify
