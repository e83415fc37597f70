#include "solid/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solid/patch.hpp"
#include "terrain/curve.hpp"

namespace krepl::solid {

namespace {

using Index = Topology::Index;

double length_along(const std::vector<Point3>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += distance(points[i - 1], points[i]);
  return sum;
}

/// The longer of the upper and the lower border of a wall, else the edge's length. Five points tell a closed curve from
/// a point.
double edge_length(const Surface& surface, Index e) {
  std::vector<Point3> points = surface.curve(e, 5);
  double found = length_along(points);
  const Surface::Edge edge = surface.edge(e);
  if (edge.kind != Surface::EdgeKind::rim) return found;
  const Index low = 2 * e + (edge.feature[0] == Surface::none ? 0 : 1);
  const Index feature = surface.face_feature(surface.subdivision().face[low]);
  if (feature == Surface::none) return found;
  for (Point3& p : points) p.z = height_over(surface, feature, p);
  return std::max(found, length_along(points));
}

/// How far points of one edge are from the curve of another.
double distance_to_edge(const Surface& surface, const std::vector<Point3>& points, Index e) {
  const Surface::Edge edge = surface.edge(e);
  const std::vector<Point3> line = surface.curve(e, 3);
  double largest = 0;
  for (const Point3 p : points) {
    const Point3 d = line.back() - line.front();
    const double square = dot(d, d), t = square > 0 ? std::clamp(dot(p - line.front(), d) / square, 0.0, 1.0) : 0;
    const Point3 foot = edge.curve == Surface::Curve::line
                            ? line.front() + t * d
                            : terrain::project_to_curve(surface.terrain(), surface.radius(), edge, p, surface.radius());
    largest = std::max(largest, distance(p, foot));
  }
  return largest;
}

}  // namespace

Topology::Topology(const Surface& surface, double tolerance) {
  const Subdivision& all = surface.subdivision();
  origin_ = all.origin, next_ = all.next, face_ = all.face;
  previous_.resize(next_.size());
  twin_.resize(next_.size());
  for (Index h = 0; h < next_.size(); ++h) previous_[next_[h]] = h, twin_[h] = Subdivision::twin(h);
  loops_.resize(all.face_count());
  for (Index f = 0; f < all.face_count(); ++f) {
    if (all.face_outer[f] != none) loops_[f].push_back(all.face_outer[f]);
    for (const Index h : all.inner_loops(f)) loops_[f].push_back(h);
  }
  contract(surface, tolerance);
  collapse_narrow_faces(surface, tolerance);
}

void Topology::contract(const Surface& surface, double tolerance) {
  std::vector<Index> parent(surface.subdivision().vertex_count);
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (Index e = 0; e < next_.size() / 2; ++e) {
    const bool closed = origin_[2 * e] == origin_[2 * e + 1];
    const bool there_and_back =
        !closed && distance(surface.vertex(origin_[2 * e]), surface.vertex(origin_[2 * e + 1])) <= tolerance;
    if (edge_length(surface, e) > (there_and_back ? std::sqrt(tolerance * surface.radius()) / 10 : tolerance)) continue;
    const Index a = root(origin_[2 * e]), b = root(origin_[2 * e + 1]);
    // A chain of short edges must not carry a vertex along.
    if (distance(surface.vertex(a), surface.vertex(b)) > 2 * tolerance) continue;
    parent[std::max(a, b)] = std::min(a, b);
    unlink(2 * e);
    unlink(2 * e + 1);
  }
  for (Index& v : origin_) v = root(v);
}

/// Takes a half-edge out of its loop, and the loop out of its face if nothing is left of it.
void Topology::unlink(Index h) {
  auto& loops = loops_[face_[h]];
  const auto at = std::find(loops.begin(), loops.end(), h);
  if (next_[h] == h) {
    if (at != loops.end()) loops.erase(at);
  } else {
    if (at != loops.end()) *at = next_[h];
    next_[previous_[h]] = next_[h];
    previous_[next_[h]] = previous_[h];
  }
  next_[h] = previous_[h] = none;
}

void Topology::collapse_narrow_faces(const Surface& surface, double tolerance) {
  // One face that becomes an edge can leave its neighbour between two edges.
  for (bool again = true; again;) {
    again = false;
    for (Index f = 1; f < loops_.size(); ++f) again = collapse(surface, f, tolerance) || again;
  }
  for (Index f = 1; f < loops_.size(); ++f) lost_ += loops_[f].empty() && surface.face_feature(f) != none;
}

bool Topology::collapse(const Surface& surface, Index f, double tolerance) {
  if (loops_[f].size() != 1) return false;
  const Index a = loops_[f][0], b = next_[a];
  if (a == b || next_[b] != a) return false;
  const Index beyond_a = twin_[a], beyond_b = twin_[b];
  if (face_[beyond_a] == face_[beyond_b]) return false;  // what is left would have one face on both sides
  if (distance_to_edge(surface, surface.curve(a / 2, 9), b / 2) > tolerance) return false;
  if (distance_to_edge(surface, surface.curve(b / 2, 9), a / 2) > tolerance) return false;
  loops_[f].clear();
  next_[a] = previous_[a] = next_[b] = previous_[b] = none;
  twin_[beyond_a] = beyond_b, twin_[beyond_b] = beyond_a;
  return true;
}

}  // namespace krepl::solid
