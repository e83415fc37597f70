#include <algorithm>
#include <cmath>

#include "kernel/parallel.hpp"
#include "zone/crossing.hpp"
#include "zone/rings.hpp"

namespace krepl::zone {
namespace {

double distance(Point p, Point q) { return length(Vector<double>{p.x - q.x, p.y - q.y}); }

/// One ring while it is being contracted: a doubly linked list, so that contracting k of n pieces costs O(n + k).
struct Chain {
  std::vector<Index> element, before, after;
  std::vector<Index> from, to;  // the elements that a piece's ends were first found on
  std::vector<Point> vertex;
  std::vector<Point> end;  // of the piece, before anything after it was contracted
  Index count = 0;
  Index head = 0;

  Chain(const Rings& rings, Index first, Index last)
      : element(rings.element.begin() + first, rings.element.begin() + last),
        vertex(rings.vertex.begin() + first, rings.vertex.begin() + last),
        count(last - first) {
    before.resize(count);
    after.resize(count);
    for (Index i = 0; i < count; ++i) {
      before[i] = i == 0 ? count - 1 : i - 1;
      after[i] = i + 1 == count ? 0 : i + 1;
    }
    from.resize(count);
    to.resize(count);
    for (Index i = 0; i < count; ++i) {
      from[i] = element[before[i]];
      to[i] = element[after[i]];
    }
    end.resize(count);
    for (Index i = 0; i < count; ++i) end[i] = vertex[after[i]];
  }
  /// Drops piece i and its first vertex; the piece before it runs on to the one after it.
  void erase(Index i) {
    after[before[i]] = after[i];
    before[after[i]] = before[i];
    if (i == head) head = after[i];
    --count;
  }
};

class Contraction {
 public:
  Contraction(const Instance& instance, double resolution) : in_(instance), resolution_(resolution) {}

  /// Rings that need nothing, nearly all of them, are told by one pass.
  bool needs_work(const Rings& rings, Index ring) const {
    const Index first = rings.begin[ring], last = rings.begin[ring + 1];
    if (last - first < 3) return true;
    for (Index e = first; e < last; ++e) {
      const Index n = rings.next(ring, e), m = rings.next(ring, n);
      if (rings.element[e] == rings.element[n]) return true;
      const double chord = distance(rings.vertex[n], rings.vertex[m]);
      if (chord <= resolution_ || (rings.element[e] == rings.element[m] && strays_little(chord, rings.element[e], rings.element[n]))) return true;
    }
    return false;
  }

  /// The number of pieces contracted.
  std::uint64_t run(Chain& c) const {
    std::uint64_t collapsed = 0;
    Index settled = 0;  // pieces in a row up to i that need nothing
    for (Index i = c.head; settled < c.count && c.count > 1;) {
      if (step(c, i, collapsed)) {  // only the neighbourhood has to be looked at again
        i = c.before[c.before[c.before[i]]];
        settled = settled > 3 ? settled - 3 : 0;
      } else {
        i = c.after[i];
        ++settled;
      }
    }
    return collapsed;
  }

  /// True if the ring encloses nothing that the coordinates can tell.
  bool is_thin(const Chain& c) const {
    if (c.count == 1) {  // all but full circles
      const Index e = c.element[c.head];
      return (c.from[c.head] != e || c.to[c.head] != e) && !is_long(c, c.head);
    }
    double area = 0, perimeter = 0, across = 0;
    Index i = c.head;
    do {
      const Point p = c.vertex[i], q = c.vertex[c.after[i]];
      area += twice_area(in_, c.element[i], p, q, c.vertex[c.head]);
      perimeter += distance(p, q);
      across = std::max({across, distance(p, c.vertex[c.head]), is_long(c, i) ? in_.nominal_radius_of(c.element[i]) : 0.0});
      i = c.after[i];
    } while (i != c.head);
    return across <= 8 * resolution_ || std::abs(area) <= resolution_ * perimeter;
  }

 private:
  /// An arc or line between two points of another piece's element, `chord` apart, is within the resolution of it.
  bool strays_little(double chord, Index e, Index other) const {
    return chord * chord <= 4 * std::min(in_.radius_of(e), in_.radius_of(other)) * resolution_;
  }

  bool step(Chain& c, Index i, std::uint64_t& collapsed) const {
    const Index before = c.before[i], after = c.after[i];
    if (c.element[before] == c.element[i]) {  // a full circle's start, or what a contraction left
      c.to[before] = c.to[i];
      c.end[before] = c.end[i];
      c.erase(i);
      return true;
    }
    const double chord = distance(c.vertex[i], c.vertex[after]);
    const bool tiny = chord <= resolution_;
    const bool bump = c.count > 2 && c.element[before] == c.element[after] && strays_little(chord, c.element[before], c.element[i]);
    if ((!tiny && !bump) || is_long(c, i)) return false;
    // Many short pieces in a row must not carry the end of the one before them along.
    if (!bump && chord > 0 && distance(c.end[before], c.vertex[after]) > 4 * resolution_) return false;
    c.erase(i);
    ++collapsed;
    return true;
  }

  bool is_long(const Chain& c, Index i) const {
    const Index e = c.element[i];
    if (in_.is_side(e) || in_.sector(in_.vertex_of(e)).before != e) return false;  // at most half a circle
    return is_long_arc(in_, c.from[i], e, c.to[i]);
  }

  const Instance& in_;
  double resolution_;
};

}  // namespace

double twice_area(const Instance& in, Index element, Point p, Point q, Point base) {
  const double ax = p.x - base.x, ay = p.y - base.y, bx = q.x - base.x, by = q.y - base.y;
  const double triangle = ax * by - ay * bx;
  if (in.is_side(element)) return triangle;
  const Point c = in.vertices()[in.vertex_of(element)];
  const double ux = p.x - c.x, uy = p.y - c.y, vx = q.x - c.x, vy = q.y - c.y;
  double angle = std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
  if (p == q) angle = 2 * M_PI;
  // Arcs run counter-clockwise; only those of isolated vertices exceed a half circle, others may be a shade below zero.
  else if (angle < 0) angle = in.sector(in.vertex_of(element)).before == element || angle < -1 ? angle + 2 * M_PI : 0;
  const double r = in.nominal_radius_of(element);
  return triangle + r * r * (angle - std::sin(angle));
}

Rings contract(const Instance& instance, Rings rings, double resolution, const Context& context,
               ZoneCounters& counters) {
  const Contraction contraction(instance, resolution);
  const Index count = Index(rings.ring_count());
  std::vector<Index> length(count);  // of each ring afterwards; its pieces are kept at its old place
  std::vector<std::uint64_t> collapsed(count, 0);
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, count, 1, [&](std::size_t r, std::size_t) {
    const Index first = rings.begin[r], last = rings.begin[r + 1];
    length[r] = last - first;
    if (!contraction.needs_work(rings, Index(r))) return;
    Chain chain(rings, first, last);
    collapsed[r] = contraction.run(chain);
    length[r] = contraction.is_thin(chain) ? 0 : chain.count;
    Index to = first, i = chain.head;
    for (Index left = length[r]; left > 0; --left, ++to, i = chain.after[i]) {
      rings.element[to] = chain.element[i];
      rings.vertex[to] = chain.vertex[i];
    }
  });
  Index to = 0;  // rings are moved down in place
  std::vector<Index> begin{0};
  for (Index r = 0; r < count; ++r) {
    counters.collapsed_pieces += collapsed[r];
    if (length[r] == 0) {
      ++counters.dropped_rings;
      continue;
    }
    const Index first = rings.begin[r];
    if (first != to) {
      std::copy_n(rings.element.begin() + first, length[r], rings.element.begin() + to);
      std::copy_n(rings.vertex.begin() + first, length[r], rings.vertex.begin() + to);
    }
    begin.push_back(to += length[r]);
  }
  rings.element.resize(to);
  rings.vertex.resize(to);
  rings.begin = std::move(begin);
  return rings;
}

}  // namespace krepl::zone
