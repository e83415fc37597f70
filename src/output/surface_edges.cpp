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

/// The same for the wall's foot below a rim.
double foot_distance(const Surface& surface, Index e, std::vector<Point3> points) {
  const Index h = SurfaceEdges::is_foot(surface, 2 * e) ? 2 * e : 2 * e + 1;
  const SurfacePatch patch(surface.terrain(), surface.face_feature(surface.subdivision().face[h]), surface.radius());
  for (Point3& p : points) p.z = patch.height(p.x, p.y);
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

Result<SurfaceEdges> SurfaceEdges::make(const Surface& surface, double max_error, const Context& context) {
  SurfaceEdges edges;
  edges.inner_.resize(surface.subdivision().edge_count());
  std::vector<Index> all(edges.inner_.size());
  std::iota(all.begin(), all.end(), Index{0});
  if (Status made = edges.refine(surface, all, max_error, context); !made) return made.error();
  return edges;
}

Status SurfaceEdges::refine(const Surface& surface, const std::vector<Index>& edges, double max_error, const Context& context) {
  constexpr std::size_t block = 256;
  std::vector<double> deviation((edges.size() + block - 1) / block, 0.0);
  const bool done = kernel::parallel_blocks(context, edges.size(), block, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      Chords found = chords(surface, edges[i], max_error);
      inner_[edges[i]] = std::move(found.inner);
      deviation[first / block] = std::max(deviation[first / block], found.deviation);
    }
  });
  if (!done) return surface_interrupted();
  for (const double d : deviation) deviation_ = std::max(deviation_, d);
  return std::monostate{};
}

}  // namespace krepl::output
