#include "mill/level_lines.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"
#include "mill/touch_normal.hpp"

namespace krepl::mill {
namespace {

using namespace vectors;

class RingMaker {
 public:
  RingMaker(const Surface& surface, const LevelLineOptions& options) : terrain_(surface.terrain()), o_(options) {}

  LevelRing make(std::span<const CutPiece> pieces) const {
    LevelRing ring;
    std::vector<Point3> points;
    for (const CutPiece& piece : pieces) {
      points.assign({piece.start});
      piece.append_points(o_.flatten, points);
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Point p{points[k].x, points[k].y};
        if (!ring.points.empty() && is_near(p, ring.points.back())) continue;
        ring.points.push_back(p);
        ring.is_steep.push_back(is_steep(piece, points[k], points[k + 1]));
      }
    }
    while (ring.points.size() > 1 && is_near(ring.points.front(), ring.points.back()))
      ring.points.pop_back(), ring.is_steep.pop_back();
    if (o_.reversed) ring.reverse();
    return ring;
  }

 private:
  bool is_near(Point p, Point q) const { return std::hypot(p.x - q.x, p.y - q.y) < o_.smallest; }
  bool is_steep(const CutPiece& piece, Point3 a, Point3 b) const {
    if (o_.steep <= 0 || piece.wall || piece.feature == Surface::none) return true;
    return touch_normal(terrain_, piece.feature, 0.5 * (a + b)).z <= std::cos(o_.steep);
  }

  const Terrain& terrain_;
  const LevelLineOptions& o_;
};

/// Rings in the order in which they are cut: each before those inside of it.
std::vector<std::size_t> by_nesting(const Contour& contour) {
  const std::size_t count = contour.ring_count();
  std::vector<std::vector<std::size_t>> inside(count + 1);  // last: outermost ones
  for (std::size_t r = count; r-- > 0;)
    inside[contour.ring_parent[r] == Contour::none ? count : contour.ring_parent[r]].push_back(r);
  std::vector<std::size_t> order, waiting = inside[count];
  while (!waiting.empty()) {
    const std::size_t r = waiting.back();
    waiting.pop_back();
    order.push_back(r);
    waiting.insert(waiting.end(), inside[r].begin(), inside[r].end());
  }
  return order;
}

void start_near(LevelRing& ring, Point at) {
  std::size_t best = 0;
  double nearest = -1;
  for (std::size_t k = 0; k < ring.points.size(); ++k) {
    const double off = std::hypot(ring.points[k].x - at.x, ring.points[k].y - at.y);
    if (nearest < 0 || off < nearest) best = k, nearest = off;
  }
  // Of a ring that is steep in parts, the start of such a part, so that none is cut in two.
  const std::size_t n = ring.points.size();
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t at_k = (best + k) % n;
    if (ring.is_steep[(at_k + n - 1) % n]) continue;
    best = at_k;
    break;
  }
  std::rotate(ring.points.begin(), ring.points.begin() + std::ptrdiff_t(best), ring.points.end());
  std::rotate(ring.is_steep.begin(), ring.is_steep.begin() + std::ptrdiff_t(best), ring.is_steep.end());
}

/// The steep stretches of a ring, or all of it.
void append_steep(const LevelRing& ring, std::vector<LevelLine>& lines) {
  const std::size_t n = ring.points.size();
  for (std::size_t k = 0; k < n;) {
    if (!ring.is_steep[k]) {
      ++k;
      continue;
    }
    LevelLine line{ring.points[k]};
    for (; k < n && ring.is_steep[k]; ++k) line.push_back(ring.points[(k + 1) % n]);
    lines.push_back(std::move(line));
  }
}

}  // namespace

void LevelRing::reverse() {
  std::reverse(points.begin(), points.end());
  std::reverse(is_steep.begin(), is_steep.end());
  // What was the segment from the last point to the first is so again.
  std::rotate(is_steep.begin(), is_steep.begin() + 1, is_steep.end());
}

std::vector<LevelRing> level_rings(const Contour& contour, const Surface& surface, const LevelLineOptions& options) {
  std::vector<LevelRing> rings;
  const RingMaker maker(surface, options);
  for (const std::size_t r : by_nesting(contour)) rings.push_back(maker.make(contour.ring(r)));
  return rings;
}

std::vector<LevelLine> level_lines(std::vector<LevelRing>&& rings, Point& at, std::size_t& skipped) {
  std::vector<LevelLine> lines;
  for (LevelRing& ring : rings) {
    if (ring.points.size() < 3) {
      ++skipped;
      continue;
    }
    start_near(ring, at);
    append_steep(ring, lines);
    if (!lines.empty()) at = lines.back().back();
  }
  return lines;
}

}  // namespace krepl::mill
