#include "mill/valleys.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "mill/touch_normal.hpp"

namespace krepl::mill {
namespace {

using namespace vectors;
using Index = Surface::Index;

constexpr int most_points = 1025;
constexpr double straight_on = -0.5;  // where several valleys meet: turns of up to 60 degrees

/// A valley edge of the subdivision, along its half-edge 2e.
struct Valley {
  Index edge;
  std::vector<Point3> points;
};

double angle_between(Point3 a, Point3 b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

double distance_to_chord(Point3 p, Point3 a, Point3 b) {
  const Point3 d = b - a;
  const double squared = dot(d, d);
  const double s = squared > 0 ? std::clamp(dot(p - a, d) / squared, 0.0, 1.0) : 0;
  return distance(p, a + s * d);
}

class EdgeCurves {
 public:
  EdgeCurves(const Surface& surface, const DropCutter& foot, const ValleyOptions& options)
      : surface_(surface), foot_(foot), o_(options) {}

  /// No points if the edge is no valley.
  std::vector<Point3> points(Index e) const {
    const Surface::Edge edge = surface_.edge(e);
    if (edge.kind == Surface::EdgeKind::seam || !is_sharp(e, edge)) return {};
    std::vector<Point3> points;
    // Three points of a curve may lie on a line by chance.
    for (int count = edge.curve == Surface::Curve::line && edge.kind == Surface::EdgeKind::valley ? 3 : 5;;
         count = 2 * count - 1) {
      points = surface_.curve(e, count);
      if (edge.kind == Surface::EdgeKind::rim && !lower(points)) return {};
      if (count >= most_points || is_close(points)) return points;
    }
  }

 private:
  bool is_sharp(Index e, const Surface::Edge& edge) const {
    const Point3 middle = surface_.curve(e, 3)[1];
    const Terrain& terrain = surface_.terrain();
    if (edge.kind == Surface::EdgeKind::valley)
      return angle_between(touch_normal(terrain, edge.feature[0], middle),
                           touch_normal(terrain, edge.feature[1], middle)) >= o_.angle;
    const Index upper = edge.feature[0] == Surface::none ? edge.feature[1] : edge.feature[0];
    const DropCutter::Contact below = foot_.at({middle.x, middle.y});
    if (upper == Surface::none || !below.touches()) return false;
    return angle_between(Point3{middle.x, middle.y, below.height} - below.point,
                         touch_normal(terrain, upper, middle)) >= o_.angle;
  }
  /// From the rim down to where the ball rests at the wall's foot. False if there is nothing.
  bool lower(std::vector<Point3>& points) const {
    for (Point3& p : points) {
      const DropCutter::Contact below = foot_.at({p.x, p.y});
      if (!below.touches()) return false;
      p.z = below.height;
    }
    return true;
  }
  bool is_close(const std::vector<Point3>& points) const {
    for (std::size_t i = 1; i + 1 < points.size(); i += 2)
      if (distance_to_chord(points[i], points[i - 1], points[i + 1]) > o_.flatten) return false;
    return true;
  }

  const Surface& surface_;
  const DropCutter& foot_;
  const ValleyOptions& o_;
};

/// Joins valleys at vertices. End 2k is the start of valley k, 2k + 1 its end.
class ChainMaker {
 public:
  ChainMaker(const Surface& surface, const std::vector<Valley>& valleys)
      : surface_(surface), valleys_(valleys), mate_(2 * valleys.size(), Surface::none), used_(valleys.size(), 0) {}

  std::vector<std::vector<Point3>> run() {
    pair_ends();
    std::vector<std::vector<Point3>> chains;
    for (std::size_t end = 0; end < mate_.size(); ++end)
      if (mate_[end] == Surface::none && !used_[end / 2]) chains.push_back(walk(end));
    for (std::size_t k = 0; k < valleys_.size(); ++k)  // closed ones
      if (!used_[k]) chains.push_back(walk(2 * k));
    return chains;
  }

 private:
  Index vertex(std::size_t end) const {
    return surface_.subdivision().origin[2 * valleys_[end / 2].edge + Index(end % 2)];
  }
  /// Of the valley as it leaves its end.
  Point3 direction(std::size_t end) const {
    const std::vector<Point3>& p = valleys_[end / 2].points;
    const Point3 way = end % 2 == 0 ? p[1] - p[0] : p[p.size() - 2] - p.back();
    const double size = length(way);
    return size > 0 ? (1 / size) * way : Point3{0, 0, 0};
  }
  void pair_ends() {
    std::vector<std::size_t> ends(mate_.size());
    for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = k;
    std::stable_sort(ends.begin(), ends.end(), [&](std::size_t a, std::size_t b) { return vertex(a) < vertex(b); });
    for (std::size_t first = 0, last; first < ends.size(); first = last) {
      last = first;
      while (last < ends.size() && vertex(ends[last]) == vertex(ends[first])) ++last;
      pair_at_vertex({ends.begin() + std::ptrdiff_t(first), ends.begin() + std::ptrdiff_t(last)});
    }
  }
  void pair_at_vertex(std::vector<std::size_t> ends) {
    if (ends.size() == 2) {
      mate_[ends[0]] = Index(ends[1]), mate_[ends[1]] = Index(ends[0]);
      return;
    }
    while (ends.size() > 1) {
      std::size_t a = 0, b = 0;
      double best = straight_on;
      for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t j = i + 1; j < ends.size(); ++j)
          if (const double turn = dot(direction(ends[i]), direction(ends[j])); turn < best) best = turn, a = i, b = j;
      if (a == b) return;
      mate_[ends[a]] = Index(ends[b]), mate_[ends[b]] = Index(ends[a]);
      ends.erase(ends.begin() + std::ptrdiff_t(b)), ends.erase(ends.begin() + std::ptrdiff_t(a));
    }
  }
  std::vector<Point3> walk(std::size_t end) {
    std::vector<Point3> chain;
    while (!used_[end / 2]) {
      used_[end / 2] = 1;
      std::vector<Point3> p = valleys_[end / 2].points;
      if (end % 2 == 1) std::reverse(p.begin(), p.end());
      chain.insert(chain.end(), p.begin() + (chain.empty() || !(chain.back() == p.front()) ? 0 : 1), p.end());
      const Index next = mate_[end ^ 1u];
      if (next == Surface::none) break;
      end = next;
    }
    return chain;
  }

  const Surface& surface_;
  const std::vector<Valley>& valleys_;
  std::vector<Index> mate_;
  std::vector<char> used_;
};

}  // namespace

bool find_valleys(const Surface& surface, const DropCutter& foot, const ValleyOptions& options, const Context& context,
                  Valleys& valleys) {
  const EdgeCurves curves(surface, foot, options);
  constexpr std::size_t block = 1024;
  const std::size_t count = surface.subdivision().half_edge_count() / 2;
  std::vector<std::vector<Valley>> found((count + block - 1) / block);
  const bool done = kernel::parallel_blocks(context, count, block, [&](std::size_t first, std::size_t last) {
    for (std::size_t e = first; e < last; ++e)
      if (std::vector<Point3> points = curves.points(Index(e)); points.size() > 1)
        found[first / block].push_back({Index(e), std::move(points)});
  });
  if (!done) return false;
  std::vector<Valley> all;
  for (auto& part : found)
    for (Valley& v : part) all.push_back(std::move(v));
  valleys.edges = all.size();
  for (std::vector<Point3>& chain : ChainMaker(surface, all).run()) {
    double size = 0;
    for (std::size_t k = 1; k < chain.size(); ++k) size += distance(chain[k - 1], chain[k]);
    if (size < options.shortest)
      ++valleys.too_short;
    else
      valleys.chains.push_back(std::move(chain));
  }
  return true;
}

}  // namespace krepl::mill
