#include "output/surface_edges.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/parallel.hpp"
#include "output/surface_patch.hpp"
#include "output/surface_writers.hpp"

namespace krepl::output {

namespace {

using Index = SurfaceEdges::Index;

double distance_to_chord(Point3 p, Point3 a, Point3 b) {
  const Point3 d{b.x - a.x, b.y - a.y, b.z - a.z}, v{p.x - a.x, p.y - a.y, p.z - a.z};
  const double square = d.x * d.x + d.y * d.y + d.z * d.z;
  const double t = square > 0 ? std::clamp((v.x * d.x + v.y * d.y + v.z * d.z) / square, 0.0, 1.0) : 0.0;
  return std::hypot(v.x - t * d.x, v.y - t * d.y, v.z - t * d.z);
}

/// Between chords from every fourth point to the next fourth: the largest distance of the points in between.
double largest_distance(const std::vector<Point3>& points) {
  double largest = 0;
  for (std::size_t i = 0; i + 4 < points.size(); i += 4) {
    for (std::size_t k = 1; k < 4; ++k) largest = std::max(largest, distance_to_chord(points[i + k], points[i], points[i + 4]));
  }
  return largest;
}

/// Moves points of rim e down to the wall's foot.
void move_to_foot(const Surface& surface, Index e, std::span<Point3> points) {
  const Index h = SurfaceEdges::is_foot(surface, 2 * e) ? 2 * e : 2 * e + 1;
  const SurfacePatch patch(surface.terrain(), surface.face_feature(surface.subdivision().face[h]), surface.radius());
  for (Point3& p : points) p.z = patch.height(p.x, p.y);
}

double foot_distance(const Surface& surface, Index e, std::vector<Point3> points) {
  move_to_foot(surface, e, points);
  return largest_distance(points);
}

struct Chords {
  std::vector<Point3> inner;
  double deviation = 0;
};

Chords chords(const Surface& surface, Index e, double max_error) {
  const bool foot = SurfaceEdges::has_foot(surface, e);
  if (surface.edge(e).curve == Surface::Curve::line && !foot) return {};
  const Subdivision& topology = surface.subdivision();
  // A closed curve needs three chords to have an inside.
  int pieces = topology.origin[2 * e] == topology.origin[2 * e + 1] ? 3 : 1;
  constexpr int most_pieces = 1 << 20;
  for (;;) {
    const std::vector<Point3> points = surface.curve(e, 4 * pieces + 1);
    double deviation = largest_distance(points);
    if (foot) deviation = std::max(deviation, foot_distance(surface, e, points));
    if (deviation <= max_error || pieces >= most_pieces) {
      Chords result{{}, deviation};
      for (std::size_t i = 4; i + 4 < points.size(); i += 4) result.inner.push_back(points[i]);
      return result;
    }
    // Halving a chord quarters its deviation.
    const double wanted = std::min(1.05 * pieces * std::sqrt(deviation / max_error), double(most_pieces));
    pieces = std::max(pieces + 1, int(std::ceil(wanted)));
  }
}

}  // namespace

std::span<const Point3> SurfaceEdges::points_of(Index e) const {
  const Block& block = block_[e / block_size];
  const Index* begin = &block.begin[e % block_size];
  return std::span(block.points).subspan(begin[0], begin[1] - begin[0]);
}

std::span<const Point3> SurfaceEdges::inner(Index e) const {
  const std::span<const Point3> points = points_of(e);
  return points.empty() || !has_foot(*surface_, e) ? points : points.first(points.size() / 2);
}

Point3 SurfaceEdges::point(Index i) const {
  const auto after = std::upper_bound(first_.begin(), first_.end(), i) - 1;
  return block_[std::size_t(after - first_.begin())].points[i - *after];
}

Result<SurfaceEdges> SurfaceEdges::make(const Surface& surface, double max_error, const Context& context) {
  const std::size_t count = surface.subdivision().edge_count();
  SurfaceEdges edges(surface);
  edges.block_.resize((count + block_size - 1) / block_size);
  std::vector<double> deviation(edges.block_.size());
  const bool done = kernel::parallel_blocks(context, count, block_size, [&](std::size_t first, std::size_t last) {
    std::vector<Index> all(last - first);
    std::iota(all.begin(), all.end(), Index(first));
    edges.block_[first / block_size].begin.resize(all.size() + 1);
    deviation[first / block_size] = edges.remake(all, max_error);
  });
  if (!done) return surface_interrupted();
  for (const double d : deviation) edges.deviation_ = std::max(edges.deviation_, d);
  if (Status numbered = edges.number(); !numbered) return numbered.error();
  return edges;
}

/// Makes the points of some edges of one block anew, and returns their deviation.
double SurfaceEdges::remake(std::span<const Index> edges, double max_error) {
  const Index first = edges.front() / block_size * block_size;
  Block& block = block_[first / block_size];
  Block made;
  double deviation = 0;
  for (Index e = first; e + 1 < first + block.begin.size(); ++e) {
    made.begin.push_back(Index(made.points.size()));
    if (edges.empty() || edges.front() != e) {
      const std::span<const Point3> known = points_of(e);
      made.points.insert(made.points.end(), known.begin(), known.end());
      continue;
    }
    edges = edges.subspan(1);
    const Chords found = chords(*surface_, e, max_error);
    deviation = std::max(deviation, found.deviation);
    made.points.insert(made.points.end(), found.inner.begin(), found.inner.end());
    if (!has_foot(*surface_, e)) continue;
    made.points.insert(made.points.end(), found.inner.begin(), found.inner.end());
    move_to_foot(*surface_, e, std::span(made.points).last(found.inner.size()));
  }
  made.begin.push_back(Index(made.points.size()));
  made.begin.shrink_to_fit();
  made.points.shrink_to_fit();
  block = std::move(made);
  return deviation;
}

Status SurfaceEdges::number() {
  std::uint64_t count = 0;
  first_.clear();
  first_.reserve(block_.size() + 1);
  for (const Block& block : block_) {
    first_.push_back(Index(count));
    count += block.points.size();
    if (count >= Surface::none) return too_many_vertices();
  }
  first_.push_back(Index(count));
  return std::monostate{};
}

Status SurfaceEdges::refine(std::span<const Index> edges, double max_error, const Context& context) {
  std::vector<std::span<const Index>> by_block;
  while (!edges.empty()) {
    const auto other =
        std::find_if(edges.begin(), edges.end(), [&](Index e) { return e / block_size != edges[0] / block_size; });
    by_block.push_back(edges.first(std::size_t(other - edges.begin())));
    edges = edges.subspan(by_block.back().size());
  }
  std::vector<double> deviation(by_block.size());
  const bool done = kernel::parallel_blocks(
      context, by_block.size(), 1, [&](std::size_t i, std::size_t) { deviation[i] = remake(by_block[i], max_error); });
  if (!done) return surface_interrupted();
  for (const double d : deviation) deviation_ = std::max(deviation_, d);
  return number();
}

}  // namespace krepl::output
