#include "shape/body_union.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <optional>
#include <string>

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "shape/uncovered.hpp"

namespace krepl::shape {
namespace {

using zone::ShapedRings;

using vectors::distance;

Error unmatched(const Uncovered& u) {
  return {ErrorCode::computation, "the boundary could not be certified: an end has no counterpart",
          "near x " + std::to_string(u.end.x) + ", y " + std::to_string(u.end.y) + " relative to the data's origin",
          "please report this input"};
}

/// For each stretch the one that goes on where it ends.
Result<std::vector<Index>> successors(const std::vector<Uncovered>& all, const Context& context) {
  std::vector<Index> next(all.size(), none);
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, all.size(), 1 << 12, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      auto j = std::lower_bound(all.begin(), all.end(), all[i].to,
                                [](const Uncovered& u, BorderId border) { return u.border < border; });
      for (; j != all.end() && j->border == all[i].to; ++j)
        if (j->from == all[i].border) next[i] = Index(j - all.begin());
    }
  });
  std::vector<bool> reached(all.size(), false);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (next[i] == none || reached[next[i]]) return unmatched(all[i]);
    reached[next[i]] = true;
  }
  return next;
}

/// A piece of a ring while it is being contracted.
struct Item {
  Key key;
  BorderId border;
  Point start;
  bool wide;
};
using Chain = std::list<Item>;

/// Where borders meet, by the radius as it was given wherever that is well-conditioned.
class Corners {
 public:
  Corners(const Network& network, const Bodies& bodies)
      : network_(network), bodies_(bodies), enlargement_(bodies.radius() - bodies.nominal_radius()) {}

  /// How far p is from the line or circle that the border lies on.
  double off(BorderId border, Point p) const {
    const Border<quad> b = nominal(border);
    const Vector<quad> v{p.x - b.p.x, p.y - b.p.y};
    if (b.arc) return std::abs(std::hypot(double(p.x - b.c.x), double(p.y - b.c.y)) - bodies_.nominal_radius());
    const Vector<quad> d{b.q.x - b.p.x, b.q.y - b.p.y};
    return std::abs(double((d.x * v.y - d.y * v.x) / kernel::square_root(d.x * d.x + d.y * d.y)));
  }

  /// Only borders about a common vertex may touch: all others are looked at by the enlarged radius where they nearly
  /// do, as its topology tells where they cross.
  Point meet(BorderId from, BorderId to, Point seen) const {
    const Border<quad> a = nominal(from), b = nominal(to);
    Vector<quad> found[2] = {};
    const double sine = a.arc ? (b.arc ? circles(a, b, found) : line_circle(b, a, found))
                              : (b.arc ? line_circle(a, b, found) : lines(a, b, found));
    if (sine < 0x1p-20 && a.key.kind == Key::Kind::side && b.key.kind == Key::Kind::side) {
      // The line goes straight on, so that copies of its sides may change over anywhere near the vertex.
      if (const auto at = straight_on(a, b)) return *at;
    }
    if (!(sine >= (are_incident(a.key, b.key) ? 0.0 : 1.0 / 16))) return seen;
    const double limit = 8 * enlargement_ / std::max(sine, 0x1p-20);
    const auto as_point = [](Vector<quad> v) { return Point{double(v.x), double(v.y)}; };
    Point best = as_point(found[0]);
    const Point other = as_point(found[1]);
    if (distance(other, seen) < distance(best, seen)) best = other;
    return distance(best, seen) <= limit ? best : seen;
  }

 private:
  Border<quad> nominal(BorderId id) const { return bodies_.nominal(body_of(id)).border[place_of(id)]; }

  /// Beside the common vertex of two sides, the first of which ends there.
  std::optional<Point> straight_on(const Border<quad>& a, const Border<quad>& b) const {
    const auto end = [&](const Key& key, bool last) {
      const auto s = network_.segments()[key.index >> 1];
      return ((key.index & 1u) != 0) == last ? s.a : s.b;
    };
    const Index vertex = end(a.key, true);
    if (vertex != end(b.key, false)) return std::nullopt;
    const Vector<quad> d{a.q.x - a.p.x, a.q.y - a.p.y};
    const quad scale = bodies_.nominal_radius() / kernel::square_root(d.x * d.x + d.y * d.y);
    const Point v = network_.vertices()[vertex];
    return Point{double(v.x + scale * d.y), double(v.y - scale * d.x)};
  }

  bool are_incident(const Key& a, const Key& b) const {
    const auto ends = [&](const Key& key) {
      if (key.kind != Key::Kind::side) return std::array{key.index, key.index};
      const auto s = network_.segments()[key.index >> 1];
      return std::array{s.a, s.b};
    };
    const auto p = ends(a), q = ends(b);
    return p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1];
  }

  /// These return the sine of the angle at which the two meet; below zero: nowhere.
  static double lines(const Border<quad>& a, const Border<quad>& b, Vector<quad> (&out)[2]) {
    const Vector<quad> d{a.q.x - a.p.x, a.q.y - a.p.y}, e{b.q.x - b.p.x, b.q.y - b.p.y};
    const quad turn = d.x * e.y - d.y * e.x;
    if (turn == 0) return -1;
    const quad t = ((b.p.x - a.p.x) * e.y - (b.p.y - a.p.y) * e.x) / turn;
    out[0] = out[1] = {a.p.x + t * d.x, a.p.y + t * d.y};
    return std::abs(
        double(turn / (kernel::square_root(d.x * d.x + d.y * d.y) * kernel::square_root(e.x * e.x + e.y * e.y))));
  }
  double line_circle(const Border<quad>& line, const Border<quad>& circle, Vector<quad> (&out)[2]) const {
    const quad r = bodies_.nominal_radius();
    const Vector<quad> d{line.q.x - line.p.x, line.q.y - line.p.y};
    const quad l = kernel::square_root(d.x * d.x + d.y * d.y);
    const Vector<quad> w{d.x / l, d.y / l}, v{circle.c.x - line.p.x, circle.c.y - line.p.y};
    const quad along = v.x * w.x + v.y * w.y, off = w.x * v.y - w.y * v.x;
    const quad half = kernel::square_root((r - off) * (r + off));  // zero where they only touch
    out[0] = {line.p.x + (along - half) * w.x, line.p.y + (along - half) * w.y};
    out[1] = {line.p.x + (along + half) * w.x, line.p.y + (along + half) * w.y};
    return double(half / r);
  }
  double circles(const Border<quad>& a, const Border<quad>& b, Vector<quad> (&out)[2]) const {
    const quad r = bodies_.nominal_radius();
    const Vector<quad> v{b.c.x - a.c.x, b.c.y - a.c.y};
    const quad l = kernel::square_root(v.x * v.x + v.y * v.y);
    if (l == 0) return -1;
    const quad c = l / (2 * r), s = kernel::square_root((1 - c) * (1 + c));
    const Vector<quad> w{v.x / l, v.y / l};
    out[0] = {a.c.x + r * (c * w.x + s * w.y), a.c.y + r * (c * w.y - s * w.x)};
    out[1] = {a.c.x + r * (c * w.x - s * w.y), a.c.y + r * (c * w.y + s * w.x)};
    return double(s);
  }

  const Network& network_;
  const Bodies& bodies_;
  double enlargement_;
};

class Contraction {
 public:
  Contraction(const Corners& corners, double resolution) : corners_(corners), resolution_(resolution) {}

  std::uint64_t run(Chain& chain) const {
    std::uint64_t collapsed = 0;
    std::size_t settled = 0;
    for (auto i = chain.begin(); settled < chain.size() && chain.size() > 1;) {
      const auto before = previous(chain, i), after = following(chain, i);
      if (before->key == i->key) {  // copies of one line or circle
        before->wide = before->wide || i->wide;
        i = chain.erase(i);
        i = previous(chain, i == chain.end() ? chain.begin() : i);
        settled = settled > 1 ? settled - 2 : 0;
      } else if (!i->wide && is_negligible(*before, *i, *after, chain.size())) {
        ++collapsed;
        i = chain.erase(i);
        i = previous(chain, i == chain.end() ? chain.begin() : i);
        settled = settled > 2 ? settled - 3 : 0;
      } else {
        i = after;
        ++settled;
      }
    }
    return collapsed;
  }

 private:
  static Chain::iterator following(Chain& chain, Chain::iterator i) { return ++i == chain.end() ? chain.begin() : i; }
  static Chain::iterator previous(Chain& chain, Chain::iterator i) { return --(i == chain.begin() ? chain.end() : i); }
  /// Shorter than the resolution, or straying by less from what is on both its sides.
  bool is_negligible(const Item& before, const Item& i, const Item& after, std::size_t count) const {
    if (distance(i.start, after.start) <= resolution_) return true;
    if (count < 3 || !(before.key == after.key)) return false;
    const double chord = distance(i.start, after.start);
    if (i.key.kind == Key::Kind::circle || before.key.kind == Key::Kind::circle) {
      // An arc and its chord are apart by chord^2 / 8 R.
      if (chord * chord > 4 * corners_radius() * resolution_) return false;
    }
    const Point middle{(i.start.x + after.start.x) / 2, (i.start.y + after.start.y) / 2};
    return corners_.off(before.border, middle) <= resolution_;
  }
  double corners_radius() const { return radius_; }

 public:
  double radius_ = 0;

 private:
  const Corners& corners_;
  double resolution_;
};

Zone::Piece as_piece(const Network& network, const Item& item, Point start, Point end) {
  Zone::Piece p{Zone::Kind::segment, start, end, {}, item.key.index, false};
  switch (item.key.kind) {
    case Key::Kind::side:
      p.source = item.key.index >> 1;
      p.reversed = (item.key.index & 1u) != 0;
      return p;
    case Key::Kind::circle:
      p.kind = Zone::Kind::arc;
      p.center = network.vertices()[item.key.index];
      break;
    case Key::Kind::end:
      p.role = Zone::Role::end;
      break;
    case Key::Kind::bevel:
      p.role = Zone::Role::bevel;
      break;
  }
  p.from_vertex = true;
  return p;
}

/// Twice the area on the left of the chords, and what arcs add.
double twice_area(const std::vector<Zone::Piece>& ring, double radius) {
  double twice = 0;
  const Point base = ring.front().start;
  for (const Zone::Piece& p : ring) {
    twice += (p.start.x - base.x) * (p.end.y - base.y) - (p.start.y - base.y) * (p.end.x - base.x);
    if (p.kind != Zone::Kind::arc) continue;
    const Point u{p.start.x - p.center.x, p.start.y - p.center.y}, v{p.end.x - p.center.x, p.end.y - p.center.y};
    double angle = p.start == p.end ? 2 * M_PI : std::atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y);
    if (angle < -1e-6) angle += 2 * M_PI;
    twice += radius * radius * (angle - std::sin(angle));
  }
  return twice;
}

bool is_thin(const std::vector<Zone::Piece>& ring, double radius, double resolution, bool wide) {
  if (ring.empty()) return true;
  if (wide) return false;
  double perimeter = 0, across = 0;
  for (const Zone::Piece& p : ring) {
    perimeter += distance(p.start, p.end);
    across = std::max(across, distance(p.start, ring.front().start));
  }
  return across <= 8 * resolution || std::abs(twice_area(ring, radius)) <= resolution * perimeter;
}

/// Moves the starts of all items to where their borders meet. Near a vertex where a line goes straight on, or an arc
/// begins, that may be far along the boundary from where the moved bodies change over; what has no length left then is
/// dropped, as an arc without would pass for a full circle. True if something was.
bool settle(const Corners& corners, Chain& chain, double resolution) {
  if (chain.size() < 2) return false;
  BorderId before = chain.back().border;
  for (Item& item : chain) {
    item.start = corners.meet(before, item.border, item.start);
    before = item.border;
  }
  bool dropped = false;
  for (auto i = chain.begin(); i != chain.end() && chain.size() > 1;) {
    const auto next = std::next(i) == chain.end() ? chain.begin() : std::next(i);
    if (!i->wide && distance(i->start, next->start) <= resolution) {
      i = chain.erase(i);
      dropped = true;
    } else {
      ++i;
    }
  }
  return dropped;
}

std::vector<Zone::Piece> pieces_of(const Network& network, double radius, const Chain& chain) {
  std::vector<Zone::Piece> pieces;
  if (chain.size() == 1) {  // a full circle, or nothing
    const Item& only = chain.front();
    if (only.key.kind != Key::Kind::circle || !only.wide) return pieces;
    const Point c = network.vertices()[only.key.index], start{c.x + radius, c.y};
    return {as_piece(network, only, start, start)};
  }
  for (auto i = chain.begin(); i != chain.end(); ++i)
    pieces.push_back(
        as_piece(network, *i, i->start, (std::next(i) == chain.end() ? chain.begin() : std::next(i))->start));
  return pieces;
}

}  // namespace

Result<ShapedRings> body_union(const Network& network, const Bodies& bodies, double resolution, const Context& context,
                               ZoneCounters& counters) {
  const std::vector<Uncovered> all = uncovered_stretches(bodies, context, counters);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  auto next = successors(all, context);
  if (!next) return next.error();
  const Corners corners(network, bodies);
  Contraction contraction(corners, resolution);
  contraction.radius_ = bodies.nominal_radius();
  ShapedRings rings;
  std::vector<bool> done(all.size(), false);
  for (Index first = 0; first < all.size(); ++first) {
    if (done[first]) continue;
    Chain chain;
    for (Index i = first; !done[i]; i = (*next)[i]) {
      done[i] = true;
      const Key key = bodies.nominal(body_of(all[i].border)).border[place_of(all[i].border)].key;
      chain.push_back({key, all[i].border, all[i].start, all[i].wide});
    }
    do {
      counters.collapsed_pieces += contraction.run(chain);
    } while (settle(corners, chain, resolution));
    const auto pieces = pieces_of(network, bodies.nominal_radius(), chain);
    const bool wide = std::any_of(chain.begin(), chain.end(), [](const Item& i) { return i.wide; });
    if (is_thin(pieces, bodies.nominal_radius(), resolution, wide)) {
      ++counters.dropped_rings;
      continue;
    }
    rings.piece.insert(rings.piece.end(), pieces.begin(), pieces.end());
    rings.close();
  }
  return rings;
}

}  // namespace krepl::shape
