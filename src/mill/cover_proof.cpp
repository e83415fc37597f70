#include "mill/cover_proof.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "mill/free_moves.hpp"
#include "model/terrain_window.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

constexpr double root3 = 1.7320508075688772;
constexpr int most_levels = 8;      // of halving a tile; more if asked for
constexpr int most_asked = 14;
constexpr double rounding = 1e-12;  // of squared distances, relative
constexpr double smallest = 0.01;   // half a cube's diagonal or so, of half the distance of passes on a plane
constexpr double widest_cone =
    1.56;  // radians: beyond it directions between those of two touched places are left to subdivision

Point3 nearest_on_segment(Point3 p, Point3 a, Point3 b) {
  const Point3 d = b - a;
  const double squared = dot(d, d);
  return a + (squared > 0 ? std::clamp(dot(p - a, d) / squared, 0.0, 1.0) : 0.0) * d;
}

struct Triangle {
  Point3 a, b, c;
  bool vertical;
};

/// By the region of the plane of the triangle that p is over.
Point3 nearest_on_triangle(Point3 p, const Triangle& t) {
  const Point3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a, bp = p - t.b, cp = p - t.c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return t.a;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return t.b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return nearest_on_segment(p, t.a, t.b);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return t.c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return nearest_on_segment(p, t.a, t.c);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return nearest_on_segment(p, t.b, t.c);
  const double all = va + vb + vc;
  if (!(all > 0)) return nearest_on_segment(p, t.a, t.b);  // rounding of a sliver
  return t.a + (vb / all) * ab + (vc / all) * ac;
}

/// Of the triangle and all below it: where p is lower than what is nearest on the triangle, on the upright wall below
/// its part that is higher than p.
Point3 nearest_on_body(Point3 p, const Triangle& t) {
  const Point3 q = nearest_on_triangle(p, t);
  if (q.z <= p.z) return q;
  const Point3 corners[3] = {t.a, t.b, t.c};
  Point3 higher[4];
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    const Point3 a = corners[k], b = corners[(k + 1) % 3];
    if (a.z >= p.z) higher[count++] = {a.x, a.y, p.z};
    if ((a.z >= p.z) == (b.z >= p.z)) continue;
    const double s = (p.z - a.z) / (b.z - a.z);
    higher[count++] = {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), p.z};
  }
  Point3 best = q;
  double least = 1e300;
  int left = 0, right = 0;
  for (int k = 0; k < count; ++k) {
    const Point3 a = higher[k], b = higher[(k + 1) % count];
    const double turn = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    left += turn > 0, right += turn < 0;
    const Point3 at = nearest_on_segment(p, a, b);
    if (const double d = distance(p, at); d < least) least = d, best = at;
  }
  return count > 2 && (left == 0 || right == 0) && left + right > 0 ? p : best;
}

}  // namespace

/// One tile of a proof: cubes, and for each size the triangles and pieces of the path that are near.
class CoverTile {
 public:
  CoverTile(const CoverProof& proof, const std::function<bool(Point3, double)>& is_of_interest)
      : p_(proof), interest_(is_of_interest), o_(proof.o_), levels_(std::size_t(proof.levels_ + 2)) {
    contact_ = o_.radius + o_.allowance;
    lift_ = o_.allowance + o_.height;
    room_ = (o_.radius - o_.off) * (o_.radius - o_.off) * (1 - rounding);
    sure_ = proof.reach_ / 2;
  }

  void run(std::size_t tile, std::vector<Point3>& open) {
    open_ = &open;
    const double side = p_.side_;
    const Point middle{p_.first_.x + (double(tile % p_.columns_) + 0.5) * side,
                       p_.first_.y + (double(tile / p_.columns_) + 0.5) * side};
    const DropCutter::Contact above = p_.larger_[0].at(middle);
    if (!above.touches()) return;
    if (!list_near(middle, side / 2 + contact_)) return;
    const DropCutter::Contact below = p_.smaller_[0].at(middle);
    double z = (below.touches() ? below.height : lowest_) + side / 2;
    for (; z - side / 2 <= above.height; z += side) look({middle.x, middle.y, z}, side, 0);
  }

 private:
  struct Level {
    std::vector<std::uint32_t> triangles, pieces;
    std::vector<std::uint32_t> touched;
    std::vector<Point3> place, normal, limit;  // of each touched triangle: q0, m0, x0
    std::vector<double> angle, away;           // and by how much m differs from m0; |c0 - q0|
  };

  bool list_near(Point middle, double half) {
    const Point low{middle.x - half, middle.y - half}, high{middle.x + half, middle.y + half};
    window_.fill(p_.cutter_.terrain(), low, high);
    triangles_.clear();
    lowest_ = 1e300;
    const auto vertices = window_.vertices();
    for (const TerrainWindow::Face& f : window_.faces()) {
      if (!f.core) continue;
      const Triangle t{vertices[f.vertex[0]].at, vertices[f.vertex[1]].at, vertices[f.vertex[2]].at, f.vertical};
      lowest_ = std::min({lowest_, t.a.z, t.b.z, t.c.z});
      triangles_.push_back(t);
    }
    near_.clear();
    const double far = p_.side_ / 2 * root3 + 3 * p_.reach_ + p_.bucket_;
    const auto cell = [&](double x, double first, std::size_t count) {
      return std::size_t(std::clamp(std::floor((x - first) / p_.bucket_), 0.0, double(count - 1)));
    };
    const std::size_t c0 = cell(middle.x - far, p_.first_.x, p_.across_),
                      c1 = cell(middle.x + far, p_.first_.x, p_.across_);
    const std::size_t r0 = cell(middle.y - far, p_.first_.y, p_.up_), r1 = cell(middle.y + far, p_.first_.y, p_.up_);
    for (std::size_t r = r0; r <= r1; ++r)
      for (std::size_t n = p_.begin_[r * p_.across_ + c0]; n < p_.begin_[r * p_.across_ + c1 + 1]; ++n)
        near_.push_back(p_.pieces_[n]);
    return !triangles_.empty();
  }

  /// A cube of which the middle is c.
  void look(Point3 c, double side, int depth) {
    Level& level = levels_[std::size_t(depth)];
    const double e = side * root3 / 2;
    if (!list(c, e, depth)) return;
    if (proven(c, e, level)) return;
    // Beside the part the outer side is not looked at, nor what is touched from there in the smallest cubes.
    const DropCutter::Contact below = p_.smaller_[std::size_t(depth)].at({c.x, c.y});
    if (!below.touches() && drop_walls(level, e)) {
      if (level.touched.empty() || proven(c, e, level)) return;
    }
    if (interest_ && !interest_(c, depth == p_.levels_ ? 0 : side / 2)) return;
    if (depth == p_.levels_) {
      if (below.touches()) open_->push_back(c);
      return;
    }
    if (Point3 place; side <= sure_ && is_open(c, e, depth, place)) {
      open_->push_back(place);
      return;
    }
    for (int k = 0; k < 8; ++k)
      look({c.x + (k & 1 ? 1 : -1) * side / 4, c.y + (k & 2 ? 1 : -1) * side / 4, c.z + (k & 4 ? 1 : -1) * side / 4},
           side / 2, depth + 1);
  }

  /// Whether a place of the surface in the cube is not covered: one where the ball touches what is nearest to the
  /// middle. Then there is no need to look closer.
  bool is_open(Point3 c, double e, int depth, Point3& place) {
    const Level& level = levels_[std::size_t(depth)];
    const std::size_t best = std::size_t(std::min_element(level.away.begin(), level.away.end()) - level.away.begin());
    place = level.place[best] + contact_ * level.normal[best];
    if (distance(place, c) > e) return false;
    if (interest_ && !interest_(place, 0)) return false;
    const double tiny = p_.tiny_;
    if (!list(place, tiny, depth + 1) || proven(place, tiny, levels_[std::size_t(depth) + 1])) return false;
    return p_.smaller_[std::size_t(p_.levels_)].at({place.x, place.y}).touches();
  }

  /// The triangles that a ball with its centre in the cube may touch from above, and pieces near it. False if the ball
  /// cannot rest there.
  bool list(Point3 c, double e, int depth) {
    Level& level = levels_[std::size_t(depth)];
    level.triangles.clear(), level.pieces.clear(), level.touched.clear();
    level.place.clear(), level.normal.clear(), level.limit.clear(), level.angle.clear(), level.away.clear();
    const Level* above = depth == 0 ? nullptr : &levels_[std::size_t(depth) - 1];
    const std::size_t count = above == nullptr ? triangles_.size() : above->triangles.size();
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t t = above == nullptr ? std::uint32_t(n) : above->triangles[n];
      const Point3 q = nearest_on_body(c, triangles_[t]), way = c - q;
      const double away = length(way);
      if (away < contact_ - e || away == 0) return false;
      if (away > contact_ + e) continue;
      level.triangles.push_back(t), level.place.push_back(q), level.away.push_back(away);
      level.normal.push_back((1 / away) * way), level.angle.push_back(std::asin(std::min(1.0, e / away)));
    }
    drop_farther(e, level);
    level.touched.resize(level.triangles.size());
    for (std::size_t n = 0; n < level.touched.size(); ++n) {
      level.touched[n] = level.triangles[n];
      level.limit.push_back(level.place[n] + lift_ * level.normal[n]);
    }
    if (level.touched.empty()) return false;
    const double far = 3 * p_.reach_ + e;
    const std::size_t pieces = above == nullptr ? near_.size() : above->pieces.size();
    for (std::size_t n = 0; n < pieces; ++n) {
      const std::uint32_t k = above == nullptr ? std::uint32_t(n) : above->pieces[n];
      const Point3 d = nearest_of(c, near_[k]) - c;
      if (dot(d, d) <= far * far) level.pieces.push_back(k);
    }
    return true;
  }

  /// Drops triangles to which no c of the cube is as near as to that which is nearest to the middle. The distance from
  /// a triangle changes along m, so the difference of two changes no faster than the difference of their m.
  void drop_farther(double e, Level& level) const {
    if (level.triangles.size() < 2) return;
    const std::size_t best = std::size_t(std::min_element(level.away.begin(), level.away.end()) - level.away.begin());
    const Point3 normal = level.normal[best];
    const double away = level.away[best], angle = level.angle[best];
    std::size_t kept = 0;
    for (std::size_t n = 0; n < level.triangles.size(); ++n) {
      if (level.away[n] - away > e * (distance(level.normal[n], normal) + level.angle[n] + angle)) continue;
      level.triangles[kept] = level.triangles[n], level.place[kept] = level.place[n],
      level.normal[kept] = level.normal[n];
      level.angle[kept] = level.angle[n], level.away[kept] = level.away[n];
      ++kept;
    }
    level.triangles.resize(kept), level.place.resize(kept), level.normal.resize(kept), level.angle.resize(kept),
        level.away.resize(kept);
  }

  template <class Drop>
  static bool drop_if(Level& level, const Drop& drop) {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < level.touched.size(); ++n) {
      if (drop(n)) continue;
      level.touched[kept] = level.touched[n], level.place[kept] = level.place[n], level.normal[kept] = level.normal[n];
      level.limit[kept] = level.limit[n], level.angle[kept] = level.angle[n], level.away[kept] = level.away[n];
      ++kept;
    }
    const bool dropped = kept < level.touched.size();
    level.touched.resize(kept), level.place.resize(kept), level.normal.resize(kept), level.limit.resize(kept);
    level.angle.resize(kept), level.away.resize(kept);
    return dropped;
  }

  /// Beside the part: what is vertical, or has the part above it.
  bool drop_walls(Level& level, double e) const {
    return drop_if(level, [&](std::size_t n) {
      const Point3 q = level.place[n];
      return triangles_[level.touched[n]].vertical || p_.needle_.at({q.x, q.y}).height > q.z + e;
    });
  }

  bool proven(Point3 c, double e, const Level& level) const {
    Point3 mean{}, axis{};
    for (std::size_t n = 0; n < level.touched.size(); ++n) mean = mean + level.limit[n], axis = axis + level.normal[n];
    mean = (1 / double(level.touched.size())) * mean;
    // Directions between those of two touched places are sums of them with weights that add up to 1 / cos(cone) at
    // most.
    double cone = widest_cone;
    if (const double size = length(axis); size > 0) {
      double widest = 0;
      for (std::size_t n = 0; n < level.touched.size(); ++n)
        widest = std::max(widest, std::acos(std::clamp(dot(axis, level.normal[n]) / size, -1.0, 1.0)) + level.angle[n]);
      cone = std::min(cone, widest);
    }
    const double more = cone < widest_cone ? 1 / std::cos(cone) - 1 : -1;
    // The ball is as low there, whatever it touches.
    for (const std::uint32_t k : level.pieces)
      if (distance(nearest_of(c, near_[k]), c) + e <= o_.height - o_.off) return true;
    for (const std::uint32_t k : level.pieces)
      if (reaches(nearest_of(mean, near_[k]), c, e, level, more)) return true;
    return false;
  }

  /// A place of the piece near p. With a shank the ball may as well be higher than the path.
  Point3 nearest_of(Point3 p, const PathPiece& piece) const {
    const Point3 q = nearest_on_segment(p, piece.from, piece.to);
    if (!o_.shank) return q;
    const Point3 level_from{piece.from.x, piece.from.y, 0}, level_to{piece.to.x, piece.to.y, 0};
    const Point3 along = level_to - level_from, flat{p.x, p.y, 0};
    const double squared = dot(along, along),
                 t = squared > 0 ? std::clamp(dot(flat - level_from, along) / squared, 0.0, 1.0) : 0;
    const double bottom =
        squared > 0 ? piece.from.z + t * (piece.to.z - piece.from.z) : std::min(piece.from.z, piece.to.z);
    const Point3 level = level_from + t * along;
    return p.z > bottom ? Point3{level.x, level.y, p.z} : q;
  }

  /// Whether all x of the cube are within the tool's radius of a.
  bool reaches(Point3 a, Point3 c, double e, const Level& level, double more) const {
    const double apart = distance(a, c);
    double worst = 0;
    for (std::size_t n = 0; n < level.touched.size(); ++n) {
      const Point3 d = a - level.limit[n];
      const double squared = dot(d, d), up = dot(d, level.normal[n]);
      const double aside = std::sqrt(std::max(0.0, squared - up * up)), turn = level.angle[n];
      const double moved = e + lift_ * turn;
      worst = std::max(worst, squared + std::max(0.0, up) * (e * e / level.away[n] + lift_ * turn * turn) +
                                  2 * aside * moved + moved * moved);
      if (worst > room_) return false;
    }
    const double near = std::max(0.0, apart - e), core = o_.radius - o_.height;
    const double above = worst - near * near - core * core;  // twice (r - h) d.m, at most
    if (above <= 0) return true;
    return more >= 0 && worst + more * above <= room_;
  }

  const CoverProof& p_;
  const std::function<bool(Point3, double)>& interest_;
  const CoverOptions& o_;
  double contact_, lift_, room_, sure_, lowest_ = 0;
  std::vector<Level> levels_;
  std::vector<Triangle> triangles_;
  std::vector<PathPiece> near_;
  TerrainWindow window_;
  std::vector<Point3>* open_ = nullptr;
};

CoverProof::CoverProof(const DropCutter& cutter, const CoverOptions& options)
    : cutter_(cutter),
      needle_(*cutter.with_radius(std::ldexp(cutter.terrain().extent() + cutter.radius(), -34))),
      o_(options) {
  const double core = o_.radius - o_.height, contact = o_.radius + o_.allowance;
  reach_ = std::sqrt(o_.radius * o_.radius - core * core);
  tiny_ = 1e-6 * reach_;
  side_ = std::min(4 * reach_, contact / 2);
  levels_ = std::clamp(int(std::ceil(std::log2(side_ / (2 * smallest * reach_)))), 1, most_levels);
  if (o_.smallest > 0)
    levels_ = std::clamp(int(std::ceil(std::log2(side_ / o_.smallest))), levels_, most_asked);
  for (int k = 0; k <= levels_; ++k) {
    const double e = std::ldexp(side_ * root3 / 2, -k);
    for (const bool more : {false, true})
      (more ? larger_ : smaller_).push_back(*cutter.with_radius(more ? contact + e : contact - e));
  }
  const Terrain& part = cutter.terrain();
  const Point3 low = part.lowest(), high = part.highest();
  first_ = {low.x - contact, low.y - contact};
  columns_ = std::size_t(std::ceil((high.x - low.x + 2 * contact) / side_));
  rows_ = std::size_t(std::ceil((high.y - low.y + 2 * contact) / side_));
  bucket_ = std::max(side_ / 2, std::max(high.x - low.x, high.y - low.y) / 2048);
}

std::vector<std::size_t> CoverProof::all_tiles() const {
  std::vector<std::size_t> tiles(tile_count());
  for (std::size_t t = 0; t < tiles.size(); ++t) tiles[t] = t;
  return tiles;
}

void CoverProof::add(const PathPiece& piece) {
  const double far = std::hypot(piece.to.x - piece.from.x, piece.to.y - piece.from.y);
  const double count = std::max(1.0, std::ceil(far / bucket_));
  for (double n = 0; n < count; ++n)
    pieces_.push_back({piece.from + (n / count) * (piece.to - piece.from),
                       n + 1 == count ? piece.to : piece.from + ((n + 1) / count) * (piece.to - piece.from)});
}

void CoverProof::add(const Cut& cut) {
  const Point3 origin = cutter_.terrain().origin();
  Point3 at = cut.start;
  if (cut.moves.empty()) add({at - origin, at - origin});
  std::vector<Point3> points;
  for (const Move& m : cut.moves) {
    points.clear();
    if (m.kind == MoveKind::line || m.kind == MoveKind::rapid)
      points.push_back(m.end);
    else
      append_chords(at, m, o_.off, points);
    for (const Point3 p : points) {
      if (m.kind != MoveKind::rapid) add({at - origin, p - origin});
      at = p;
    }
  }
}

/// By the cell of a raster in which the middle of a piece lies.
void CoverProof::sort_pieces() {
  if (sorted_ == pieces_.size() && !begin_.empty()) return;
  across_ = std::size_t(std::ceil(double(columns_) * side_ / bucket_)) + 1;
  up_ = std::size_t(std::ceil(double(rows_) * side_ / bucket_)) + 1;
  const auto cell = [&](const PathPiece& p) {
    const double x = ((p.from.x + p.to.x) / 2 - first_.x) / bucket_, y = ((p.from.y + p.to.y) / 2 - first_.y) / bucket_;
    const auto in = [](double v, std::size_t count) {
      return std::size_t(std::clamp(std::floor(v), 0.0, double(count - 1)));
    };
    return in(y, up_) * across_ + in(x, across_);
  };
  begin_.assign(across_ * up_ + 1, 0);
  for (const PathPiece& p : pieces_) ++begin_[cell(p) + 1];
  for (std::size_t k = 0; k + 1 < begin_.size(); ++k) begin_[k + 1] += begin_[k];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  std::vector<PathPiece> sorted(pieces_.size());
  for (const PathPiece& p : pieces_) sorted[next[cell(p)]++] = p;
  pieces_ = std::move(sorted);
  sorted_ = pieces_.size();
}

bool CoverProof::run(const std::vector<std::size_t>& tiles, const std::function<bool(Point3, double)>& is_of_interest,
                     const Context& context, std::vector<Point3>& open, std::vector<std::size_t>& open_tiles) {
  sort_pieces();
  std::vector<std::vector<Point3>> found(tiles.size());
  const bool done = kernel::parallel_blocks(context, tiles.size(), 8, [&](std::size_t first, std::size_t last) {
    CoverTile tile(*this, is_of_interest);
    for (std::size_t k = first; k < last; ++k) tile.run(tiles[k], found[k]);
  });
  open.clear(), open_tiles.clear();
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    if (!found[k].empty()) open_tiles.push_back(tiles[k]);
    open.insert(open.end(), found[k].begin(), found[k].end());
  }
  return done;
}

}  // namespace krepl::mill
