#include "verify/profile_verifier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "verify/plane.hpp"

namespace krepl::verify {

namespace {

using Record = input::ProfileRecord;
using Kind = Record::Kind;

/// Adds up one kind of check.
class Tally {
 public:
  Tally(const char* name, Real limit) {
    check_.name = name;
    check_.limit = double(limit);
  }
  void deviation(Real value, Vec where) {
    ++check_.tested;
    if (!(value <= Real(check_.limit))) ++check_.violations;
    if (!(value <= Real(check_.worst))) {
      check_.worst = double(value);
      check_.where = {double(where.x), double(where.y)};
    }
  }
  void require(bool right, const std::string& what, Vec where) {
    ++check_.tested;
    if (right) return;
    if (check_.violations++ == 0) {
      check_.note = what;
      check_.where = {double(where.x), double(where.y)};
    }
  }
  const Check& check() const { return check_; }

 private:
  Check check_;
};

/// The solid terrain, in blocks of segments with their boxes, so that brute force stays affordable for 1e6 segments and
/// any radius: a block that cannot hold anything nearer (or higher) is skipped as a whole.
class SolidTerrain {
 public:
  explicit SolidTerrain(std::span<const Point> points) : points_(points) {
    const std::size_t leaves = std::max<std::size_t>(1, (points.size() + leaf - 2) / leaf);
    levels_.emplace_back(leaves);
    for (std::size_t i = 0; i < points.size(); ++i) {
      levels_[0][std::min(i / leaf, leaves - 1)].add(points[i]);
      if (i > 0 && i % leaf == 0 && i / leaf <= leaves) levels_[0][i / leaf - 1].add(points[i]);  // the block's last end
    }
    while (levels_.back().size() > 1) {
      const std::vector<Box>& below = levels_.back();
      std::vector<Box> boxes((below.size() + 1) / 2);
      for (std::size_t i = 0; i < below.size(); ++i) boxes[i / 2].add(below[i]);
      levels_.push_back(std::move(boxes));
    }
  }

  /// Distance to the polyline.
  Real distance(Vec p) const {
    Real best = length(p - points_[0]);
    nearest(levels_.size() - 1, 0, p, best);
    return best;
  }

  /// Height of the polyline at x: its highest point there. -infinity outside.
  Real height(Real x) const {
    if (x < points_.front().x || x > points_.back().x) return -HUGE_VALL;
    auto first = std::lower_bound(points_.begin(), points_.end(), x, [](const Point& p, Real v) { return p.x < v; });
    Real best = -HUGE_VALL;
    if (first != points_.begin()) best = on_segment(first[-1], *first, x);
    for (; first != points_.end() && Real(first->x) == x; ++first) best = std::max(best, Real(first->y));
    return best;
  }

  /// The upper envelope of the disks about all points of the terrain. -infinity outside.
  Real envelope(Real x, Real radius) const {
    Real best = -HUGE_VALL;
    highest(levels_.size() - 1, 0, x, radius, best);
    return best;
  }

 private:
  static constexpr std::size_t leaf = 8;

  static Real on_segment(Vec a, Vec b, Real x) {
    return b.x > a.x ? a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x)) : std::max(a.y, b.y);
  }

  template <class F>
  void each_segment(std::size_t block, F&& f) const {
    const std::size_t first = block * leaf, last = std::min(points_.size() - 1, first + leaf);
    if (points_.size() == 1) f(points_[0], points_[0]);
    for (std::size_t i = first; i < last; ++i) f(points_[i], points_[i + 1]);
  }

  void nearest(std::size_t level, std::size_t block, Vec p, Real& best) const {
    if (levels_[level][block].square_distance(p) * (1 - 1e-15L) > best * best) return;
    if (level == 0)
      return each_segment(block, [&](Vec a, Vec b) { best = std::min(best, distance_to_segment(p, a, b)); });
    const std::vector<Box>& below = levels_[level - 1];
    std::size_t near = 2 * block, far = std::min(2 * block + 1, below.size() - 1);
    if (below[far].square_distance(p) < below[near].square_distance(p)) std::swap(near, far);
    nearest(level - 1, near, p, best);
    if (far != near) nearest(level - 1, far, p, best);
  }

  /// Top of the disk about point c of the terrain above x, if it reaches x.
  static Real top(Vec c, Real x, Real radius) {
    const Real dx = x - c.x, square = (radius - dx) * (radius + dx);
    return square >= 0 ? c.y + std::sqrt(square) : -HUGE_VALL;
  }

  void highest(std::size_t level, std::size_t block, Real x, Real radius, Real& best) const {
    const Box& box = levels_[level][block];
    if (box.x0 > x + radius || box.x1 < x - radius || box.y1 + radius <= best) return;
    if (level == 0) return each_segment(block, [&](Vec a, Vec b) { best = std::max(best, segment_top(a, b, x, radius)); });
    const std::vector<Box>& below = levels_[level - 1];
    std::size_t first = 2 * block, second = std::min(2 * block + 1, below.size() - 1);
    if (below[second].y1 > below[first].y1) std::swap(first, second);
    highest(level - 1, first, x, radius, best);
    if (second != first) highest(level - 1, second, x, radius, best);
  }

  static Real segment_top(Vec a, Vec b, Real x, Real radius) {
    Real best = std::max(top(a, x, radius), top(b, x, radius));
    const Real l = length(b - a);
    if (!(b.x > a.x)) return best;
    const Real touch = x + radius * ((b.y - a.y) / l);  // where a disk centred above x touches the line from above
    if (touch > a.x && touch < b.x) best = std::max(best, on_segment(a, b, touch) + radius * ((b.x - a.x) / l));
    return best;
  }

  std::span<const Point> points_;
  std::vector<std::vector<Box>> levels_;
};

Real distance_to_piece(Vec p, const Record& piece, Real radius) {
  Vec a = piece.start, b = piece.end;
  if (piece.kind == Kind::half_line) {
    const Vec top = std::isinf(piece.start.y) ? b : a;
    return p.y <= top.y ? std::abs(p.x - top.x) : distance(p, top);
  }
  if (piece.kind == Kind::segment) return distance_to_segment(p, a, b);
  const Vec c = piece.center, s = a - c, e = b - c, q = p - c;
  // Clockwise by at most half a turn, all of it above c: q lies between s and e if it is right of s and left of e.
  if (cross(s, q) <= 0 && cross(q, e) <= 0 && q.y >= -1e-12L * radius) return std::abs(length(q) - radius);
  return std::min(distance(p, a), distance(p, b));
}

Vec sample_of(const Record& piece, Real t, Real radius) {
  const Vec a = piece.start, b = piece.end;
  if (piece.kind == Kind::segment) return a + t * (b - a);
  const Vec c = piece.center, s = a - c, e = b - c;
  Real sweep = std::atan2(-cross(s, e), dot(s, e));
  if (sweep < 0) sweep += 2 * std::acos(Real(-1));  // an arc that goes the wrong way is sampled all around, and fails
  const Real cosine = std::cos(t * sweep), sine = std::sin(t * sweep);
  const Real factor = radius / length(s);
  return c + factor * Vec(cosine * s.x + sine * s.y, cosine * s.y - sine * s.x);
}

class ProfileChecker {
 public:
  ProfileChecker(std::span<const Point> terrain, std::span<const Record> pieces, const ProfileCheckOptions& options)
      : points_(terrain), pieces_(pieces), options_(options), radius_(options.radius), terrain_(terrain) {
    Box box;
    for (const Point& p : terrain) box.add(p);
    const Real extent = std::max(box.x1 - box.x0, box.y1 - box.y0) / 2;
    const Real size = std::max({std::abs(box.x0), std::abs(box.x1), std::abs(box.y0), std::abs(box.y1)}) + radius_;
    scale_ = std::max(radius_, extent);
    tolerance_ = std::max(1e-9L * scale_, 64 * std::numeric_limits<double>::epsilon() * size);
  }

  Result<ProfileReport> run(const Context& context) {
    report_.radius = options_.radius;
    report_.scale = double(scale_);
    report_.tolerance = double(tolerance_);
    report_.pieces = pieces_.size();
    for (std::size_t i = 1; i < points_.size(); ++i) report_.segments += points_[i] != points_[i - 1];
    form();
    if (!report_.ok()) return report_;  // the rest takes a chain between two half-lines for granted
    continuity();
    causes();
    if (!distances(context) || !heights(context)) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    return report_;
  }

 private:
  static Vec top_of(const Record& half_line) {
    return std::isinf(half_line.start.y) ? half_line.end : half_line.start;
  }

  void form() {
    Tally tally("form", 0);
    tally.require(pieces_.size() >= 3, "fewer than three pieces", points_[0]);
    if (pieces_.size() < 3) return report_.checks.push_back(tally.check());
    const Record &first = pieces_.front(), &last = pieces_.back();
    const Real down = -HUGE_VALL;
    tally.require(first.kind == Kind::half_line && Real(first.start.y) == down && std::isfinite(first.end.y),
                  "does not begin with a half-line from -inf up", first.end);
    tally.require(last.kind == Kind::half_line && Real(last.end.y) == down && std::isfinite(last.start.y),
                  "does not end with a half-line down to -inf", last.start);
    for (std::size_t k = 1; k + 1 < pieces_.size(); ++k)
      tally.require(pieces_[k].kind != Kind::half_line, "a half-line between other pieces", pieces_[k].start);
    for (const Record& piece : pieces_) {
      report_.arcs += piece.kind == Kind::arc;
      const std::size_t causes = piece.by_segment ? points_.size() - 1 : points_.size();
      tally.require(piece.by_segment == (piece.kind == Kind::segment) && piece.cause < causes,
                    "names a segment or vertex that cannot cause it", piece.end);
    }
    const std::size_t n = report_.segments;
    tally.require(pieces_.size() - 1 <= 2 * n + 2, "more than 2n + 2 vertices", last.start);
    if (tally.check().ok()) report_.explicit_vertices = count_explicit();
    tally.require(report_.explicit_vertices <= (n > 0 ? n - 1 : 0), "more than n - 1 explicit vertices", last.start);
    report_.checks.push_back(tally.check());
  }

  /// Vertices where the two pieces' causes do not touch each other, or form a valley.
  std::size_t count_explicit() const {
    std::size_t count = 0;
    for (std::size_t k = 2; k + 1 < pieces_.size(); ++k) {
      const Record &p = pieces_[k - 1], &q = pieces_[k];
      const Vec p_end = points_[p.cause + (p.by_segment ? 1 : 0)], q_start = points_[q.cause];
      const bool touching = p_end.x == q_start.x && p_end.y == q_start.y;
      if (!touching) ++count;
      else if (p.by_segment && q.by_segment)
        count += cross(p_end - Vec(points_[p.cause]), Vec(points_[q.cause + 1]) - q_start) > 0;
    }
    return count;
  }

  void continuity() {
    Tally tally("continuity", tolerance_);
    tally.deviation(distance(top_of(pieces_.front()), pieces_[1].start), pieces_[1].start);
    for (std::size_t k = 2; k + 1 < pieces_.size(); ++k)
      tally.deviation(distance(pieces_[k - 1].end, pieces_[k].start), pieces_[k].start);
    tally.deviation(distance(pieces_[pieces_.size() - 2].end, top_of(pieces_.back())), top_of(pieces_.back()));
    for (const Record* h : {&pieces_.front(), &pieces_.back()})
      tally.deviation(std::abs(Real(h->start.x) - h->end.x), top_of(*h));
    tally.deviation(std::abs(top_of(pieces_.front()).x - (Real(points_.front().x) - radius_)), top_of(pieces_.front()));
    tally.deviation(std::abs(top_of(pieces_.back()).x - (Real(points_.back().x) + radius_)), top_of(pieces_.back()));
    report_.checks.push_back(tally.check());
  }

  void causes() {
    Tally shape("radius and distance of cause", tolerance_), direction("direction", tolerance_);
    for (std::size_t k = 1; k + 1 < pieces_.size(); ++k) {
      const Record& piece = pieces_[k];
      const Vec a = piece.start, b = piece.end;
      direction.deviation(a.x - b.x, a);  // what goes left, goes left by rounding only
      if (piece.kind == Kind::arc) {
        const Vec c = piece.center, s = a - c, e = b - c;
        shape.deviation(distance(c, points_[piece.cause]), c);
        shape.deviation(std::abs(length(s) - radius_), a);
        shape.deviation(std::abs(length(e) - radius_), b);
        // The whole of it is above its centre, so its turn is clockwise and at most half a circle.
        direction.deviation(std::max(-s.y, -e.y), a);
        direction.deviation(cross(s, e) > 0 && dot(s, e) > 0 ? distance(a, b) + radius_ : 0, a);
      } else {
        const Vec v = points_[piece.cause], w = points_[piece.cause + 1];
        const Real l = length(w - v);
        if (!(l > 0)) {
          shape.deviation(HUGE_VALL, a);
          continue;
        }
        for (const Vec p : {a, b}) {
          shape.deviation(std::abs(cross(w - v, p - v) / l - radius_), p);
          const Real along = dot(w - v, p - v) / l;
          shape.deviation(std::max(-along, along - l), p);
        }
        direction.deviation(-dot(w - v, b - a) / l, a);
      }
    }
    report_.checks.push_back(shape.check());
    report_.checks.push_back(direction.check());
  }

  bool distances(const Context& context) {
    Tally tally("distance to the terrain", tolerance_), above("not below the terrain", 0);
    std::mt19937_64 random(options_.seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto look = [&](Vec p) {
      tally.deviation(std::abs(terrain_.distance(p) - radius_), p);
      above.require(p.y + tolerance_ > terrain_.height(p.x), "a boundary point inside the solid", p);
    };
    for (std::size_t k = 1; k + 1 < pieces_.size(); ++k) {
      if (k % 4096 == 0 && context.cancelled()) return false;
      look(pieces_[k].start);
      look(sample_of(pieces_[k], 0.5L, radius_));
      for (int i = 1; i < options_.samples_per_piece; ++i) look(sample_of(pieces_[k], unit(random), radius_));
      if (context.progress && k % 4096 == 0) context.progress(0.8 * double(k) / double(pieces_.size()));
    }
    look(pieces_[pieces_.size() - 2].end);
    report_.checks.push_back(tally.check());
    report_.checks.push_back(above.check());
    return true;
  }

  /// The envelope's point above x must be on the boundary. Its distance to the boundary is what counts, not the difference
  /// in height, which rounding in x makes large where the boundary is steep.
  bool heights(const Context& context) {
    Tally tally("height against the envelope", tolerance_);
    std::mt19937_64 random(options_.seed + 1);
    const Real x0 = Real(points_.front().x) - radius_, x1 = Real(points_.back().x) + radius_;
    std::uniform_real_distribution<double> unit(0, 1);
    const std::uint64_t count =
        options_.heights != 0 ? options_.heights : std::clamp<std::uint64_t>(points_.size(), 100, 1000000);
    for (std::uint64_t i = 0; i < count; ++i) {
      if (i % 4096 == 0 && context.cancelled()) return false;
      // Half of them about the pieces, which may be much narrower than the whole.
      Real x = x0 + (x1 - x0) * Real(unit(random));
      if (i % 2 == 1) {
        const Record& piece = pieces_[1 + random() % (pieces_.size() - 2)];
        x = std::clamp(piece.start.x + (Real(piece.end.x) - piece.start.x) * Real(unit(random)), x0, x1);
      }
      const Vec truth(x, terrain_.envelope(x, radius_));
      tally.deviation(std::isinf(truth.y) ? 0 : distance_to_boundary(truth), truth);
    }
    report_.checks.push_back(tally.check());
    return true;
  }

  Real distance_to_boundary(Vec p) const {
    const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), p.x,
                                        [](Real x, const Record& piece) { return x < Real(piece.start.x); });
    const auto here = std::size_t(after - pieces_.begin());
    Real best = HUGE_VALL;
    // Neighbours too: pieces near the same x, walls above all, may come in one or the other order.
    constexpr std::size_t some = 4;
    for (std::size_t k = here; k-- > 0 && (here - k <= some || Real(pieces_[k].end.x) >= p.x - tolerance_);)
      best = std::min(best, distance_to_piece(p, pieces_[k], radius_));
    for (std::size_t k = here; k < pieces_.size() && (k - here < some || Real(pieces_[k].start.x) <= p.x + tolerance_); ++k)
      best = std::min(best, distance_to_piece(p, pieces_[k], radius_));
    return best;
  }

  std::span<const Point> points_;
  std::span<const Record> pieces_;
  ProfileCheckOptions options_;
  Real radius_, scale_ = 0, tolerance_ = 0;
  SolidTerrain terrain_;
  ProfileReport report_;
};

}  // namespace

Result<ProfileReport> check_profile(std::span<const Point> terrain, std::span<const Record> pieces,
                                    const ProfileCheckOptions& options, const Context& context) {
  if (!(options.radius > 0) || !std::isfinite(options.radius))
    return Error{ErrorCode::usage, "radius is not a finite positive number", "", "check --radius"};
  if (terrain.empty()) return Error{ErrorCode::input, "the terrain has no point", "", ""};
  for (std::size_t i = 0; i < terrain.size(); ++i) {
    const std::string where = "vertex " + std::to_string(i);
    if (!std::isfinite(terrain[i].x) || !std::isfinite(terrain[i].y))
      return Error{ErrorCode::input, "a coordinate is not finite", where, ""};
    if (i > 0 && terrain[i].x < terrain[i - 1].x) return Error{ErrorCode::input, "x decreases", where, ""};
  }
  return ProfileChecker(terrain, pieces, options).run(context);
}

}  // namespace krepl::verify
