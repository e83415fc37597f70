#include "output/polygon_triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/orientation.hpp"

namespace krepl::output {

namespace {

/// Below so many nodes looking at all of them is faster than a grid.
constexpr std::size_t small_polygon = 80;

}  // namespace

PolygonTriangulation::PolygonTriangulation(std::span<const Point> points, std::span<const std::vector<Index>> loops)
    : points_(points) {
  const Index outer = add_loop(loops[0]);
  std::vector<Index> holes;
  for (const std::vector<Index>& loop : loops.subspan(1)) {
    const Index first = add_loop(loop);
    Index leftmost = first;
    for (Index n = nodes_[first].next; n != first; n = nodes_[n].next) {
      const Point p = place(n), q = place(leftmost);
      if (p.x < q.x || (p.x == q.x && p.y < q.y)) leftmost = n;
    }
    holes.push_back(leftmost);
  }
  // From left to right, a bridge to the left meets only what is joined already.
  std::stable_sort(holes.begin(), holes.end(), [&](Index a, Index b) { return place(a).x < place(b).x; });
  for (const Index hole : holes) join_hole(hole, outer);
  clip(outer);
}

PolygonTriangulation::Index PolygonTriangulation::add_loop(const std::vector<Index>& loop) {
  const auto first = Index(nodes_.size()), count = Index(loop.size());
  for (Index i = 0; i < count; ++i)
    nodes_.push_back({loop[i], first + (i + count - 1) % count, first + (i + 1) % count, true});
  return first;
}

int PolygonTriangulation::turn(Index node) const {
  return kernel::orientation(place(nodes_[node].previous), place(node), place(nodes_[node].next));
}

/// A node of the outer loop that the leftmost node of a hole sees: of the side that a ray to the left meets first, or, if
/// something lies in between, of that the one nearest to the ray's direction [Eberly 2002].
PolygonTriangulation::Index PolygonTriangulation::bridge_end(Index hole, Index outer) const {
  const Point h = place(hole);
  double met = -std::numeric_limits<double>::infinity();
  Index best = outer;
  bool found = false;
  Index n = outer;
  do {
    const Index m = nodes_[n].next;
    const Point a = place(n), b = place(m);
    // Sides that run downwards have the polygon's inside on their right.
    if (a.y >= h.y && h.y >= b.y && a.y != b.y) {
      const double x = a.x + (h.y - a.y) / (b.y - a.y) * (b.x - a.x);
      if (x <= h.x && x > met) met = x, best = a.x < b.x ? n : m, found = true;
    }
    n = m;
  } while (n != outer);
  if (!found) return outer;
  const Point p = place(best), ray{met, h.y};
  if (p == ray) return best;
  Index seen = best;
  double least_slope = std::numeric_limits<double>::infinity();
  n = outer;
  do {
    const Point q = place(n);
    const int side = h.y < p.y ? 1 : -1;  // p above the ray: the triangle h, p, ray runs counter-clockwise
    if (q.x < h.x && q.x >= p.x && kernel::orientation(h, p, q) * side >= 0 && kernel::orientation(ray, h, q) * side >= 0) {
      const double slope = std::fabs(q.y - h.y) / (h.x - q.x);
      if (turn(n) <= 0 && (slope < least_slope || (slope == least_slope && q.x > place(seen).x))) least_slope = slope, seen = n;
    }
    n = nodes_[n].next;
  } while (n != outer);
  return seen;
}

void PolygonTriangulation::join_hole(Index hole, Index outer) {
  const Index end = bridge_end(hole, outer);
  const auto hole_again = Index(nodes_.size()), end_again = hole_again + 1;
  const Index before = nodes_[hole].previous, after = nodes_[end].next;
  // end -> hole ... before -> hole again -> end again -> after
  nodes_.push_back({nodes_[hole].point, before, end_again, true});
  nodes_.push_back({nodes_[end].point, hole_again, after, true});
  nodes_[end].next = hole;
  nodes_[hole].previous = end;
  nodes_[before].next = hole_again;
  nodes_[after].previous = end_again;
  if (before == hole) nodes_[hole].next = hole_again, nodes_[hole_again].previous = hole;  // a hole of one vertex
}

std::size_t PolygonTriangulation::grid_cell(double value, double low, double size) const {
  const double cell = (value - low) / size * double(grid_side_);
  return std::size_t(std::clamp(cell, 0.0, double(grid_side_ - 1)));
}

void PolygonTriangulation::build_grid(Index start, std::size_t count) {
  double high_x = place(start).x, high_y = place(start).y;
  grid_x_ = high_x, grid_y_ = high_y;
  for (Index n = nodes_[start].next; n != start; n = nodes_[n].next) {
    const Point p = place(n);
    grid_x_ = std::min(grid_x_, p.x), high_x = std::max(high_x, p.x);
    grid_y_ = std::min(grid_y_, p.y), high_y = std::max(high_y, p.y);
  }
  grid_width_ = std::max(high_x - grid_x_, std::numeric_limits<double>::min());
  grid_height_ = std::max(high_y - grid_y_, std::numeric_limits<double>::min());
  grid_side_ = std::size_t(std::sqrt(double(count))) + 1;
  const auto cell_of = [&](Index n) {
    return grid_cell(place(n).y, grid_y_, grid_height_) * grid_side_ + grid_cell(place(n).x, grid_x_, grid_width_);
  };
  grid_begin_.assign(grid_side_ * grid_side_ + 1, 0);
  for (Index n = 0; n < nodes_.size(); ++n) ++grid_begin_[cell_of(n) + 1];
  for (std::size_t c = 1; c < grid_begin_.size(); ++c) grid_begin_[c] += grid_begin_[c - 1];
  std::vector<Index> fill(grid_begin_.begin(), grid_begin_.end() - 1);
  grid_node_.resize(nodes_.size());
  for (Index n = 0; n < nodes_.size(); ++n) grid_node_[fill[cell_of(n)]++] = n;
}

/// Whether a node keeps an ear from being cut off. Only nodes that are not convex can be the first ones inside.
bool PolygonTriangulation::blocks(Index other, Index ear, Care care) const {
  const Node& e = nodes_[ear];
  if (!nodes_[other].alive || other == ear || other == e.previous || other == e.next) return false;
  const Point a = place(e.previous), b = place(ear), c = place(e.next), p = place(other);
  if (p == a || p == b || p == c || turn(other) > 0) return false;
  const int least = care == Care::strict ? 0 : 1;
  return kernel::orientation(a, b, p) >= least && kernel::orientation(b, c, p) >= least &&
         kernel::orientation(c, a, p) >= least;
}

bool PolygonTriangulation::is_blocked(Index node, Care care) const {
  if (grid_side_ == 0) {
    for (Index n = nodes_[nodes_[node].next].next; n != nodes_[node].previous; n = nodes_[n].next)
      if (blocks(n, node, care)) return true;
    return false;
  }
  const Point a = place(nodes_[node].previous), b = place(node), c = place(nodes_[node].next);
  const std::size_t left = grid_cell(std::min({a.x, b.x, c.x}), grid_x_, grid_width_);
  const std::size_t right = grid_cell(std::max({a.x, b.x, c.x}), grid_x_, grid_width_);
  const std::size_t bottom = grid_cell(std::min({a.y, b.y, c.y}), grid_y_, grid_height_);
  const std::size_t top = grid_cell(std::max({a.y, b.y, c.y}), grid_y_, grid_height_);
  for (std::size_t row = bottom; row <= top; ++row) {
    for (Index i = grid_begin_[row * grid_side_ + left]; i < grid_begin_[row * grid_side_ + right + 1]; ++i)
      if (blocks(grid_node_[i], node, care)) return true;
  }
  return false;
}

bool PolygonTriangulation::is_ear(Index node, Care care) const {
  if (care == Care::any) return true;
  if (turn(node) <= 0) return false;
  return care == Care::turning || !is_blocked(node, care);
}

void PolygonTriangulation::clip(Index start) {
  std::size_t left = 1;
  for (Index n = nodes_[start].next; n != start; n = nodes_[n].next) ++left;
  if (left < 3) return;
  if (left > small_polygon) build_grid(start, left);
  triangles_.reserve(left - 2);
  Care care = Care::strict;
  std::size_t tried = 0;
  for (Index node = start; left > 2;) {
    Node& n = nodes_[node];
    if (!is_ear(node, care)) {
      node = n.next;
      if (++tried < left) continue;
      // None: a vertex may touch a diagonal; beyond that, the polygon is not simple.
      care = Care(int(care) + 1);
      tried = 0;
      continue;
    }
    if (care >= Care::turning && turn(node) != 0) proper_ = proper_ && left == 3 && turn(node) > 0;
    triangles_.push_back({nodes_[n.previous].point, n.point, nodes_[n.next].point});
    n.alive = false;
    nodes_[n.previous].next = n.next;
    nodes_[n.next].previous = n.previous;
    // Going on after the next node keeps ears from forming a fan.
    node = nodes_[n.next].next;
    --left;
    tried = 0;
    care = Care::strict;
  }
}

}  // namespace krepl::output
