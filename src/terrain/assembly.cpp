#include "terrain/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace krepl {

using terrain::Chain;
using terrain::ChainEnd;
using terrain::Tile;

namespace {

// Sides of a tile.
constexpr std::uint8_t bottom = 0, right = 1, top = 2, left = 3;

/// For so many elements more in a vector that will have `part` of them when it is complete. What is reserved too much is never
/// written to and so costs no memory; growing by doubling would hold two copies of a large array.
template <class T>
void make_room(std::vector<T>& vector, std::size_t more, double part) {
  const std::size_t needed = vector.size() + more;
  if (needed <= vector.capacity()) return;
  const double whole = 1.1 * double(needed) / part;
  vector.reserve(std::size_t(std::clamp(whole, 1.25 * double(needed), 4.0 * double(needed))));
}

bool is_inner(const Chain& chain) {
  return chain.end[0].kind == ChainEnd::Kind::arm && chain.end[1].kind == ChainEnd::Kind::arm;
}

/// The number of an element that was given back, else of a new one.
template <class Element>
terrain::Index take_slot(std::vector<Element>& elements, std::vector<terrain::Index>& given_back) {
  if (given_back.empty()) {
    elements.emplace_back();
    return terrain::Index(elements.size() - 1);
  }
  const terrain::Index number = given_back.back();
  given_back.pop_back();
  return number;
}

}  // namespace

SurfaceAssembly::SurfaceAssembly(std::shared_ptr<const Terrain> terrain, double radius, const terrain::Tiling& tiling)
    : tiling_(tiling), top_(tiling.columns) {
  surface_.radius_ = radius;
  surface_.terrain_ = std::move(terrain);
  surface_.guide_begin_.push_back(0);
}

SurfaceAssembly::Index SurfaceAssembly::region(Index r) {
  while (region_[r] != r) r = region_[r] = region_[region_[r]];
  return r;
}

Error SurfaceAssembly::disagreement(std::uint8_t side) const {
  const auto box = tiling_.box(Index(tiles_ % tiling_.columns), Index(tiles_ / tiling_.columns));
  const Point3 origin = surface_.terrain_->origin();
  return {ErrorCode::computation, "the surface could not be certified: two tiles see their common side differently",
          "side " + std::to_string(side) + " of the tile from x " + std::to_string(box.low.x + origin.x) + ", y " +
              std::to_string(box.low.y + origin.y),
          "please report this input"};
}

void SurfaceAssembly::make_room(const Tile& tile) {
  const double part = double(tiles_ + 1) / double(tiling_.count());
  const std::size_t joined = tile.side_crossing[left].size() + tile.side_crossing[bottom].size();
  const std::size_t half_edges = tile.arm_begin.back() + 2 * joined;
  Subdivision& s = surface_.subdivision_;
  krepl::make_room(surface_.vertex_, tile.vertices.size(), part);
  krepl::make_room(surface_.style_, half_edges / 2, part);
  for (std::vector<Index>* array : {&s.origin, &s.next, &s.face}) krepl::make_room(*array, half_edges, part);
  for (std::vector<Index>* array : {&region_, &surface_.face_feature_}) {
    krepl::make_room(*array, tile.region_feature.size(), part);
  }
  krepl::make_room(surface_.guide_, tile.guides.size(), part);
}

std::optional<Error> SurfaceAssembly::add(Tile tile) {
  SurfaceCounters& sum = surface_.counters_;
  sum.patches += tile.counters.patches;
  sum.cells += tile.counters.cells;
  sum.leaves += tile.counters.leaves;
  sum.smallest_cells += tile.counters.smallest_cells;
  sum.lines += tile.counters.lines;
  sum.height_evaluations += tile.counters.height_evaluations;

  make_room(tile);
  const Index first_region = Index(region_.size());
  for (const Index feature : tile.region_feature) {
    region_.push_back(Index(region_.size()));
    surface_.face_feature_.push_back(feature);
  }
  for (Chain& chain : tile.chains) {
    for (Index& r : chain.region) r += first_region;
  }
  TileArms arms;
  add_inner_edges(tile, arms);
  surface_.vertex_.insert(surface_.vertex_.end(), tile.vertices.begin(), tile.vertices.end());
  connect_vertices(tile, arms);
  std::array<OpenSide, 4> sides;
  for (std::size_t s = 0; s < 4; ++s) {
    sides[s] = {std::move(tile.side_crossing[s]), std::move(tile.side_region[s]), {}};
    for (Index& r : sides[s].region) r += first_region;
    sides[s].strand.resize(sides[s].crossing.size());
  }
  add_strands(tile, arms, sides);

  const std::size_t column = tiles_ % tiling_.columns, row = tiles_ / tiling_.columns;
  const auto is_rim = [&](std::uint8_t s) {
    if (s == bottom || s == top) return row == (s == bottom ? 0 : tiling_.rows - 1);
    return column == (s == left ? 0 : tiling_.columns - 1);
  };
  for (const std::uint8_t s : {bottom, right, top, left}) {
    if (is_rim(s) && !sides[s].crossing.empty()) return disagreement(s);
  }
  if (!is_rim(left) && !join(right_, sides[left])) return disagreement(left);
  if (!is_rim(bottom) && !join(top_[column], sides[bottom])) return disagreement(bottom);
  right_ = std::move(sides[right]);
  top_[column] = std::move(sides[top]);
  ++tiles_;
  return std::nullopt;
}

/// Edges that lie in the tile with both their vertices.
void SurfaceAssembly::add_inner_edges(const Tile& tile, TileArms& arms) {
  arms.half_edge.assign(tile.arm_begin.back(), none);
  std::vector<Index> vertex_of(tile.arm_begin.back());
  for (std::size_t v = 0; v + 1 < tile.arm_begin.size(); ++v) {
    const auto first = vertex_of.begin();
    std::fill(first + tile.arm_begin[v], first + tile.arm_begin[v + 1], Index(surface_.vertex_.size() + v));
  }
  for (const Chain& chain : tile.chains) {
    if (!is_inner(chain)) continue;
    const Index from = chain.end[0].index, to = chain.end[1].index;
    const std::uint8_t style = Surface::style_of(chain.kind, chain.curve, chain.lower);
    const Index h = add_edge(style, chain.region[0], chain.region[1], vertex_of[from], vertex_of[to]);
    add_guides(tile.guides.data() + chain.first_guide, chain.guide_count);
    arms.half_edge[from] = h;
    arms.half_edge[to] = h + 1;
  }
}

void SurfaceAssembly::connect_vertices(const Tile& tile, TileArms& arms) {
  arms.open.resize(arms.half_edge.size());
  const Index first_vertex = Index(surface_.vertex_.size() - tile.vertices.size());
  std::vector<Index> around;
  for (std::size_t v = 0; v + 1 < tile.arm_begin.size(); ++v) {
    const Index begin = tile.arm_begin[v], end = tile.arm_begin[v + 1];
    around.assign(arms.half_edge.begin() + begin, arms.half_edge.begin() + end);
    const Index unknown = Index(std::count(around.begin(), around.end(), none));
    if (unknown == 0) {
      connect(around);
      continue;
    }
    const Index number = take_slot(open_vertex_, free_open_vertex_);
    open_vertex_[number] = {first_vertex + Index(v), unknown, around};
    for (Index a = begin; a < end; ++a) arms.open[a] = {number, a - begin};
  }
}

void SurfaceAssembly::add_strands(const Tile& tile, const TileArms& arms, std::array<OpenSide, 4>& sides) {
  for (const Chain& chain : tile.chains) {
    if (is_inner(chain)) continue;
    const Index number = take_slot(strand_, free_strand_);
    Strand& strand = strand_[number];
    strand = {};
    strand.style = Surface::style_of(chain.kind, chain.curve, chain.lower);
    const auto first_guide = tile.guides.begin() + chain.first_guide;
    strand.guides.assign(first_guide, first_guide + chain.guide_count);
    for (int e = 0; e < 2; ++e) {
      strand.region[e] = chain.region[e];
      const ChainEnd& end = chain.end[e];
      if (end.kind == ChainEnd::Kind::arm) strand.arm[e] = arms.open[end.index];
      if (end.kind == ChainEnd::Kind::side) sides[end.side].strand[end.index] = {number, e};
    }
    if (chain.end[0].kind == ChainEnd::Kind::closed) emit_closed(number);
  }
}

/// What lies on both sides of a tile's side is the same. False if it is not.
bool SurfaceAssembly::join(OpenSide& earlier, OpenSide& later) {
  if (earlier.crossing != later.crossing) return false;
  for (std::size_t k = 0; k < earlier.region.size(); ++k) {
    if (surface_.face_feature_[earlier.region[k]] != surface_.face_feature_[later.region[k]]) return false;
    const Index a = region(earlier.region[k]), b = region(later.region[k]);
    region_[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t k = 0; k < earlier.strand.size(); ++k) join(earlier.strand[k], later.strand[k]);
  earlier = {};
  return true;
}

/// A strand that has been merged into another one is known at one place only, its last open end.
SurfaceAssembly::StrandEnd SurfaceAssembly::current(StrandEnd end) {
  while (strand_[end.strand].merged_strand != none) {
    const Strand& strand = strand_[end.strand];
    free_strand_.push_back(end.strand);
    end = {strand.merged_strand, strand.merged_end};
  }
  return end;
}

void SurfaceAssembly::join(StrandEnd earlier, StrandEnd later) {
  const StrandEnd kept = current(earlier), taken = current(later);
  if (kept.strand == taken.strand) {
    emit_closed(kept.strand);
    return;
  }
  Strand &a = strand_[kept.strand], &b = strand_[taken.strand];
  // Guides of b in the direction of a.
  if (kept.end == taken.end) std::reverse(b.guides.begin(), b.guides.end());
  a.guides.insert(kept.end == 1 ? a.guides.end() : a.guides.begin(), b.guides.begin(), b.guides.end());
  b.guides = std::vector<Point3>();
  const int far = 1 - taken.end;
  a.arm[kept.end] = b.arm[far];
  if (b.arm[far].open_vertex == none) {
    b.merged_strand = kept.strand;
    b.merged_end = kept.end;
    return;
  }
  free_strand_.push_back(taken.strand);
  if (a.arm[1 - kept.end].open_vertex != none) emit(kept.strand);
}

void SurfaceAssembly::emit(Index number) {
  Strand& strand = strand_[number];
  const Arm from = strand.arm[0], to = strand.arm[1];
  const Index h = add_edge(strand.style, strand.region[0], strand.region[1], open_vertex_[from.open_vertex].vertex,
                           open_vertex_[to.open_vertex].vertex);
  add_guides(strand.guides.data(), strand.guides.size());
  strand.guides = std::vector<Point3>();
  attach(from, h);
  attach(to, h + 1);
  free_strand_.push_back(number);
}

/// A closed curve gets a vertex where its first guide is.
void SurfaceAssembly::emit_closed(Index number) {
  Strand& strand = strand_[number];
  const Index vertex = Index(surface_.vertex_.size());
  surface_.vertex_.push_back(strand.guides.front());
  const Index h = add_edge(strand.style, strand.region[0], strand.region[1], vertex, vertex);
  add_guides(strand.guides.data() + 1, strand.guides.size() - 1);
  strand.guides = std::vector<Point3>();
  connect({h, h + 1});
  free_strand_.push_back(number);
}

SurfaceAssembly::Index SurfaceAssembly::add_edge(std::uint8_t style, Index left_region, Index right_region, Index from,
                                                 Index to) {
  Subdivision& s = surface_.subdivision_;
  const Index h = Index(s.origin.size());
  s.origin.insert(s.origin.end(), {from, to});
  s.next.insert(s.next.end(), {none, none});
  s.face.insert(s.face.end(), {left_region, right_region});  // until faces have numbers
  surface_.style_.push_back(style);
  return h;
}

/// Of the edge added last.
void SurfaceAssembly::add_guides(const Point3* first, std::size_t count) {
  if (count == 0) return;
  surface_.guided_edge_.push_back(Index(surface_.style_.size() - 1));
  surface_.guide_.insert(surface_.guide_.end(), first, first + count);
  surface_.guide_begin_.push_back(Index(surface_.guide_.size()));
}

void SurfaceAssembly::attach(Arm arm, Index half_edge) {
  OpenVertex& vertex = open_vertex_[arm.open_vertex];
  vertex.half_edge[arm.place] = half_edge;
  if (--vertex.unknown > 0) return;
  connect(vertex.half_edge);
  vertex.half_edge = std::vector<Index>();
  free_open_vertex_.push_back(arm.open_vertex);
}

/// Half-edges from a vertex, counter-clockwise: after one that comes in, the next one clockwise goes out.
void SurfaceAssembly::connect(const std::vector<Index>& around) {
  for (std::size_t i = 0; i < around.size(); ++i) {
    surface_.subdivision_.next[Subdivision::twin(around[i])] = around[i > 0 ? i - 1 : around.size() - 1];
  }
}

Surface SurfaceAssembly::finish() {
  surface_.subdivision_.vertex_count = surface_.vertex_.size();
  strand_ = std::vector<Strand>();
  open_vertex_ = std::vector<OpenVertex>();
  number_faces();
  list_loops();
  return std::move(surface_);
}

/// Faces in the order of their first region. The outside is first: the first side of the first tile begins there.
void SurfaceAssembly::number_faces() {
  Index count = 0;
  for (Index r = 0; r < region_.size(); ++r) {
    // Roots come before what is joined to them; by now they hold their face's number.
    if (region_[r] != r) {
      region_[r] = region_[region_[r]];
      continue;
    }
    surface_.face_feature_[count] = surface_.face_feature_[r];
    region_[r] = count++;
  }
  surface_.face_feature_.resize(count);
  for (Index& f : surface_.subdivision_.face) f = region_[f];
  region_ = std::vector<Index>();
}

/// The outer loop of each face, and the inner ones in the order of their first half-edge.
void SurfaceAssembly::list_loops() {
  Subdivision& s = surface_.subdivision_;
  const std::size_t faces = surface_.face_feature_.size();
  struct Loop {
    Index face, start;
  };
  std::vector<Loop> further;  // loops of a face after its first one; all of the outside
  std::vector<bool> seen(s.next.size(), false);
  s.face_outer.assign(faces, none);
  for (Index h = 0; h < s.next.size(); ++h) {
    if (seen[h]) continue;
    for (Index g = h; !seen[g]; g = s.next[g]) seen[g] = true;
    if (s.face[h] != 0 && s.face_outer[s.face[h]] == none) s.face_outer[s.face[h]] = h;
    else further.push_back({s.face[h], h});
  }
  std::stable_sort(further.begin(), further.end(), [](const Loop& a, const Loop& b) { return a.face < b.face; });
  s.face_inner_begin.assign(faces + 1, 0);
  s.face_inner.reserve(further.size());
  auto loop = further.begin();
  for (Index f = 0; f < faces; ++f) {
    s.face_inner_begin[f] = Index(s.face_inner.size());
    const auto first = s.face_inner.size();
    for (; loop != further.end() && loop->face == f; ++loop) s.face_inner.push_back(loop->start);
    if (f == 0 || s.face_inner.size() == first) continue;
    // The outer loop has the largest signed area, as only it is positive.
    Index* outer = &s.face_outer[f];
    double largest = loop_area(*outer);
    for (std::size_t i = first; i < s.face_inner.size(); ++i) {
      const double area = loop_area(s.face_inner[i]);
      if (area > largest) largest = area, outer = &s.face_inner[i];
    }
    std::swap(*outer, s.face_outer[f]);
    std::sort(s.face_inner.begin() + std::ptrdiff_t(first), s.face_inner.end());
  }
  s.face_inner_begin[faces] = Index(s.face_inner.size());
}

double SurfaceAssembly::loop_area(Index h) const {
  const Subdivision& s = surface_.subdivision_;
  const Point3 base = surface_.vertex_[s.origin[h]];
  Point3 last = base;
  double area = 0;
  Index g = h;
  do {
    std::vector<Point3> points = surface_.curve(g / 2, 5);
    if (g % 2 == 1) std::reverse(points.begin(), points.end());
    for (const Point3 p : points) {
      area += (last.x - base.x) * (p.y - base.y) - (last.y - base.y) * (p.x - base.x);
      last = p;
    }
    g = s.next[g];
  } while (g != h);
  return area / 2;
}

}  // namespace krepl
