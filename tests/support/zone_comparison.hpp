#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "krepl/zone.hpp"

namespace krepl::test {

/// How two zones of one input and radius differ in what the accuracy statement promises: rings, holes, area (1e-9
/// relative); nothing if they do not.
inline std::optional<std::string> difference(const Zone& a, const Zone& b) {
  const auto counts = [](const Zone& z) {
    return std::to_string(z.ring_count()) + " rings (" + std::to_string(z.hole_count()) + " holes, " +
           std::to_string(z.polygon_count()) + " polygons)";
  };
  if (counts(a) != counts(b)) return counts(a) + " against " + counts(b);
  const double first = a.area(), second = b.area();
  if (!(std::abs(first - second) <= 1e-9 * first))
    return "area " + std::to_string(first) + " against " + std::to_string(second);
  return std::nullopt;
}

/// How two zones differ in anything: the same rings of the same pieces with the same bits, or what is not the same.
inline std::optional<std::string> any_difference(const Zone& a, const Zone& b) {
  if (auto differ = difference(a, b)) return differ;
  if (a.piece_count() != b.piece_count())
    return std::to_string(a.piece_count()) + " pieces against " + std::to_string(b.piece_count());
  for (std::uint32_t r = 0; r < a.ring_count(); ++r)
    if (a.ring_begin(r) != b.ring_begin(r)) return "ring " + std::to_string(r) + " begins elsewhere";
  for (std::uint32_t e = 0; e < a.piece_count(); ++e) {
    const auto p = a.piece(e), q = b.piece(e);
    if (p.kind != q.kind || p.source != q.source || p.reversed != q.reversed || !(p.start == q.start) ||
        !(p.end == q.end))
      return "piece " + std::to_string(e) + " is another one";
  }
  return std::nullopt;
}

}  // namespace krepl::test
