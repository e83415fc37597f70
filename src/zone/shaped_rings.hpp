#pragma once

#include <vector>

#include "krepl/zone.hpp"
#include "zone/rings.hpp"

namespace krepl::zone {

/// Closed rings of pieces of any kind, one after the other, the zone on their left. Coordinates are relative to the
/// network's origin; a piece ends where the next one of its ring starts.
struct ShapedRings {
  std::vector<Index> begin{0};
  std::vector<Zone::Piece> piece;
  /// Which way each ring runs, where that is known; else it is told by areas, which cannot tell an arc of nearly a full turn
  /// from one of hardly any.
  std::vector<bool> clockwise = {};

  bool touch = false;  ///< rings may touch each other in places

  Index ring_count() const { return Index(begin.size() - 1); }
  void close() { begin.push_back(Index(piece.size())); }
  /// The other's rings after these.
  void append(const ShapedRings& more);
};

/// The pieces that the rings of a zone stand for.
ShapedRings shaped(const Instance& instance, const Rings& rings);

/// The other way round: what was on the left is on the right.
ShapedRings reversed(const ShapedRings& rings);

/// The rings for which is_kept(where their first piece starts) is true.
template <class Predicate>
ShapedRings rings_where(const ShapedRings& rings, Predicate&& is_kept) {
  ShapedRings kept;
  kept.touch = rings.touch;
  for (Index r = 0; r < rings.ring_count(); ++r) {
    const auto first = rings.piece.begin() + rings.begin[r], last = rings.piece.begin() + rings.begin[r + 1];
    if (!is_kept(first->start)) continue;
    kept.piece.insert(kept.piece.end(), first, last);
    kept.close();
  }
  return kept;
}

}  // namespace krepl::zone
