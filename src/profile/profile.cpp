// What can be read off a finished profile.
#include "krepl/profile.hpp"

namespace krepl {

std::string profile_cause(const ProfileRow& row) {
  std::string name = row.kind == ProfilePiece::Kind::segment ? "s" : "v";
  return name += std::to_string(row.index);
}

ProfileRow profile_row(std::span<const Point> terrain, std::span<const ProfilePiece> pieces, std::size_t k) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const ProfilePiece& piece = pieces[k];
  ProfileRow row{piece.kind, piece.start, {piece.start.x, -infinity}, {none, none}, piece.index};
  if (k + 1 < pieces.size()) row.end = pieces[k + 1].start;
  if (piece.kind == ProfilePiece::Kind::arc) row.center = terrain[piece.index];
  return row;
}

ProfileVertexCounts count_profile_vertices(std::span<const Point> terrain, std::span<const ProfilePiece> pieces) {
  using Kind = ProfilePiece::Kind;
  ProfileVertexCounts counts{pieces.size() - 1, 0};
  // The vertex a segment's piece ends (or starts) at, by coordinates: repeated points are one vertex.
  const auto touches = [&](const ProfilePiece& segment, const ProfilePiece& other, bool at_end) {
    const Point end = terrain[segment.index + (at_end ? 1u : 0u)];
    return other.kind == Kind::arc && terrain[other.index] == end;
  };
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    const ProfilePiece &p = pieces[k - 1], &q = pieces[k];
    if (p.kind == Kind::half_line || q.kind == Kind::half_line) continue;
    if (p.kind == Kind::segment && touches(p, q, true)) continue;
    if (q.kind == Kind::segment && touches(q, p, false)) continue;
    if (p.kind == Kind::segment && q.kind == Kind::segment && terrain[p.index + 1] == terrain[q.index]) {
      const Point a = terrain[p.index], b = terrain[q.index], c = terrain[q.index + 1];
      const double left = (b.x - a.x) * (c.y - b.y), right = (b.y - a.y) * (c.x - b.x);
      if (left <= right) continue;  // no valley: the arc between them has no length
    }
    ++counts.explicit_ones;
  }
  return counts;
}

Result<Profile> compute_profile(std::vector<Point> terrain, double radius, const Context& context) {
  Profile profile;
  profile.radius = radius;
  profile.pieces.resize(terrain.empty() ? 0 : profile_capacity(terrain.size()));
  ProfileEngine engine;
  Result<std::size_t> count = engine.compute(terrain, radius, profile.pieces, context);
  if (!count) return count.error();
  profile.pieces.resize(*count);
  profile.terrain = std::move(terrain);
  profile.counters = engine.counters();
  return profile;
}

}  // namespace krepl
