#include "support/surface_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

#include "support/ball_oracle.hpp"

namespace krepl::test {

namespace {

using Index = Surface::Index;
constexpr Index none = Surface::none;
/// Places along a tangent are known badly, but balls there touch all the better: to this share of the tolerance.
constexpr double exact = 0.5;

std::string at(Point3 p) {
  char buffer[100];
  std::snprintf(buffer, sizeof buffer, " at (%.12g, %.12g, %.12g)", p.x, p.y, p.z);
  return buffer;
}
double distance(Point3 p, Point3 q) { return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z); }

/// Half-edges of a surface from one vertex that means something to the next.
struct Chain {
  std::vector<Index> half_edges;
  Index from, to;  // vertices; none for a closed one without any
  Index left, right;
  Surface::EdgeKind kind;
  std::optional<Surface::Curve> curve;  // none: a wall too low to be one, whose plan says nothing
};

/// A surface's half-edges without those that are too short to mean anything, joined to chains.
class Reduced {
 public:
  Reduced(const Surface& surface, double tolerance, bool up_to_tangency)
      : surface_(surface),
        topology_(surface.subdivision()),
        origin_(topology_.origin),
        next_(topology_.next),
        previous_(next_.size()),
        tangent_(4 * std::sqrt(tolerance * std::max(surface.radius(), surface.terrain().extent()))) {
    const auto count = Index(next_.size());
    for (Index h = 0; h < count; ++h) previous_[next_[h]] = h;
    vertex_.resize(topology_.vertex_count);
    std::iota(vertex_.begin(), vertex_.end(), Index{0});
    face_.resize(topology_.face_count());
    std::iota(face_.begin(), face_.end(), Index{0});
    alive_.assign(count, true);
    ends_.resize(topology_.vertex_count);
    for (Index h = 0; h < count; ++h) ends_[topology_.origin[h]].push_back(h);
    for (Index v = 0; v < topology_.vertex_count; ++v) place_.push_back(surface.vertex(v));
    for (Index e = 0; e < count / 2; ++e) contract_if_short(e, tolerance, up_to_tangency);
    out_.resize(topology_.vertex_count);
    for (Index h = 0; h < count; ++h) {
      if (alive_[h]) out_[origin(h)].push_back(h);
    }
    settle_low_walls(tolerance);
    for (Index v = 0; v < topology_.vertex_count; ++v) part_if_touching(v);
    chain_of_.assign(count, none);
    for (Index h = 0; h < count; ++h) {
      if (alive_[h] && is_kept(origin(h))) add(h);
    }
    for (Index h = 0; h < count; ++h) {
      if (alive_[h] && chain_of_[h] == none) add(h);  // closed, and met nowhere
    }
  }

  const Surface& surface() const { return surface_; }
  int contracted() const { return contracted_; }
  Index origin(Index h) const { return find(origin_[h]); }
  Index face(Index h) const { return root(face_, topology_.face[h]); }
  bool is_kept(Index v) const {
    const auto& out = out_[v];
    return !out.empty() && (out.size() != 2 || !same(out[0] ^ 1u, out[1]));
  }
  const Chain& chain(Index h) const { return chains_[chain_of_[h]]; }
  const std::vector<Chain>& chains() const { return chains_; }
  Index feature(Index h) const { return surface_.face_feature(topology_.face[h]); }

  Point3 place(Index v) const { return place_[v]; }

  /// A ball about p touches what balls touch beside the vertex, at seams at one place, within the tolerance. What meets
  /// a wall there may do so further down than the vertex, but not all of it.
  bool touches(Index v, Point3 p, double tolerance) const {
    bool top = false;
    for (const Index h : ends_[v]) {
      const auto edge = surface_.edge(h / 2);
      const bool wall = edge.kind == Surface::EdgeKind::rim, below = end_of(h).z < place_[v].z - tolerance;
      const LongPoint c{p.x, p.y, p.z};
      if (below && !wall ? !touches_below(h, p, tolerance) : !touches(edge, c, tolerance)) return false;
      // Where a wall begins, balls touch at their own height.
      if (wall && !below && std::fabs(double(foot(upper(edge), c).z - c.z)) > tolerance) return false;
      top = top || !below;
    }
    return top;
  }

  /// Half-edges out of a vertex, counter-clockwise.
  std::vector<Index> around(Index v) const {
    std::vector<Index> turn;
    Index h = out_[v][0];
    do {
      turn.push_back(h);
      h = previous_[h] ^ 1u;
    } while (h != out_[v][0] && turn.size() <= out_[v].size());
    return turn;
  }

  /// Loops of each face.
  std::map<Index, int> loops() const {
    std::map<Index, int> count;
    std::vector<bool> seen(next_.size(), false);
    for (Index h = 0; h < next_.size(); ++h) {
      if (!alive_[h] || seen[h]) continue;
      ++count[face(h)];
      for (Index g = h; !seen[g]; g = next_[g]) seen[g] = true;
    }
    return count;
  }

  Point3 middle(const Chain& c) const {
    const Index h = c.half_edges[c.half_edges.size() / 2];
    return surface_.curve(h / 2, 3)[1];
  }

 private:
  static Index root(const std::vector<Index>& joined, Index i) {
    while (joined[i] != i) i = joined[i];
    return i;
  }
  static Index upper(const Surface::Edge& rim) { return rim.feature[0] != none ? rim.feature[0] : rim.feature[1]; }
  /// Where a ball touches the feature's point, line or plane.
  LongPoint foot(Index f, LongPoint c) const { return foot(surface_.terrain().corners(f), c); }
  static LongPoint foot(const Terrain::Corners& k, LongPoint c) {
    const auto vector = [&](int i) {
      return LongPoint{Long(k.point[i].x) - k.point[0].x, Long(k.point[i].y) - k.point[0].y,
                       Long(k.point[i].z) - k.point[0].z};
    };
    const auto dot = [](LongPoint v, LongPoint w) { return v.x * w.x + v.y * w.y + v.z * w.z; };
    const LongPoint at{k.point[0].x, k.point[0].y, k.point[0].z}, off{c.x - at.x, c.y - at.y, c.z - at.z};
    if (k.count == 1) return at;
    const LongPoint d = vector(1);
    if (k.count == 2) {
      const Long s = dot(off, d) / dot(d, d);
      return {at.x + s * d.x, at.y + s * d.y, at.z + s * d.z};
    }
    const LongPoint e = vector(2), n{d.y * e.z - d.z * e.y, d.z * e.x - d.x * e.z, d.x * e.y - d.y * e.x};
    const Long s = dot(off, n) / dot(n, n);
    return {c.x - s * n.x, c.y - s * n.y, c.z - s * n.z};
  }
  bool touches(const Surface::Edge& edge, LongPoint c, double tolerance) const {
    if (edge.kind == Surface::EdgeKind::rim)  // upright: at whatever height
      return std::fabs(double(wall_excess(upper(edge), c))) <= tolerance;
    const auto touched = [&](Index f) { return std::fabs(double(excess(f, c))) <= tolerance; };
    if (!touched(edge.feature[0]) || !touched(edge.feature[1])) return false;
    const LongPoint q = foot(edge.feature[0], c), r = foot(edge.feature[1], c);
    return edge.kind != Surface::EdgeKind::seam || std::hypot(q.x - r.x, q.y - r.y, q.z - r.z) <= 4 * tolerance;
  }
  Point3 end_of(Index h) const {
    const auto points = surface_.curve(h / 2, 3);
    return h % 2 == 0 ? points.front() : points.back();
  }
  /// Straight below p, too, there is a ball that touches both features of such an edge. It is found by the one that
  /// rises less steeply.
  bool touches_below(Index h, Point3 p, double tolerance) const {
    const auto feature = surface_.edge(h / 2).feature;
    LongPoint c{p.x, p.y, end_of(h).z};
    const auto nearest = [&](Index f) { return nearest_on(surface_.terrain().corners(f), c); };
    const Index flatter = nearest(feature[0]).at.z < nearest(feature[1]).at.z ? feature[0] : feature[1];
    c.z += surface_.radius();  // the distance is convex in z, so Newton's method comes down to the highest place
    for (int i = 0; i < 60; ++i) {
      const Nearest n = nearest(flatter);
      if (c.z - n.at.z < tolerance / 1024) break;
      c.z = std::max(n.at.z, c.z + (surface_.radius() - n.distance) * n.distance / (c.z - n.at.z));
    }
    return touches(surface_.edge(h / 2), c, tolerance);
  }
  Index find(Index v) const { return root(vertex_, v); }
  /// True if the edge is a valley and a wall at once within the tolerance: a wall at the top of which the ball touches what is
  /// below it, too; a valley all along the place where one of its features ends in a wall.
  bool is_low_wall(Index e, double tolerance) const {
    const auto edge = surface_.edge(e);
    if (edge.kind == Surface::EdgeKind::seam) return false;
    const std::vector<Point3> points = surface_.curve(e, 9);
    const auto at_all = [&](auto&& off) {
      return std::ranges::all_of(points, [&](Point3 p) { return std::fabs(double(off(LongPoint{p.x, p.y, p.z}))) <= tolerance * exact; });
    };
    if (edge.kind == Surface::EdgeKind::rim) {
      const Index below = feature(edge.feature[0] == none ? 2 * e : 2 * e + 1);
      return below != none && at_all([&](LongPoint c) { return excess(below, c); });
    }
    return std::ranges::any_of(edge.feature, [&](Index f) {
      return f != none && at_all([&](LongPoint c) { return wall_excess(f, c); }) &&
             std::ranges::all_of(points, [&](Point3 p) { return std::fabs(double(foot(f, {p.x, p.y, p.z}).z - p.z)) <= 4 * tangent_; });
    });
  }
  /// By how much a ball's centre is too far from a feature to touch it.
  Long excess(Index f, LongPoint c) const {
    return nearest_on(surface_.terrain().corners(f), c).distance - surface_.radius();
  }
  /// The same in the plane, of the feature's walls.
  Long wall_excess(Index f, LongPoint c) const {
    Terrain::Corners flat = surface_.terrain().corners(f);
    for (Point3& p : flat.point) p.z = double(c.z);
    const LongPoint q = foot(flat, c);
    return std::hypot(q.x - c.x, q.y - c.y) - surface_.radius();
  }
  /// An edge that is both is what goes on from it is, or else a valley.
  void settle_low_walls(double tolerance) {
    const auto count = Index(next_.size());
    for (Index e = 0; e < count / 2; ++e) {
      kind_.push_back(surface_.edge(e).kind);
      is_low_.push_back(alive_[2 * e] && is_low_wall(e, tolerance));
    }
    for (Index e = 0; e < count / 2; ++e) {
      if (!is_low_[e]) continue;
      std::optional<Surface::EdgeKind> found;
      bool one = true;
      for (Index h : {2 * e, 2 * e + 1}) {
        for (Index steps = 0; is_low_[h / 2] && steps < count; ++steps) {
          const auto& out = out_[origin(h)];
          if (out.size() != 2) break;
          const Index before = (out[0] == h ? out[1] : out[0]) ^ 1u;
          if (feature(before) != feature(h) || feature(before ^ 1u) != feature(h ^ 1u)) break;
          h = before;
        }
        if (is_low_[h / 2]) continue;
        const auto kind = surface_.edge(h / 2).kind;
        one = one && (!found || *found == kind);
        found = kind;
      }
      if (one) kind_[e] = found.value_or(Surface::EdgeKind::valley);
    }
  }
  /// If both ends are the same place but for what cannot be told where curves are tangent, and it stays near.
  void contract_if_short(Index e, double tolerance, bool up_to_tangency) {
    const auto points = surface_.curve(e, 9);
    const auto off = [&](Point3 p) { return std::hypot(p.x - points[0].x, p.y - points[0].y); };
    if (!std::all_of(points.begin(), points.end(), [&](Point3 p) { return off(p) <= tangent_; })) return;
    const Index v = find(topology_.origin[2 * e]), w = find(topology_.origin[2 * e + 1]);
    const bool same = off(points.back()) <= tolerance;
    if (!same && !up_to_tangency) return;
    // One may be at the foot of a wall, the other further up.
    const bool wall = std::fabs(place_[v].z - place_[w].z) > 4 * tangent_;
    const auto moved = [&](Index from, Index to) {
      return Point3{place_[to].x, place_[to].y, place_[wall ? from : to].z};
    };
    if (touches(w, moved(w, v), tolerance * exact))
      contract(e, v, w);
    else if (touches(v, moved(v, w), tolerance * exact))
      contract(e, w, v);
    else if (same)
      contract(e, v, w);
  }
  void contract(Index e, Index kept, Index gone) {
    ++contracted_;
    vertex_[gone] = kept;
    if (kept != gone) ends_[kept].insert(ends_[kept].end(), ends_[gone].begin(), ends_[gone].end());
    // The kept one may lie at the foot of a wall, on which the place along a tangent matters.
    if (place_[gone].z > place_[kept].z + 4 * tangent_) place_[kept].z = place_[gone].z;
    for (const Index h : {2 * e, 2 * e + 1}) {
      next_[previous_[h]] = next_[h];
      previous_[next_[h]] = previous_[h];
      alive_[h] = false;
    }
  }
  /// Where one edge touches another from within a face, what goes on as itself on either side of the vertex gets a
  /// vertex of its own.
  void part_if_touching(Index v) {
    if (out_[v].size() != 4) return;
    std::vector<Index> turn = around(v);
    if (turn.size() != 4) return;
    for (int i = 0; i < 2; ++i, std::rotate(turn.begin(), turn.begin() + 1, turn.end())) {
      const bool pass = same(turn[1] ^ 1u, turn[2]) && same(turn[3] ^ 1u, turn[0]);
      if (!pass || feature(turn[0]) != feature(turn[2]) || feature(turn[1]) == feature(turn[3])) continue;
      face_[face(turn[0])] = face(turn[2]);
      for (const auto& [h, after] : {std::pair(turn[1], turn[2]), std::pair(turn[3], turn[0])}) {
        previous_[after] = h ^ 1u;
        next_[h ^ 1u] = after;
      }
      const auto apart = Index(vertex_.size());
      vertex_.push_back(apart);
      for (const Index h : {turn[1], turn[2]}) origin_[h] = apart;
      out_[v] = {turn[3], turn[0]};
      out_.push_back({turn[1], turn[2]});
      return;
    }
  }
  bool same(Index h, Index after) const {
    return kind_[h / 2] == kind_[after / 2] && feature(h) == feature(after) && feature(h ^ 1u) == feature(after ^ 1u);
  }
  void add(Index h) {
    if (chain_of_[h] != none) return;
    Chain c;
    c.left = feature(h), c.right = feature(h ^ 1u);
    c.kind = kind_[h / 2], c.curve = surface_.edge(h / 2).curve;
    Index g = h;
    for (;;) {
      c.half_edges.push_back(g);
      if (is_low_[g / 2]) c.curve = std::nullopt;
      chain_of_[g] = Index(chains_.size());
      const Index end = origin(g ^ 1u);
      if (is_kept(end)) break;
      g = out_[end][0] == (g ^ 1u) ? out_[end][1] : out_[end][0];
      if (g == h) break;
    }
    const bool open = is_kept(origin(h));
    c.from = open ? origin(h) : none;
    c.to = open ? origin(c.half_edges.back() ^ 1u) : none;
    chains_.push_back(std::move(c));
  }

  const Surface& surface_;
  const Subdivision& topology_;
  std::vector<Index> origin_, next_, previous_;
  double tangent_;                    // where curves are tangent, they are told apart from so far on
  std::vector<Index> vertex_, face_;  // with which one each is one
  std::vector<bool> alive_, is_low_;
  std::vector<Surface::EdgeKind> kind_;  // of each edge
  std::vector<std::vector<Index>> ends_;  // half-edges that begin in each vertex
  std::vector<Point3> place_;             // of each vertex, at the height of its uppermost edge
  std::vector<std::vector<Index>> out_;
  std::vector<Index> chain_of_;
  std::vector<Chain> chains_;
  int contracted_ = 0;
};

class Comparer {
 public:
  Comparer(const Surface& first, const Surface& second, double tolerance, bool up_to_tangency)
      : a_(first, tolerance, up_to_tangency),
        b_(second, tolerance, up_to_tangency),
        tolerance_(tolerance),
        up_to_tangency_(up_to_tangency) {
    result_.up_to_tangency = up_to_tangency;
    result_.short_edges = {a_.contracted(), b_.contracted()};
  }

  Comparison run() {
    result_.difference = difference();
    return result_;
  }

 private:
  std::optional<std::string> difference() {
    if (auto d = pair_vertices()) return d;
    for (Index v = 0; v < partner_.size(); ++v) {
      if (partner_[v] == none) continue;
      if (auto d = compare_around(v)) return d;
    }
    if (auto d = pair_closed()) return d;
    return compare_faces();
  }

  static std::vector<Index> kept(const Reduced& r) {
    std::vector<Index> all;
    for (Index v = 0; v < r.surface().subdivision().vertex_count; ++v) {
      if (r.is_kept(v)) all.push_back(v);
    }
    return all;
  }

  std::optional<std::string> pair_vertices() {
    const std::vector<Index> first = kept(a_), second = kept(b_);
    partner_.assign(a_.surface().subdivision().vertex_count, none);
    std::vector<bool> used(b_.surface().subdivision().vertex_count, false);
    for (const Index v : first) {
      double least = std::numeric_limits<double>::infinity();
      Index best = none;
      for (const Index w : second) {
        const double d = distance(a_.place(v), b_.place(w));
        if (!used[w] && d < least) least = d, best = w;
      }
      if (up_to_tangency_ && best != none && least > tolerance_ && are_tangent(v, best)) {
        ++result_.tangent_vertices;
      } else if (!(least <= tolerance_)) {
        return "only the first has a vertex" + at(a_.place(v)) +
               (best == none
                    ? ""
                    : "; the nearest of the second is off by " + std::to_string(std::log10(least)) + " (log10)") +
               "; around it:" + text_around(a_, v);
      }
      partner_[v] = best;
      used[best] = true;
    }
    for (const Index w : second) {
      if (!used[w]) return "only the second has a vertex" + at(b_.place(w)) + "; around it:" + text_around(b_, w);
    }
    return std::nullopt;
  }

  /// Both vertices are at distance R from all features around the other one, but for the tolerance.
  bool are_tangent(Index v, Index w) const {
    return a_.touches(v, b_.place(w), tolerance_ * exact) && b_.touches(w, a_.place(v), tolerance_ * exact);
  }
  struct Spoke {
    Index left, right, other_end;
    Surface::EdgeKind kind;
    std::optional<Surface::Curve> curve;
    bool operator==(const Spoke& other) const {
      return left == other.left && right == other.right && other_end == other.other_end && kind == other.kind && are_alike(curve, other.curve);
    }
  };
  static bool are_alike(std::optional<Surface::Curve> a, std::optional<Surface::Curve> b) { return !a || !b || *a == *b; }
  Spoke spoke(const Reduced& r, Index h, bool map) const {
    const Chain& c = r.chain(h);
    return {c.left, c.right, map ? partner_[c.to] : c.to, c.kind, c.curve};
  }

  std::string text_around(const Reduced& r, Index v) const {
    std::string text;
    for (const Index h : r.around(v)) {
      const Spoke s = spoke(r, h, false);
      text += " " + std::to_string(int(s.left)) + "|" + std::to_string(int(s.right)) + " kind " + std::to_string(int(s.kind)) +
              " curve " + (s.curve ? std::to_string(int(*s.curve)) : "any") + " to" + at(r.place(s.other_end)) + ",";
    }
    return text;
  }

  std::optional<std::string> compare_around(Index v) {
    const std::vector<Index> a = a_.around(v), b = b_.around(partner_[v]);
    if (a.size() != b.size()) {
      return "degrees " + std::to_string(a.size()) + " and " + std::to_string(b.size()) + at(a_.place(v));
    }
    for (std::size_t shift = 0; shift < b.size(); ++shift) {
      bool equal = true;
      for (std::size_t i = 0; i < a.size() && equal; ++i) {
        equal = spoke(a_, a[i], true) == spoke(b_, b[(i + shift) % b.size()], false);
      }
      if (!equal) continue;
      for (std::size_t i = 0; i < a.size(); ++i) pair_faces(a[i], b[(i + shift) % b.size()]);
      return std::nullopt;
    }
    return "edges differ around the vertex" + at(a_.place(v)) + ":" + text_around(a_, v) + " /" + text_around(b_, partner_[v]);
  }

  std::optional<std::string> pair_closed() {
    std::vector<bool> used(b_.chains().size(), false);
    std::size_t count = 0, others = 0;
    for (const Chain& c : b_.chains()) others += c.from == none;
    for (const Chain& c : a_.chains()) {
      if (c.from != none) continue;
      ++count;
      const Point3 p = a_.middle(c);
      bool found = false;
      for (std::size_t k = 0; k < b_.chains().size() && !found; ++k) {
        const Chain& d = b_.chains()[k];
        if (d.from != none || used[k] || d.left != c.left || d.right != c.right || d.kind != c.kind ||
            !are_alike(d.curve, c.curve))
          continue;
        // The labels tell the curve; which component of it, the places.
        double least = std::numeric_limits<double>::infinity(), longest = 0;
        for (const Index h : d.half_edges) {
          const auto points = b_.surface().curve(h / 2, 257);
          for (std::size_t i = 0; i < points.size(); ++i) {
            least = std::min(least, distance(p, points[i]));
            if (i > 0) longest = std::max(longest, distance(points[i - 1], points[i]));
          }
        }
        if (least > longest) continue;
        found = used[k] = true;
        pair_faces(c.half_edges[0], d.half_edges[0]);
      }
      if (!found) return "only the first has a closed edge" + at(p);
    }
    if (count != others) return std::to_string(count) + " and " + std::to_string(others) + " closed half-edges";
    return std::nullopt;
  }

  void pair_faces(Index h, Index g) {
    for (const Index twin : {0u, 1u}) {
      const Index f = a_.face(h ^ twin), e = b_.face(g ^ twin);
      mismatch_ = mismatch_ || (face_.contains(f) && face_[f] != e) || (face_back_.contains(e) && face_back_[e] != f);
      face_[f] = e;
      face_back_[e] = f;
    }
  }

  std::optional<std::string> compare_faces() {
    if (mismatch_) return "faces do not correspond";
    const auto a = a_.loops(), b = b_.loops();
    if (a.size() != b.size()) return std::to_string(a.size()) + " and " + std::to_string(b.size()) + " faces";
    for (const auto& [f, loops] : a) {
      const auto e = face_.find(f);
      if (e == face_.end()) return "a face without a partner";
      if (b.at(e->second) != loops) return "faces with different numbers of holes";
    }
    return std::nullopt;
  }

  Reduced a_, b_;
  double tolerance_;
  bool up_to_tangency_;
  std::vector<Index> partner_;
  std::map<Index, Index> face_, face_back_;
  bool mismatch_ = false;
  Comparison result_;
};

}  // namespace

Comparison compare(const Surface& first, const Surface& second, double tolerance) {
  const Comparison strict = Comparer(first, second, tolerance, false).run();
  return strict.difference ? Comparer(first, second, tolerance, true).run() : strict;
}

}  // namespace krepl::test
