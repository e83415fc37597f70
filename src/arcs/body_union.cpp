#include "arcs/body_union.hpp"

#include <algorithm>
#include <cmath>
#include <list>
#include <optional>
#include <string>

#include "arcs/corners.hpp"
#include "kernel/parallel.hpp"
#include "zone/arc_turn.hpp"

namespace krepl::arcs {
namespace {

using zone::ShapedRings;
using Q = Vector<quad>;

constexpr double full_turn = 3.5;  // in diamond angle; a ring of one circle has 4, or next to nothing

Point rounded(Q v) { return {double(v.x), double(v.y)}; }
double distance(Q p, Q q) { return double(length(q - p)); }

Error unmatched(const Uncovered& u) {
  const Point at = rounded(u.end);
  return {ErrorCode::computation, "the boundary could not be certified: an end has no counterpart",
          "near x " + std::to_string(at.x) + ", y " + std::to_string(at.y) + " relative to the data's origin",
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
  Q start;
  Q first;      // where the item before ends: not at the start where something between was taken out
  double span;  // arcs: how far it turns, as a diamond angle
  bool is_wide() const { return span > 1; }
};
using Chain = std::list<Item>;

Chain::iterator following(Chain& chain, Chain::iterator i) { return ++i == chain.end() ? chain.begin() : i; }
Chain::iterator previous(Chain& chain, Chain::iterator i) { return --(i == chain.begin() ? chain.end() : i); }

/// The item after it starts where it did, too. Returns the place after.
Chain::iterator take_out(Chain& chain, Chain::iterator i) {
  following(chain, i)->first = i->first;
  return chain.erase(i);
}

class Contraction {
 public:
  Contraction(const Corners& corners, double resolution) : corners_(corners), resolution_(resolution) {}

  /// Joins copies of one line or circle and takes out what is negligible; how much of the latter there was.
  std::uint64_t run(Chain& chain) const {
    std::uint64_t collapsed = 0;
    std::size_t settled = 0;
    for (auto i = chain.begin(); settled < chain.size() && chain.size() > 1;) {
      const auto before = previous(chain, i), after = following(chain, i);
      if (before->key == i->key) {
        before->span += i->span;
      } else if (is_negligible(*before, *i, *after, chain.size())) {
        ++collapsed;
      } else {
        i = after;
        ++settled;
        continue;
      }
      i = before->key == i->key ? chain.erase(i) : take_out(chain, i);
      i = previous(chain, i == chain.end() ? chain.begin() : i);
      settled = settled > 2 ? settled - 3 : 0;
    }
    return collapsed;
  }

  /// Moves the starts of all items to where their borders meet. Where borders touch, that may be along the boundary
  /// from where the moved bodies change over, so that pieces get lost: what has no length left or would run backwards
  /// is taken out, for it would pass for a full circle. True if something was.
  bool settle(Chain& chain) const {
    if (chain.size() < 2) return false;
    std::vector<Q> start;
    BorderId before = chain.back().border;
    for (const Item& item : chain) {
      start.push_back(corners_.meet(before, item.border, item.first, item.start));
      before = item.border;
    }
    constexpr std::size_t nothing = ~std::size_t{0} - 1;
    std::size_t k = 0, taken = nothing;
    for (auto i = chain.begin(); i != chain.end() && chain.size() > 1; ++k) {
      const Q p = start[k], q = start[k + 1 < start.size() ? k + 1 : 0];
      const bool stays =
          i->is_wide() || (distance(p, q) > resolution_ && !corners_.runs_back(i->border, p, q)) || taken + 1 == k;
      if (!stays) taken = k;  // and not its neighbour with it, which may stay then
      i = stays ? std::next(i) : take_out(chain, i);
    }
    if (taken != nothing) return true;
    k = 0;
    for (Item& item : chain) item.first = item.start = start[k++];
    return false;
  }

 private:
  /// Shorter than the resolution, or straying by less from what is on both its sides.
  bool is_negligible(const Item& before, const Item& i, const Item& after, std::size_t count) const {
    if (i.is_wide()) return false;
    const double chord = distance(i.start, after.start);
    if (chord <= resolution_) return true;
    if (count < 3 || !(before.key == after.key)) return false;
    // An arc and its chord are apart by chord^2 / 8 r; a line's nearest place to an arc's middle is near its own.
    for (const BorderId border : {i.border, before.border}) {
      const Border<quad> b = corners_.nominal(border);
      if (b.arc && chord * chord > 4 * double(b.radius) * resolution_) return false;
    }
    const Q middle{(i.start.x + after.start.x) / 2, (i.start.y + after.start.y) / 2};
    return corners_.off(before.border, middle) <= resolution_;
  }

  const Corners& corners_;
  double resolution_;
};

Zone::Piece as_piece(const Bodies& bodies, const Item& item, Q start, Q end) {
  Zone::Piece p{Zone::Kind::segment, rounded(start), rounded(end), {}, item.key.index, false, bodies.radius_of(item.key)};
  switch (item.key.kind) {
    case Key::Kind::side:
      p.source = item.key.index >> 1;
      p.reversed = (item.key.index & 1u) != 0;
      break;
    case Key::Kind::chord:
      p.source = item.key.index >> 1;
      p.reversed = (item.key.index & 1u) != 0;
      p.from_arc = true;
      break;
    case Key::Kind::circle:
      p.kind = Zone::Kind::arc;
      p.center = bodies.network().straight().vertices()[item.key.index];
      p.from_vertex = true;
      break;
    case Key::Kind::outer:
    case Key::Kind::inner:
    case Key::Kind::beyond: {
      const Course& c = bodies.course(item.key.index);
      const quad r = bodies.radius_of(item.key);
      p.kind = Zone::Kind::arc;
      p.center = rounded(c.centre);
      p.clockwise = item.key.kind == Key::Kind::inner;
      p.radius = double(p.clockwise ? c.radius - r : item.key.kind == Key::Kind::outer ? c.radius + r : r - c.radius);
      p.from_arc = true;
      break;
    }
    case Key::Kind::tangent:
      p.source = item.key.index >> 2;
      p.from_arc = true;
      break;
    case Key::Kind::bevel:
      p.from_vertex = true;
      p.role = Zone::Role::bevel;
      break;
    case Key::Kind::end:
    case Key::Kind::flat_end:
    case Key::Kind::wall:
    case Key::Kind::square:
      p.source = bodies.ends(item.key)[0];
      p.from_vertex = true;
      p.role = Zone::Role::end;
      break;
    case Key::Kind::inside:  // covered, but for what is contracted
      p.source = 0;
      p.from_vertex = true;
      p.role = Zone::Role::end;
      break;
  }
  return p;
}

bool is_thin(const Chain& chain, const std::vector<Zone::Piece>& ring, double resolution) {
  if (ring.empty()) return true;
  if (std::any_of(chain.begin(), chain.end(), [](const Item& i) { return i.span > 2; })) return false;
  double perimeter = 0, across = 0;
  for (const Zone::Piece& p : ring) {
    perimeter += std::hypot(p.end.x - p.start.x, p.end.y - p.start.y);
    across = std::max(across, std::hypot(p.start.x - ring.front().start.x, p.start.y - ring.front().start.y));
  }
  return across <= 8 * resolution || std::abs(zone::twice_ring_area(ring)) <= resolution * perimeter;
}

std::vector<Zone::Piece> pieces_of(const Bodies& bodies, const Chain& chain) {
  std::vector<Zone::Piece> pieces;
  if (chain.size() == 1) {  // a full circle, or nothing
    const Item& only = chain.front();
    if (only.span < full_turn) return pieces;
    Zone::Piece circle = as_piece(bodies, only, {0, 0}, {0, 0});
    circle.start = circle.end = {circle.center.x + circle.radius, circle.center.y};
    return {circle};
  }
  for (auto i = chain.begin(); i != chain.end(); ++i) {
    const auto next = std::next(i) == chain.end() ? chain.begin() : std::next(i);
    pieces.push_back(as_piece(bodies, *i, i->start, next->start));
  }
  return pieces;
}

}  // namespace

Result<ShapedRings> body_union(const Bodies& bodies, double resolution, const Context& context,
                               ZoneCounters& counters) {
  const std::vector<Uncovered> all = uncovered_stretches(bodies, context, counters);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  auto next = successors(all, context);
  if (!next) return next.error();
  const Corners corners(bodies);
  const Contraction contraction(corners, resolution);
  ShapedRings rings;
  std::vector<bool> done(all.size(), false);
  for (Index first = 0; first < all.size(); ++first) {
    if (done[first]) continue;
    Chain chain;
    for (Index i = first; !done[i]; i = (*next)[i]) {
      done[i] = true;
      const Border<quad> border = corners.nominal(all[i].border);
      // Of a circle hardly wider than the resolution no arc is wide.
      const double span = border.radius > 4 * resolution ? all[i].span : 0;
      chain.push_back({border.key, all[i].border, all[i].start, all[i].start, span});
    }
    do {
      counters.collapsed_pieces += contraction.run(chain);
    } while (contraction.settle(chain));
    const auto pieces = pieces_of(bodies, chain);
    if (is_thin(chain, pieces, resolution)) {
      ++counters.dropped_rings;
      continue;
    }
    rings.piece.insert(rings.piece.end(), pieces.begin(), pieces.end());
    rings.close();
  }
  return rings;
}

}  // namespace krepl::arcs
