#include "terrain/assembly.hpp"

#include <algorithm>
#include <numeric>

#include "terrain/curve.hpp"

namespace krepl {

using terrain::Chain;
using terrain::ChainEnd;
using terrain::Meeting;
using terrain::Tile;
using terrain::none;

namespace {

/// The neighbour across a side, and the side of it that is shared.
struct Across {
  std::int64_t columns, rows;
  std::uint8_t side;
};
constexpr Across across[4] = {{0, -1, 2}, {1, 0, 3}, {0, 1, 0}, {-1, 0, 1}};

}  // namespace

SurfaceAssembly::SurfaceAssembly(const terrain::Tiling& tiling, std::vector<Tile> tiles, Surface& surface)
    : tiling_(tiling), tiles_(std::move(tiles)), surface_(surface) {}

Result<Surface> SurfaceAssembly::assemble(std::shared_ptr<const Terrain> terrain, double radius,
                                          const terrain::Tiling& tiling, std::vector<Tile> tiles,
                                          const SurfaceCounters& counters) {
  Surface surface;
  surface.counters_ = counters;
  surface.radius_ = radius;
  surface.terrain_ = std::move(terrain);
  SurfaceAssembly work(tiling, std::move(tiles), surface);
  if (auto error = work.join_sides()) return *error;
  work.number_arms();
  work.trace_edges();
  if (auto error = work.trace_faces()) return *error;
  return surface;
}

SurfaceAssembly::Index SurfaceAssembly::region(Index r) {
  while (region_[r] != r) r = region_[r] = region_[region_[r]];
  return r;
}

Error SurfaceAssembly::disagreement(Index tile, std::uint8_t side) const {
  const auto box = tiling_.box(tile % tiling_.columns, tile / tiling_.columns);
  const Point3 origin = surface_.terrain_->origin();
  return {ErrorCode::computation, "the surface could not be certified: two tiles see their common side differently",
          "side " + std::to_string(side) + " of the tile from x " + std::to_string(box.low.x + origin.x) + ", y " +
              std::to_string(box.low.y + origin.y),
          "please report this input"};
}

/// Regions on both sides of a tile's side are one; chains that end there are found by the number of their crossing.
std::optional<Error> SurfaceAssembly::join_sides() {
  const Index count = Index(tiles_.size());
  vertex_begin_.assign(count + 1, 0);
  arm_begin_.assign(count + 1, 0);
  region_begin_.assign(count + 1, 0);
  for (Index t = 0; t < count; ++t) {
    vertex_begin_[t + 1] = vertex_begin_[t] + Index(tiles_[t].vertices.size());
    arm_begin_[t + 1] = arm_begin_[t] + tiles_[t].arm_begin.back();
    region_begin_[t + 1] = region_begin_[t] + Index(tiles_[t].region_feature.size());
  }
  region_.resize(region_begin_[count]);
  std::iota(region_.begin(), region_.end(), Index{0});
  side_chain_.resize(count);
  used_.resize(count);
  for (Index t = 0; t < count; ++t) {
    const Tile& tile = tiles_[t];
    used_[t].assign(tile.chains.size(), false);
    for (int s = 0; s < 4; ++s) side_chain_[t][s].assign(tile.side_crossing[s].size(), {t, none, 0});
    for (Index c = 0; c < tile.chains.size(); ++c) {
      for (int e = 0; e < 2; ++e) {
        const ChainEnd& end = tile.chains[c].end[e];
        if (end.kind == ChainEnd::Kind::side) side_chain_[t][end.side][end.index] = {t, c, e};
      }
    }
    for (std::uint8_t s = 0; s < 4; ++s) {
      const std::int64_t column = t % tiling_.columns + across[s].columns, row = t / tiling_.columns + across[s].rows;
      if (column < 0 || row < 0 || column >= tiling_.columns || row >= tiling_.rows) {
        if (!tile.side_crossing[s].empty()) return disagreement(t, s);
        continue;
      }
      const Index other = Index(row * tiling_.columns + column);
      const Tile& neighbour = tiles_[other];
      if (tile.side_crossing[s] != neighbour.side_crossing[across[s].side]) return disagreement(t, s);
      for (std::size_t k = 0; k < tile.side_region[s].size(); ++k) {
        const Index a = tile.side_region[s][k], b = neighbour.side_region[across[s].side][k];
        if (tile.region_feature[a] != neighbour.region_feature[b]) return disagreement(t, s);
        const Index x = region(region_begin_[t] + a), y = region(region_begin_[other] + b);
        region_[std::max(x, y)] = std::min(x, y);
      }
    }
  }
  return std::nullopt;
}

void SurfaceAssembly::number_arms() {
  surface_.vertex_.reserve(vertex_begin_.back());
  for (Tile& tile : tiles_) {
    surface_.vertex_.insert(surface_.vertex_.end(), tile.vertices.begin(), tile.vertices.end());
    tile.vertices = {};
  }
  arm_half_edge_.assign(arm_begin_.back(), none);
}

void SurfaceAssembly::trace_edges() {
  // All but closed curves, which are few, end in two arms.
  const std::size_t edges = arm_begin_.back() / 2;
  std::size_t guides = 0;
  for (const Tile& tile : tiles_) guides += tile.guides.size();
  surface_.edge_.reserve(edges);
  surface_.guide_begin_.reserve(edges + 1);
  surface_.guide_.reserve(guides);
  surface_.subdivision_.face.reserve(2 * edges);
  half_edge_arm_.reserve(2 * edges);
  surface_.guide_begin_.push_back(0);
  for (Index t = 0; t < tiles_.size(); ++t) {
    for (Index c = 0; c < tiles_[t].chains.size(); ++c) {
      const Chain& chain = tiles_[t].chains[c];
      if (used_[t][c]) continue;
      if (chain.end[0].kind == ChainEnd::Kind::arm) trace({t, c, 0});
      else if (chain.end[1].kind == ChainEnd::Kind::arm) trace({t, c, 1});
    }
  }
  for (Index t = 0; t < tiles_.size(); ++t) {  // closed curves
    for (Index c = 0; c < tiles_[t].chains.size(); ++c) {
      if (!used_[t][c]) trace({t, c, 0});
    }
  }
  for (Tile& tile : tiles_) tile.chains = {}, tile.guides = {};
  side_chain_ = {};
  used_ = {};
}

/// Makes one edge of all chains from a vertex to the next, or around a closed curve.
void SurfaceAssembly::trace(Step start) {
  Subdivision& s = surface_.subdivision_;
  const Index half_edge = Index(half_edge_arm_.size());
  const Chain& first = tiles_[start.tile].chains[start.chain];
  const int left = start.from == 0 ? 0 : 1;
  Surface::Edge edge{};
  edge.kind = first.meeting == Meeting::seam     ? Surface::EdgeKind::seam
              : first.meeting == Meeting::valley ? Surface::EdgeKind::valley
                                                 : Surface::EdgeKind::rim;
  for (int side = 0; side < 2; ++side) {
    const int own = side == 0 ? left : 1 - left;
    edge.feature[std::size_t(side)] = first.lower == own ? none : tiles_[start.tile].region_feature[first.region[own]];
  }
  edge.curve = terrain::curve_kind(*surface_.terrain_, edge);
  const Index left_region = region_begin_[start.tile] + first.region[left];
  const Index right_region = region_begin_[start.tile] + first.region[1 - left];

  const auto arm_of = [&](Index tile, const ChainEnd& end) { return arm_begin_[tile] + end.index; };
  Index from_arm = none, to_arm = none;
  if (first.end[start.from].kind == ChainEnd::Kind::arm) from_arm = arm_of(start.tile, first.end[start.from]);
  auto& guides = surface_.guide_;
  const std::size_t first_guide = guides.size();
  Step step = start;
  while (true) {
    const Tile& tile = tiles_[step.tile];
    const Chain& chain = tile.chains[step.chain];
    used_[step.tile][step.chain] = true;
    const auto begin = tile.guides.begin() + chain.first_guide, end = begin + chain.guide_count;
    if (step.from == 0) guides.insert(guides.end(), begin, end);
    else guides.insert(guides.end(), std::make_reverse_iterator(end), std::make_reverse_iterator(begin));
    const ChainEnd& last = chain.end[1 - step.from];
    if (last.kind == ChainEnd::Kind::arm) {
      to_arm = arm_of(step.tile, last);
      break;
    }
    if (last.kind == ChainEnd::Kind::closed) break;
    const Across& a = across[last.side];
    const Index other = Index(std::int64_t(step.tile) + a.rows * std::int64_t(tiling_.columns) + a.columns);
    const Step next = side_chain_[other][a.side][last.index];
    if (next.tile == start.tile && next.chain == start.chain) break;
    step = next;
  }
  if (from_arm == none) {  // a closed curve gets a vertex where its first guide is
    surface_.vertex_.push_back(guides[first_guide]);
    guides.erase(guides.begin() + std::ptrdiff_t(first_guide));
    from_arm = Index(arm_half_edge_.size());
    to_arm = from_arm + 1;
    arm_half_edge_.resize(arm_half_edge_.size() + 2);
  }
  half_edge_arm_.push_back(from_arm);
  half_edge_arm_.push_back(to_arm);
  arm_half_edge_[from_arm] = half_edge;
  arm_half_edge_[to_arm] = half_edge + 1;
  s.face.push_back(left_region);  // until faces have numbers
  s.face.push_back(right_region);
  surface_.edge_.push_back(edge);
  surface_.guide_begin_.push_back(Index(guides.size()));
}

std::optional<Error> SurfaceAssembly::trace_faces() {
  Subdivision& s = surface_.subdivision_;
  s.vertex_count = surface_.vertex_.size();
  s.origin.resize(half_edge_arm_.size());
  // The arm clockwise of each arm around its vertex.
  std::vector<Index> clockwise(arm_half_edge_.size());
  for (Index t = 0; t < tiles_.size(); ++t) {
    const auto& begin = tiles_[t].arm_begin;
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
      for (Index a = begin[v]; a < begin[v + 1]; ++a) {
        s.origin[arm_half_edge_[arm_begin_[t] + a]] = vertex_begin_[t] + Index(v);
        clockwise[arm_begin_[t] + a] = arm_begin_[t] + (a > begin[v] ? a : begin[v + 1]) - 1;
      }
    }
  }
  for (Index a = arm_begin_.back(), v = vertex_begin_.back(); a < arm_half_edge_.size(); a += 2, ++v) {
    clockwise[a] = a + 1, clockwise[a + 1] = a;
    s.origin[arm_half_edge_[a]] = s.origin[arm_half_edge_[a + 1]] = v;
  }
  s.next.resize(s.origin.size());
  for (Index h = 0; h < s.origin.size(); ++h) s.next[h] = arm_half_edge_[clockwise[half_edge_arm_[h ^ 1u]]];
  arm_half_edge_ = {};
  half_edge_arm_ = {};

  // Faces in the order of their first half-edge, the outside first.
  std::vector<Index> face_of(region_.size(), none);
  const auto feature_of = [&](Index r) {
    const Index t = Index(std::upper_bound(region_begin_.begin(), region_begin_.end(), r) - region_begin_.begin() - 1);
    return tiles_[t].region_feature[r - region_begin_[t]];
  };
  const Index outside = region(region_begin_[0] + tiles_[0].side_region[0][0]);
  face_of[outside] = 0;
  surface_.face_feature_.push_back(feature_of(outside));
  for (Index h = 0; h < s.origin.size(); ++h) {
    const Index r = region(s.face[h]);
    if (face_of[r] == none) {
      face_of[r] = Index(surface_.face_feature_.size());
      surface_.face_feature_.push_back(feature_of(r));
    }
    s.face[h] = face_of[r];
  }
  region_ = {};

  std::vector<Index> loop_face, loop_start;
  std::vector<double> loop_area;
  collect_loops(loop_face, loop_start, loop_area);
  const Index faces = Index(surface_.face_feature_.size());
  std::vector<Index> outer(faces, none);  // loop
  for (Index l = 0; l < loop_face.size(); ++l) {
    const Index f = loop_face[l];
    if (f != 0 && (outer[f] == none || loop_area[l] > loop_area[outer[f]])) outer[f] = l;
  }
  s.face_outer.assign(faces, Subdivision::none);
  s.face_inner_begin.assign(faces + 1, 0);
  for (Index l = 0; l < loop_face.size(); ++l) {
    if (outer[loop_face[l]] == l) s.face_outer[loop_face[l]] = loop_start[l];
    else ++s.face_inner_begin[loop_face[l] + 1];
  }
  for (Index f = 0; f < faces; ++f) s.face_inner_begin[f + 1] += s.face_inner_begin[f];
  s.face_inner.resize(s.face_inner_begin[faces]);
  std::vector<Index> place(s.face_inner_begin.begin(), s.face_inner_begin.end() - 1);
  for (Index l = 0; l < loop_face.size(); ++l) {
    if (outer[loop_face[l]] != l) s.face_inner[place[loop_face[l]]++] = loop_start[l];
  }
  return std::nullopt;
}

/// Loops of half-edges with their signed area, by vertices and guides.
void SurfaceAssembly::collect_loops(std::vector<Index>& loop_face, std::vector<Index>& loop_start,
                                    std::vector<double>& loop_area) const {
  const Subdivision& s = surface_.subdivision_;
  std::vector<bool> seen(s.next.size(), false);
  for (Index h = 0; h < s.next.size(); ++h) {
    if (seen[h]) continue;
    const Point3 base = surface_.vertex_[s.origin[h]];
    double area = 0;
    Point3 last = base;
    const auto add = [&](Point3 p) {
      area += (last.x - base.x) * (p.y - base.y) - (last.y - base.y) * (p.x - base.x);
      last = p;
    };
    for (Index g = h; !seen[g]; g = s.next[g]) {
      seen[g] = true;
      const Index first = surface_.guide_begin_[g / 2], end = surface_.guide_begin_[g / 2 + 1];
      for (Index i = first; i < end; ++i) add(surface_.guide_[(g & 1u) == 0 ? i : first + end - 1 - i]);
      add(surface_.vertex_[s.origin[g ^ 1u]]);
    }
    loop_face.push_back(s.face[h]);
    loop_start.push_back(h);
    loop_area.push_back(area / 2);
  }
}

}  // namespace krepl
