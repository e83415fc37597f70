#include "view/surface/patch_triangles.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>

#include "output/patch_mesh.hpp"

namespace krepl::view {

namespace {

using output::PatchMesh;
using output::PolygonTriangulation;
using output::SurfacePatch;
using Index = PolygonTriangulation::Index;
using Triangle = PolygonTriangulation::Triangle;

/// A triangle deviates from a sphere by up to a third more than its sides.
constexpr double side_share = 0.75;
/// Each pass quarters what is too much.
constexpr int most_passes = 24;

/// Halves inner sides that are too far below the patch, of all triangles alike, until none is left.
class Halving {
 public:
  Halving(const SurfacePatch& patch, double limit, PatchTriangles& mesh) : patch_(patch), limit_(limit), mesh_(mesh) {}

  bool any_too_long() {
    find_sides();
    return std::any_of(uses_.begin(), uses_.end(), [&](const auto& use) { return is_too_long(use.first, use.second); });
  }

  void run() {
    for (int pass = 0; pass < most_passes; ++pass) {
      find_sides();
      middle_.clear();
      for (const Triangle& t : mesh_.triangles)
        for (std::size_t i = 0; i < 3; ++i) halve(t[i], t[(i + 1) % 3]);
      if (middle_.empty()) return;
      std::vector<Triangle> cut;
      for (const Triangle& t : mesh_.triangles) cut_triangle(t, cut);
      mesh_.triangles = std::move(cut);
    }
  }

 private:
  using Key = std::uint64_t;
  static Key key(Index a, Index b) { return Key{std::min(a, b)} << 32 | std::max(a, b); }

  void find_sides() {
    uses_.clear();
    for (const Triangle& t : mesh_.triangles)
      for (std::size_t i = 0; i < 3; ++i) ++uses_[key(t[i], t[(i + 1) % 3])];
  }

  double sagitta(Index a, Index b) const {
    return patch_.sagitta(patch_.curved_square(mesh_.points[a], mesh_.points[b]));
  }
  bool is_too_long(Key side, int uses) const { return uses > 1 && sagitta(Index(side >> 32), Index(side)) > limit_; }

  void halve(Index a, Index b) {
    const Key side = key(a, b);
    if (middle_.count(side) > 0 || !is_too_long(side, uses_[side])) return;
    const Point3 p = mesh_.points[a], q = mesh_.points[b];
    const Point3 m{(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2}, n = patch_.normal(m);
    const double up = sagitta(a, b);
    middle_[side] = Index(mesh_.points.size());
    mesh_.points.push_back({m.x + up * n.x, m.y + up * n.y, m.z + up * n.z});
  }

  Index middle(Index a, Index b) const {
    const auto found = middle_.find(key(a, b));
    return found == middle_.end() ? none : found->second;
  }

  void cut_triangle(const Triangle& t, std::vector<Triangle>& cut) const {
    const std::array<Index, 3> m{middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])};
    const auto count = 3 - std::count(m.begin(), m.end(), none);
    if (count == 0) return cut.push_back(t);
    if (count == 3) {
      cut.insert(cut.end(), {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, {m[0], m[1], m[2]}});
      return;
    }
    // Turned so that the first side is halved and, of two, the third is not.
    std::size_t i = 0;
    while (m[i] == none || (count == 2 && m[(i + 2) % 3] != none)) ++i;
    const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3], ab = m[i], bc = m[(i + 1) % 3];
    if (count == 1) {
      cut.insert(cut.end(), {{a, ab, c}, {ab, b, c}});
    } else if (sagitta(a, bc) < sagitta(ab, c)) {
      cut.insert(cut.end(), {{ab, b, bc}, {a, ab, bc}, {a, bc, c}});
    } else {
      cut.insert(cut.end(), {{ab, b, bc}, {a, ab, c}, {ab, bc, c}});
    }
  }

  static constexpr Index none = ~Index{0};
  const SurfacePatch& patch_;
  const double limit_;
  PatchTriangles& mesh_;
  std::unordered_map<Key, int> uses_;
  std::unordered_map<Key, Index> middle_;
};

}  // namespace

PatchTriangles patch_triangles(const SurfacePatch& patch, std::vector<Point3> points,
                               std::span<const std::vector<PolygonTriangulation::Index>> loops, double max_error) {
  std::vector<Point> places;
  places.reserve(points.size());
  for (const Point3& p : points) places.push_back({p.x, p.y});
  PatchTriangles mesh{std::move(points), PolygonTriangulation(places, loops).triangles()};
  if (patch.kind() == Terrain::FeatureKind::face) return mesh;
  if (!Halving(patch, side_share * max_error, mesh).any_too_long()) return mesh;
  // Flips alone: shorter sides to begin with.
  PatchMesh flipped(patch, mesh.points, mesh.triangles);
  flipped.refine(std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.triangles[t] = flipped.triangle(t);
  Halving(patch, side_share * max_error, mesh).run();
  return mesh;
}

}  // namespace krepl::view
