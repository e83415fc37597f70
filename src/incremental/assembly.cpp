#include "incremental/assembly.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace krepl {

using incremental::Arc;
using incremental::Real;
using incremental::Vector;
using FeatureKind = Terrain::FeatureKind;

namespace {

/// The side of a face that lies in another one's plane turns at a corner.
bool turns(const Arc& a, const Arc& b) {
  using Shape = incremental::Curve::Shape;
  if (a.curve->shape != Shape::line || b.curve->shape != Shape::line) return false;
  constexpr Real straight = 1e-9L;
  const Vector d = a.point(a.end) - a.point(a.begin), e = b.point(b.end) - b.point(b.begin);
  return std::fabs(d.x * e.y - d.y * e.x) > straight * flat_distance({}, d) * flat_distance({}, e);
}

}  // namespace

/// The half-edge continues beyond its end as the same edge.
bool IncrementalAssembly::goes_on(Index h) const {
  const auto& around = map_.around(map_.origin(h ^ 1u));
  if (around.size() != 2) return false;
  const Index after = map_.next(h);
  const Arc &a = map_.arcs()[h / 2], &b = map_.arcs()[after / 2];
  return map_.label(h) == map_.label(after) && map_.label(h ^ 1u) == map_.label(after ^ 1u) && a.kind == b.kind &&
         !turns(a, b);
}

/// All of the edge that the half-edge is part of, in its direction.
IncrementalAssembly::Chain IncrementalAssembly::chain_from(Index h) const {
  Index first = h;
  while (goes_on(first ^ 1u)) {
    first = map_.next(first ^ 1u) ^ 1u;
    if (first == h) break;
  }
  Chain chain{first};
  while (goes_on(chain.back())) {
    const Index after = map_.next(chain.back());
    if (after == first) break;
    chain.push_back(after);
  }
  return chain;
}

Surface::Curve IncrementalAssembly::curve_of(const Surface::Edge& edge, const Arc& arc) const {
  using Curve = Surface::Curve;
  constexpr Real parallel = 1e-12L;
  if (edge.kind == Surface::EdgeKind::rim) {
    const Index upper = arc.label[arc.lower == 0 ? 1 : 0];
    return parts_[upper].kind == FeatureKind::vertex ? Curve::circle : Curve::line;
  }
  Index a = arc.label[0], b = arc.label[1];
  if (parts_[a].kind < parts_[b].kind) std::swap(a, b);
  const FeatureKind first = parts_[a].kind, second = parts_[b].kind;
  if (first == FeatureKind::vertex) return Curve::circle;
  if (edge.kind == Surface::EdgeKind::seam) return first == FeatureKind::face ? Curve::line : Curve::circle;
  if (first == FeatureKind::face) {
    if (second == FeatureKind::face) return Curve::line;
    if (second == FeatureKind::vertex) return Curve::circle;
    const Real sine = dot(parts_.triangle_of(a).normal, parts_.edge_of(b).direction);
    return std::fabs(sine) <= parallel ? Curve::line : Curve::ellipse;
  }
  if (second == FeatureKind::vertex) return Curve::quartic;
  const auto &e = parts_.edge_of(a), &f = parts_.edge_of(b);
  const Vector normal = cross(e.direction, f.direction), between = f.at - e.at;
  const Real sine = length(normal);
  if (sine <= parallel) return Curve::line;
  const Real reach = length(between) + surface_.terrain_->extent();
  return std::fabs(dot(between, normal)) <= parallel * sine * reach ? Curve::ellipse : Curve::quartic;
}

void IncrementalAssembly::add_edge(const Chain& chain) {
  Subdivision& s = surface_.subdivision_;
  const Index h = Index(s.origin.size());
  const Index front = chain.front(), back = chain.back();
  const auto vertex = [&](Index v) {
    Index& number = vertex_number_[v];
    if (number == none) {
      number = Index(surface_.vertex_.size());
      surface_.vertex_.push_back(Point3(map_.vertex(v)));
    }
    return number;
  };
  s.origin.push_back(vertex(map_.origin(front)));
  s.origin.push_back(vertex(map_.origin(back ^ 1u)));
  half_edge_[front] = h;
  half_edge_[back ^ 1u] = h + 1;

  const Arc& arc = map_.arcs()[front / 2];
  const int lower = arc.lower == 2 ? 2 : front % 2 == 0 ? arc.lower : 1 - arc.lower;
  const Surface::Curve curve = curve_of({arc.kind, Surface::Curve::line, {}}, arc);
  surface_.style_.push_back(Surface::style_of(arc.kind, curve, lower));
  chains_.push_back(chain);
  if (curve == Surface::Curve::line) return;
  surface_.guided_edge_.push_back(Index(surface_.style_.size() - 1));
  surface_.guide_begin_.push_back(Index(surface_.guide_.size()));
  for (const Index g : chain) {
    constexpr int pieces = 16;
    const Arc& piece = map_.arcs()[g / 2];
    for (int i = 1; i < pieces + (g != back); ++i) {
      const Real share = Real(g % 2 == 0 ? i : pieces - i) / pieces;
      surface_.guide_.push_back(Point3(piece.point(piece.begin + share * (piece.end - piece.begin))));
    }
  }
}

void IncrementalAssembly::link() {
  Subdivision& s = surface_.subdivision_;
  s.vertex_count = surface_.vertex_.size();
  s.next.assign(s.origin.size(), none);
  for (std::size_t e = 0; e < chains_.size(); ++e) {
    s.next[2 * e] = half_edge_[map_.next(chains_[e].back())];
    s.next[2 * e + 1] = half_edge_[map_.next(chains_[e].front() ^ 1u)];
  }
}

namespace {

/// Points of an arc at which the x of its points may be least.
constexpr int samples = 64;
Vector sample(const Arc& arc, int i) { return arc.point(arc.begin + (arc.end - arc.begin) * Real(i) / samples); }

struct Hit {
  Real x = -std::numeric_limits<Real>::infinity();
  std::size_t arc = 0;
  bool upwards = false;
};

/// The rightmost crossing of the arc with the line at p's y, left of p.
void look_left(const Arc& arc, std::size_t number, Vector p, Hit& best) {
  for (int i = 0; i < samples; ++i) {
    const Vector a = sample(arc, i), b = sample(arc, i + 1);
    if ((a.y <= p.y) == (b.y <= p.y)) continue;
    const bool upwards = a.y <= p.y;
    Real low = Real(i) / samples, high = Real(i + 1) / samples;
    for (int k = 0; k < 60; ++k) {
      const Real middle = (low + high) / 2;
      ((arc.point(arc.begin + middle * (arc.end - arc.begin)).y <= p.y) == upwards ? low : high) = middle;
    }
    const Real x = arc.point(arc.begin + low * (arc.end - arc.begin)).x;
    if (x < p.x && x > best.x) best = {x, number, upwards};
  }
}

}  // namespace

/// Loops of the same face belong together: one that winds around a component and the one in which that lies.
void IncrementalAssembly::number_faces() {
  Subdivision& s = surface_.subdivision_;
  const std::size_t half_edges = s.origin.size();
  std::vector<Index> loop(half_edges, none), start;
  for (Index h = 0; h < half_edges; ++h) {
    if (loop[h] != none) continue;
    for (Index g = h; loop[g] == none; g = s.next[g]) loop[g] = Index(start.size());
    start.push_back(h);
  }
  std::vector<Index> component(s.vertex_count);
  std::iota(component.begin(), component.end(), Index{0});
  const std::function<Index(Index)> find = [&](Index v) {
    return component[v] == v ? v : component[v] = find(component[v]);
  };
  for (std::size_t h = 0; h < half_edges; h += 2) component[find(s.origin[h])] = find(s.origin[h + 1]);

  // The outermost loop of a component is the one with negative area; the others have positive ones.
  std::vector<Real> area(start.size(), 0);
  std::vector<Vector> leftmost(s.vertex_count);
  std::vector<bool> has_leftmost(s.vertex_count, false);
  for (std::size_t e = 0; e < chains_.size(); ++e) {
    for (const Index g : chains_[e]) {
      const Arc& arc = map_.arcs()[g / 2];
      const Index c = find(s.origin[2 * e]);
      for (int i = 0; i <= samples; ++i) {
        const Vector p = sample(arc, i);
        if (i == samples) continue;
        const Vector q = sample(arc, i + 1);
        // Not at a vertex or another round place, at the height of which others may have vertices.
        const Vector left = arc.point(arc.begin + (arc.end - arc.begin) * (Real(i) + 0.4381966L) / samples);
        if (!has_leftmost[c] || left.x < leftmost[c].x) leftmost[c] = left, has_leftmost[c] = true;
        const Real turn = (p.x * q.y - p.y * q.x) * (g % 2 == 0 ? 1 : -1);
        area[loop[2 * e]] += turn, area[loop[2 * e + 1]] -= turn;
      }
    }
  }
  // That is the least of its areas, which samples tell; of a sliver they may not tell the sign.
  std::vector<Index> outermost(s.vertex_count, none);
  for (Index l = 0; l < start.size(); ++l) {
    Index& o = outermost[find(s.origin[start[l]])];
    if (o == none || area[l] < area[o]) o = l;
  }
  const auto is_inner = [&](Index l) { return outermost[find(s.origin[start[l]])] != l; };
  // Face of a loop: its own number if it is an outer one, else that of the loop around its component; start.size() is
  // outside.
  const Index outside = Index(start.size());
  std::vector<Index> around(start.size(), none);
  const std::function<Index(Index)> face_of = [&](Index l) -> Index {
    if (is_inner(l)) return l;
    if (around[l] != none) return around[l];
    const Index own = find(s.origin[start[l]]);
    Hit best;
    for (std::size_t e = 0; e < chains_.size(); ++e) {
      if (find(s.origin[2 * e]) == own) continue;
      for (const Index g : chains_[e]) look_left(map_.arcs()[g / 2], 2 * e + (g % 2), leftmost[own], best);
    }
    if (std::isinf(best.x)) return around[l] = outside;
    // The side to the right of the crossing: of an arc that goes upwards the right one.
    const Index e = Index(best.arc / 2);
    const bool reversed = best.arc % 2 == 1;  // the arc runs against its edge
    const bool right = best.upwards != reversed;
    return around[l] = face_of(loop[2 * e + (right ? 1 : 0)]);
  };
  std::vector<Index> number(start.size() + 1, none);
  number[outside] = 0;
  Index count = 1;
  for (Index l = 0; l < start.size(); ++l) {
    Index& n = number[face_of(l)];
    if (n == none) n = count++;
  }
  s.face.assign(half_edges, none);
  s.face_outer.assign(count, none);
  surface_.face_feature_.assign(count, none);
  std::vector<std::vector<Index>> inner(count);
  for (Index l = 0; l < start.size(); ++l) {
    const Index f = number[face_of(l)];
    if (is_inner(l))
      s.face_outer[f] = start[l];
    else
      inner[f].push_back(start[l]);
  }
  for (Index h = 0; h < half_edges; ++h) s.face[h] = number[face_of(loop[h])];
  for (std::size_t e = 0; e < chains_.size(); ++e) {
    for (const Index side : {0u, 1u}) {
      const Index part = map_.label(chains_[e].front() ^ side);
      surface_.face_feature_[s.face[2 * e + side]] = part == none ? none : parts_[part].feature;
    }
  }
  s.face_inner_begin.assign(1, 0);
  for (const auto& loops : inner) {
    s.face_inner.insert(s.face_inner.end(), loops.begin(), loops.end());
    s.face_inner_begin.push_back(Index(s.face_inner.size()));
  }
}

Surface IncrementalAssembly::finish(const SurfaceCounters& counters) {
  const std::size_t half_edges = 2 * map_.arcs().size();
  vertex_number_.assign(map_.vertex_count(), none);
  half_edge_.assign(half_edges, none);
  std::vector<bool> done(half_edges, false);
  for (Index h = 0; h < half_edges; h += 2) {
    if (done[h]) continue;
    const Chain chain = chain_from(h);
    for (const Index g : chain) done[g] = done[g ^ 1u] = true;
    add_edge(chain);
  }
  surface_.guide_begin_.push_back(Index(surface_.guide_.size()));
  link();
  number_faces();
  surface_.counters_ = counters;
  return std::move(surface_);
}

}  // namespace krepl
