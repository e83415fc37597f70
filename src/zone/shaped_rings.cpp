#include "zone/shaped_rings.hpp"

#include <algorithm>
#include <utility>

namespace krepl::zone {

ShapedRings shaped(const Instance& in, const Rings& rings) {
  ShapedRings out;
  out.begin = rings.begin;
  out.piece.reserve(rings.element.size());
  for (Index r = 0; r < rings.ring_count(); ++r) {
    for (Index e = rings.begin[r]; e < rings.begin[r + 1]; ++e) {
      const Index element = rings.element[e];
      Zone::Piece p{Zone::Kind::segment, rings.vertex[e],    rings.vertex[rings.next(r, e)], {},
                    element >> 1,        (element & 1u) != 0};
      if (!in.is_side(element)) {
        p.kind = Zone::Kind::arc;
        p.source = in.vertex_of(element);
        p.center = in.vertices()[p.source];
        p.from_vertex = true;
        p.reversed = false;
      }
      out.piece.push_back(p);
    }
  }
  return out;
}

void ShapedRings::append(const ShapedRings& more) {
  touch = touch || more.touch;
  const Index shift = begin.back();
  piece.insert(piece.end(), more.piece.begin(), more.piece.end());
  for (std::size_t r = 1; r < more.begin.size(); ++r) begin.push_back(more.begin[r] + shift);
}

ShapedRings reversed(const ShapedRings& rings) {
  ShapedRings out;
  out.begin = rings.begin, out.touch = rings.touch;
  out.piece.reserve(rings.piece.size());
  for (Index r = 0; r < rings.ring_count(); ++r) {
    for (Index e = rings.begin[r + 1]; e-- > rings.begin[r];) {
      Zone::Piece p = rings.piece[e];
      std::swap(p.start, p.end);
      if (p.kind == Zone::Kind::arc) p.clockwise = !p.clockwise;
      if (!p.from_vertex) p.reversed = !p.reversed;
      out.piece.push_back(p);
    }
  }
  return out;
}

}  // namespace krepl::zone
