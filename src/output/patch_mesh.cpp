#include "output/patch_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/orientation.hpp"

namespace krepl::output {

namespace {

/// Shorter by less than this is a tie: rounding must not flip a side to and fro.
constexpr double clearly_shorter = 1 - 1e-9;
/// A flip that leaves so thin a triangle would bring back the side that a new vertex has just halved, for ever.
constexpr double thinnest = 1e-3;
/// Of a cylinder, length along the axis counts so little, that sides become rulings.
constexpr double along_weight = 1e-6;

/// Twice the area of a triangle, seen from above and in terms of the square of a side, below which it is as good as none.
constexpr double negligible = 1e-7;
constexpr int most_sides = 100;

}  // namespace

PatchMesh::PatchMesh(const SurfacePatch& patch, std::vector<Point3> points, const std::vector<Triangle>& triangles)
    : patch_(patch), points_(std::move(points)), border_points_(points_.size()) {
  corner_.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) corner_.insert(corner_.end(), t.begin(), t.end());
  connect();
}

int PatchMesh::turn(Index a, Index b, Index c) const {
  return kernel::orientation({points_[a].x, points_[a].y}, {points_[b].x, points_[b].y}, {points_[c].x, points_[c].y});
}

double PatchMesh::area(Index a, Index b, Index c) const {
  const Point3 p = points_[a], q = points_[b], r = points_[c];
  return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

double PatchMesh::cost(Index a, Index b) const {
  const Point3 p = points_[a], q = points_[b];
  const double x = p.x - q.x, y = p.y - q.y, z = p.z - q.z, square = x * x + y * y + z * z;
  if (patch_.kind() != Terrain::FeatureKind::edge) return square;
  return patch_.curved_square(p, q) + along_weight * square;
}

/// Joins sides that run to and fro between the same corners. What is not alone in that is left as a border.
void PatchMesh::connect() {
  opposite_.assign(corner_.size(), none);
  std::vector<std::array<Index, 3>> sides;
  for (Index s = 0; s < corner_.size(); ++s) {
    const Index a = corner_[s], b = corner_[next(s)];
    sides.push_back({std::min(a, b), std::max(a, b), s});
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end][0] == sides[i][0] && sides[end][1] == sides[i][1]) ++end;
    if (end - i == 2 && corner_[sides[i][2]] != corner_[sides[i + 1][2]]) pair(sides[i][2], sides[i + 1][2]);
  }
}

void PatchMesh::pair(Index side, Index other) {
  opposite_[side] = other;
  if (other != none) opposite_[other] = side;
}

bool PatchMesh::should_flip(Index side) const {
  const Index other = opposite_[side];
  if (other == none) return false;
  const Index a = corner_[side], b = corner_[next(side)], c = corner_[previous(side)], d = corner_[previous(other)];
  if (c == d) return false;
  if (narrow_) return should_flip_needles(a, b, c, d) && !may_reach(side, d);
  if (turn(a, d, c) <= 0 || turn(d, b, c) <= 0) return false;
  if (turn(a, b, c) <= 0 || turn(b, a, d) <= 0) return true;
  const double now = std::min(area(a, b, c), area(b, a, d)), then = std::min(area(a, d, c), area(d, b, c));
  if (!(then > thinnest * now && cost(c, d) < clearly_shorter * cost(a, b))) return false;
  // A flip that made a side too long would be undone by halving it, and so on without end.
  const double flipped = patch_.curved_square(points_[c], points_[d]);
  return patch_.sagitta(flipped) <= limit_ || flipped <= patch_.curved_square(points_[a], points_[b]);
}

bool PatchMesh::is_needle(Index a, Index b, Index c) const {
  const Point3 p = points_[a], q = points_[b], r = points_[c];
  const auto square = [](Point3 v, Point3 w) { return (v.x - w.x) * (v.x - w.x) + (v.y - w.y) * (v.y - w.y); };
  return std::fabs(area(a, b, c)) <= negligible * std::max({square(p, q), square(q, r), square(r, p)});
}

/// Where the view from above tells nothing, as between points in one line, what counts is that sides become shorter in space.
bool PatchMesh::should_flip_needles(Index a, Index b, Index c, Index d) const {
  if (!is_needle(a, b, c) || !is_needle(b, a, d)) return false;
  const int folded = (turn(a, b, c) < 0) + (turn(b, a, d) < 0);
  if ((turn(a, d, c) < 0) + (turn(d, b, c) < 0) > folded) return false;
  const double flipped = patch_.curved_square(points_[c], points_[d]);
  return flipped < clearly_shorter * patch_.curved_square(points_[a], points_[b]) && is_curved(a, b);
}

bool PatchMesh::is_curved(Index a, Index b) const {
  return patch_.sagitta(patch_.curved_square(points_[a], points_[b])) > limit_;
}

/// False if the corner across `side` is joined to d by no side: a second one would be of four triangles. Of a corner with very
/// many sides that is not asked.
bool PatchMesh::may_reach(Index side, Index d) const {
  const Index start = previous(side);
  Index s = start;
  int left = most_sides;
  do {
    if (corner_[next(s)] == d || corner_[previous(s)] == d || --left == 0) return true;
    s = opposite_[previous(s)];
  } while (s != none && s != start);
  if (s == start) return false;
  for (s = opposite_[start]; s != none; s = opposite_[next(s)]) {
    if (corner_[s] == d || corner_[previous(s)] == d || --left == 0) return true;
  }
  return false;
}

/// Triangles a b c and b a d become d c a and c d b.
void PatchMesh::flip(Index side) {
  const Index other = opposite_[side];
  const Index bc = next(side), ca = previous(side), ad = next(other), db = previous(other);
  const Index a = corner_[side], b = corner_[other], c = corner_[ca], d = corner_[db];
  const Index beyond_bc = opposite_[bc], beyond_ca = opposite_[ca], beyond_ad = opposite_[ad], beyond_db = opposite_[db];
  corner_[side] = d, corner_[bc] = c, corner_[ca] = a;
  corner_[other] = c, corner_[ad] = d, corner_[db] = b;
  pair(bc, beyond_ca);
  pair(ca, beyond_ad);
  pair(ad, beyond_db);
  pair(db, beyond_bc);
  doubtful_.insert(doubtful_.end(), {bc, ca, ad, db});
}

void PatchMesh::settle() {
  while (!doubtful_.empty()) {
    const Index side = doubtful_.back();
    doubtful_.pop_back();
    if (should_flip(side)) flip(side);
  }
}

bool PatchMesh::is_too_long(Index side) const {
  if (opposite_[side] == none) return false;
  const Point3 a = points_[corner_[side]], b = points_[corner_[next(side)]];
  if (!is_curved(corner_[side], corner_[next(side)])) return false;
  // Needles are left for later, when no flip can bring them back.
  const Index p = corner_[side], q = corner_[next(side)];
  if (!narrow_ && is_needle(p, q, corner_[previous(side)]) && is_needle(q, p, corner_[previous(opposite_[side])])) return false;
  // Beside a border chord that is too long itself, needles would become thinner without end.
  for (const Index s : {next(side), previous(side), next(opposite_[side]), previous(opposite_[side])})
    if (narrow_ && opposite_[s] == none && is_curved(corner_[s], corner_[next(s)])) return false;
  const double x = (a.x + b.x) / 2, y = (a.y + b.y) / 2;
  return !(x == a.x && y == a.y) && !(x == b.x && y == b.y);
}

/// Triangles a b c and b a d become a m c, m b c, b m d and m a d. The new corner is over the middle of the side, where it
/// cannot fall out of the two triangles.
void PatchMesh::halve(Index side) {
  const Index other = opposite_[side];
  const Index bc = next(side), ad = next(other);
  const Index a = corner_[side], b = corner_[other], c = corner_[previous(side)], d = corner_[previous(other)];
  const double x = (points_[a].x + points_[b].x) / 2, y = (points_[a].y + points_[b].y) / 2;
  const auto m = Index(points_.size()), first = Index(corner_.size()), second = first + 3;
  points_.push_back({x, y, patch_.height(x, y)});
  const Index beyond_bc = opposite_[bc], beyond_ad = opposite_[ad];
  corner_.insert(corner_.end(), {m, b, c, m, a, d});
  opposite_.resize(corner_.size(), none);
  corner_[bc] = m, corner_[ad] = m;
  pair(first + 1, beyond_bc);
  pair(bc, first + 2);
  pair(second + 1, beyond_ad);
  pair(ad, second + 2);
  pair(side, second);
  pair(other, first);
  doubtful_.insert(doubtful_.end(), {side, other, bc, ad, previous(side), previous(other), first + 1, second + 1});
}

void PatchMesh::refine(double max_error) {
  for (Index s = 0; s < corner_.size(); ++s) doubtful_.push_back(s);
  settle();
  if (patch_.kind() == Terrain::FeatureKind::face) return;
  // The circumscribed circle of a triangle on a sphere can be larger than its sides alone tell, by a third in the deviation.
  limit_ = patch_.kind() == Terrain::FeatureKind::vertex ? 0.75 * max_error : max_error;
  halve_all();
  narrow_ = true;
  for (Index s = 0; s < corner_.size(); ++s) doubtful_.push_back(s);
  settle();
  halve_all();
}

/// Needles beside a border chord that is too long itself would become thinner without end: then deviation() says so.
void PatchMesh::halve_all() {
  const std::size_t most_points = 4 * points_.size() + 1000;
  for (bool changed = true; changed;) {
    changed = false;
    for (Index s = 0; s < corner_.size(); ++s) {
      if (!is_too_long(s)) continue;
      if (narrow_ && points_.size() >= most_points) return;
      halve(s);
      settle();
      changed = true;
    }
  }
}

void PatchMesh::lift(const Terrain& terrain, double radius, std::span<const Chord> chords) {
  for (Index s = 0; s < corner_.size(); ++s) {
    if (opposite_[s] != none || corner_[previous(s)] < border_points_) continue;
    const auto chord = std::lower_bound(chords.begin(), chords.end(), Chord{corner_[s], corner_[next(s)], 0});
    if (chord == chords.end() || chord->from != corner_[s] || chord->to != corner_[next(s)]) continue;
    lift_beside(s, SurfacePatch(terrain, chord->beyond, radius));
  }
}

/// Points that are lifted hang together from the chord on. One that is where it belongs is not lifted again.
void PatchMesh::lift_beside(Index border_side, const SurfacePatch& beyond) {
  std::vector<Index> sides{border_side};
  while (!sides.empty()) {
    const Index side = sides.back();
    sides.pop_back();
    const Index apex = corner_[previous(side)];
    if (apex < border_points_) continue;
    Point3& p = points_[apex];
    const double height = beyond.height(p.x, p.y);
    if (!(height > p.z) || !beyond.is_over_feature({p.x, p.y, height})) continue;
    p.z = height;
    for (const Index s : {next(side), previous(side)})
      if (opposite_[s] != none) sides.push_back(opposite_[s]);
  }
}

double PatchMesh::deviation() const {
  double largest = 0;
  for (std::size_t t = 0; t < triangle_count(); ++t) {
    const Triangle c = triangle(t);
    largest = std::max(largest, patch_.deviation(points_[c[0]], points_[c[1]], points_[c[2]]));
  }
  return largest;
}

std::size_t PatchMesh::folded() const {
  std::size_t count = 0;
  for (std::size_t t = 0; t < triangle_count(); ++t) {
    const Triangle c = triangle(t);
    count += turn(c[0], c[1], c[2]) < 0 ? 1 : 0;
  }
  return count;
}

}  // namespace krepl::output
