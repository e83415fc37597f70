#include "zone/nesting.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/box_tree.hpp"
#include "kernel/odd_ones.hpp"
#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "zone/arc_turn.hpp"
#include "zone/polygon_locator.hpp"
#include "zone/ray_crossing.hpp"

namespace krepl::zone {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Index chunk = 16;  // consecutive pieces under one box

using kernel::Box;

using vectors::cross;

double radius_of(const Zone::Piece& piece, double radius) { return piece.radius > 0 ? piece.radius : radius; }

/// Everything about one piece that the ray needs.
class PieceShape {
 public:
  PieceShape(const Instance& in, Index element, Point p, Point q) : p_(p), q_(q), radius_(in.nominal_radius_of(element)) {
    arc_ = !in.is_side(element);
    if (arc_) centre_ = in.vertices()[in.vertex_of(element)];
  }
  /// Where the arc runs clockwise, its counter-clockwise reverse has the same points.
  PieceShape(const Zone::Piece& piece, double radius)
      : p_(piece.clockwise ? piece.end : piece.start),
        q_(piece.clockwise ? piece.start : piece.end),
        centre_(piece.center),
        radius_(radius_of(piece, radius)),
        arc_(piece.kind == Zone::Kind::arc),
        short_(arc_ && piece.from_arc && is_short_arc(piece)) {
    if (!short_) return;
    const double dx = q_.x - p_.x, dy = q_.y - p_.y, chord = std::hypot(dx, dy);
    const double height = std::sqrt((radius_ - chord / 2) * (radius_ + chord / 2));
    to_centre_ = {dx / 2 - dy / chord * height, dy / 2 + dx / chord * height};
  }

  Box box() const {
    Box b;
    b.add(p_);
    b.add(q_);
    if (!arc_) return b;
    if (short_) {
      const double chord = std::hypot(q_.x - p_.x, q_.y - p_.y), bulge = chord * chord / (4 * radius_);
      return {b.min_x - bulge, b.min_y - bulge, b.max_x + bulge, b.max_y + bulge};
    }
    const Point c = centre_;
    for (const Point e : {Point{c.x + radius_, c.y}, {c.x, c.y + radius_}, {c.x - radius_, c.y}, {c.x, c.y - radius_}}) {
      if (on_arc(e)) b.add(e);
    }
    return b;
  }

  Point leftmost() const {
    if (short_) {
      const Point w = to_centre_, e{p_.x - w.y * w.y / (radius_ + w.x), p_.y + w.y};
      if (w.x > 0 && on_arc(e)) return e;
      return p_.x <= q_.x ? p_ : q_;
    }
    const Point e{centre_.x - radius_, centre_.y};
    if (arc_ && on_arc(e)) return e;
    return p_.x <= q_.x ? p_ : q_;
  }

  /// True if the ray from a place to the left crosses the piece an odd number of times.
  bool is_crossed(Point from) const {
    if (!arc_) return ray_crosses_segment(p_, q_, from);
    const Point v{from.x - p_.x, from.y - p_.y}, u{from.x - centre_.x, from.y - centre_.y};
    const bool in_circle = short_ ? v.x * (v.x - 2 * to_centre_.x) + v.y * (v.y - 2 * to_centre_.y) < 0
                                  : std::hypot(u.x, u.y) < radius_;
    return ray_crosses_arc(p_, q_, true, in_circle, from);
  }

  double chord() const { return p_ == q_ && arc_ ? 2 * radius_ : std::hypot(q_.x - p_.x, q_.y - p_.y); }

  Point middle() const {
    const Point m{p_.x + (q_.x - p_.x) / 2, p_.y + (q_.y - p_.y) / 2};
    if (!arc_) return m;
    if (p_ == q_) return {2 * centre_.x - p_.x, 2 * centre_.y - p_.y};
    const double length = chord(), half = length / 2;
    const double off = std::sqrt(std::max(0.0, (radius_ - half) * (radius_ + half)));  // of the centre from the chord
    const double height = short_ || cross(p_, q_, centre_) > 0 ? half * half / (radius_ + off) : radius_ + off;
    return {m.x + (q_.y - p_.y) / length * height, m.y - (q_.x - p_.x) / length * height};
  }

  /// The largest x below `limit_x` at height y on the piece; -infinity if there is none. What comes within `slack` of the ray
  /// counts as hit: no boundary fits in between, so it borders the same face.
  double hit_left_of(double limit_x, double y, double slack) const {
    double best = -infinity;
    const auto take = [&](double x) {
      if (x < limit_x) best = std::max(best, x);
    };
    if (std::abs(p_.y - y) <= slack) take(p_.x);
    if (std::abs(q_.y - y) <= slack) take(q_.x);
    if (!arc_) {
      if ((p_.y < y) != (q_.y < y)) take(p_.x + (y - p_.y) / (q_.y - p_.y) * (q_.x - p_.x));
      return best;
    }
    if (short_) return std::max(best, short_hit_left_of(limit_x, y, slack));
    const double dy = y - centre_.y;
    const double square = (radius_ - dy) * (radius_ + dy);
    if (square < -2 * radius_ * slack) return best;
    const double half = std::sqrt(std::max(square, 0.0));
    for (const double x : {centre_.x - half, centre_.x + half}) {
      if (on_arc({x, y}) || near_chord({x, y}, slack)) take(x);
    }
    return best;
  }

 private:
  /// For a point of the circle: is it on the arc from p counter-clockwise to q?
  bool on_arc(Point e) const {
    return p_ == q_ || cross(p_, q_, e) <= 0;  // right of the chord
  }

  /// From p on, so that a centre far away does not matter: places v from it on the circle have v.v = 2 v.w, w the way to
  /// the centre.
  double short_hit_left_of(double limit_x, double y, double slack) const {
    double best = -infinity;
    const Point w = to_centre_;
    const double dy = y - p_.y, rest = dy * (dy - 2 * w.y), square = w.x * w.x - rest;
    if (square < -2 * radius_ * slack) return best;
    const double large = w.x + std::copysign(std::sqrt(std::max(square, 0.0)), w.x), small = large != 0 ? rest / large : 0;
    for (const double dx : {large, small}) {
      const Point e{p_.x + dx, y};
      if ((on_arc(e) || near_chord(e, slack)) && e.x < limit_x) best = std::max(best, e.x);
    }
    return best;
  }

  /// A short arc is flatter than the error of its ends.
  bool near_chord(Point e, double slack) const {
    const double dx = q_.x - p_.x, dy = q_.y - p_.y, square = dx * dx + dy * dy;
    const double along = (e.x - p_.x) * dx + (e.y - p_.y) * dy, across = cross(p_, q_, e);
    return along >= 0 && along <= square && across * across <= slack * slack * square;
  }

  Point p_, q_, centre_;
  double radius_;
  bool arc_;
  bool short_ = false;  // an arc from_arc that chord and radius tell
  Point to_centre_;     // of a short one, from p
};

template <class AnyRings>
std::vector<Index> rings_of_pieces(const AnyRings& rings) {
  std::vector<Index> ring_of(rings.begin.back());
  for (Index r = 0; r < rings.ring_count(); ++r)
    std::fill(ring_of.begin() + rings.begin[r], ring_of.begin() + rings.begin[r + 1], r);
  return ring_of;
}

bool runs_clockwise(const Instance& in, const Rings& rings, Index r);
bool runs_clockwise(const ShapedRings& rings, double radius, Index r);

/// Rings as nesting sees them.
class Picture {
 public:
  Picture(const Instance& in, const Rings& rings) : in_(in), rings_(rings), ring_of_(rings_of_pieces(rings)) {}
  PieceShape shape(Index e) const {
    return {in_, rings_.element[e], rings_.vertex[e], rings_.vertex[rings_.next(ring_of_[e], e)]};
  }
  Index ring_of(Index e) const { return ring_of_[e]; }
  const std::vector<Index>& begin() const { return rings_.begin; }
  bool clockwise(Index r) const { return runs_clockwise(in_, rings_, r); }

 private:
  const Instance& in_;
  const Rings& rings_;
  std::vector<Index> ring_of_;
};

class ShapedPicture {
 public:
  ShapedPicture(const ShapedRings& rings, double radius)
      : rings_(rings), radius_(radius), ring_of_(rings_of_pieces(rings)) {}
  PieceShape shape(Index e) const { return {rings_.piece[e], radius_}; }
  Index ring_of(Index e) const { return ring_of_[e]; }
  const std::vector<Index>& begin() const { return rings_.begin; }
  bool clockwise(Index r) const {
    return rings_.clockwise.empty() ? runs_clockwise(rings_, radius_, r) : rings_.clockwise[r];
  }

 private:
  const ShapedRings& rings_;
  double radius_;
  std::vector<Index> ring_of_;
};

Error hole_in_nothing(Point at) {
  return {ErrorCode::computation, "the rings could not be nested: a hole lies in no ring",
          "near x " + std::to_string(at.x) + ", y " + std::to_string(at.y) + " relative to the data's origin",
          "please report this input"};
}

bool runs_clockwise(const Instance& in, const Rings& rings, Index r) {
  double area = 0;
  const Index first = rings.begin[r];
  for (Index e = first; e < rings.begin[r + 1]; ++e) {
    area += twice_area(in, rings.element[e], rings.vertex[e], rings.vertex[rings.next(r, e)], rings.vertex[first]);
  }
  return area < 0;
}

bool runs_clockwise(const ShapedRings& rings, double radius, Index r) {
  double twice = 0;
  const Point base = rings.piece[rings.begin[r]].start;
  for (Index e = rings.begin[r]; e < rings.begin[r + 1]; ++e) {
    const Zone::Piece& p = rings.piece[e];
    twice += cross(base, p.start, p.end);
    if (p.kind != Zone::Kind::arc) continue;
    if (p.from_arc) {
      twice += twice_bulge(p);
      continue;
    }
    const Point from = p.clockwise ? p.end : p.start, to = p.clockwise ? p.start : p.end, c = p.center;
    double angle = std::atan2(cross(c, from, to), (from.x - c.x) * (to.x - c.x) + (from.y - c.y) * (to.y - c.y));
    if (from == to) angle = 2 * M_PI;
    else if (angle < -1e-6) angle += 2 * M_PI;  // else a short arc whose ends are rounded
    const double own = radius_of(p, radius);
    twice += (p.clockwise ? -1 : 1) * own * own * (angle - std::sin(angle));
  }
  return twice < 0;
}

template <class AnyPicture>
kernel::BoxTree tree_of(const AnyPicture& picture, double slack, const Context& quiet) {
  const std::size_t pieces = picture.begin().back();
  std::vector<Box> boxes((pieces + chunk - 1) / chunk);
  kernel::parallel_blocks(quiet, boxes.size(), 1 << 10, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from * chunk; i < std::min(pieces, to * chunk); ++i) {
      Box b = picture.shape(Index(i)).box();
      b.min_y -= slack;
      b.max_y += slack;
      boxes[i / chunk].add(b);
    }
  });
  return kernel::BoxTree(std::move(boxes));
}

/// Rings that may touch in places: each is looked at from the middle of its longest piece, and lies in the innermost of
/// the rings that hold that.
Result<Nesting> nest_touching(const ShapedPicture& picture, double slack, const Context& context) {
  const std::vector<Index>& begin = picture.begin();
  const Index count = Index(begin.size() - 1);
  Context quiet;
  quiet.threads = context.threads;
  const kernel::BoxTree tree = tree_of(picture, slack, quiet);
  std::vector<Point> place(count);
  std::vector<std::vector<Index>> around(count);  // the rings that hold it
  kernel::parallel_blocks(quiet, count, 64, [&](std::size_t from, std::size_t to) {
    std::vector<Index> crossed;
    for (std::size_t r = from; r < to; ++r) {
      double longest = -1;
      for (Index e = begin[r]; e < begin[r + 1]; ++e) {
        const auto shape = picture.shape(e);
        if (shape.chord() > longest) longest = shape.chord(), place[r] = shape.middle();
      }
      crossed.clear();
      tree.visit_left_of(place[r], [] { return -infinity; }, [&](std::size_t box) {
        for (std::size_t e = box * chunk; e < std::min<std::size_t>(begin.back(), (box + 1) * chunk); ++e)
          if (picture.ring_of(Index(e)) != r && picture.shape(Index(e)).is_crossed(place[r]))
            crossed.push_back(picture.ring_of(Index(e)));
      });
      kernel::keep_odd_ones(crossed);
      around[r] = crossed;
    }
  });
  Nesting nesting{std::vector<bool>(count), std::vector<Index>(count, none)};
  for (Index r = 0; r < count; ++r) {
    nesting.is_hole[r] = picture.clockwise(r);
    for (const Index s : around[r])
      if (picture.clockwise(s) != nesting.is_hole[r] &&
          (nesting.parent[r] == none || around[s].size() > around[nesting.parent[r]].size()))
        nesting.parent[r] = s;
    if (nesting.is_hole[r] && nesting.parent[r] == none) return hole_in_nothing(place[r]);
  }
  return nesting;
}

template <class AnyPicture>
Result<Nesting> nest_picture(const AnyPicture& picture, double slack, const Context& context) {
  const std::vector<Index>& begin = picture.begin();
  const Index count = Index(begin.size() - 1);
  Nesting nesting{std::vector<bool>(count), std::vector<Index>(count, none)};

  Context quiet;
  quiet.threads = context.threads;
  std::vector<char> clockwise(count);
  std::vector<Point> leftmost(count, {infinity, 0});
  kernel::parallel_blocks(quiet, count, 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t r = from; r < to; ++r) {
      clockwise[r] = picture.clockwise(Index(r));
      for (Index e = begin[r]; e < begin[r + 1]; ++e) {
        const Point p = picture.shape(e).leftmost();
        if (p.x < leftmost[r].x) leftmost[r] = p;
      }
    }
  });
  const std::size_t pieces = begin.back();
  const kernel::BoxTree tree = tree_of(picture, slack, quiet);

  std::vector<Index> met(count, none);  // the ring that the ray to the left meets first
  kernel::parallel_blocks(quiet, count, 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t r = from; r < to; ++r) {
      double best = -infinity;
      tree.visit_left_of(leftmost[r], [&] { return best; }, [&](std::size_t box) {
        for (std::size_t e = box * chunk; e < std::min(pieces, (box + 1) * chunk); ++e) {
          if (picture.ring_of(Index(e)) == r) continue;
          const double x = picture.shape(Index(e)).hit_left_of(leftmost[r].x, leftmost[r].y, slack);
          if (x > best) best = x, met[r] = picture.ring_of(Index(e));
        }
      });
    }
  });

  // The ring met lies further left, so in this order its own parent is known.
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index r, Index s) {
    return leftmost[r].x != leftmost[s].x ? leftmost[r].x < leftmost[s].x : r < s;
  });
  for (const Index r : order) {
    nesting.is_hole[r] = clockwise[r];
    const Index s = met[r];
    if (s == none && clockwise[r]) return hole_in_nothing(leftmost[r]);
    if (s == none) continue;
    // Same kind: both border the same face. Different kinds: r lies directly in s.
    nesting.parent[r] = bool(clockwise[s]) == bool(clockwise[r]) ? nesting.parent[s] : s;
  }
  return nesting;
}

}  // namespace

Result<Nesting> nest(const Instance& in, const Rings& rings, const Context& context) {
  const double slack = 2 * in.enlargement();  // the least distance of opposite boundaries; vertices are that exact
  return nest_picture(Picture(in, rings), slack, context);
}

Result<Nesting> nest(const ShapedRings& rings, double radius, double slack, const Context& context) {
  const ShapedPicture picture(rings, radius);
  if (rings.touch) {
    // A ring that is narrower than the slack may seem to lie in none; the other way it counts as near enough.
    auto nesting = nest_touching(picture, slack, context);
    if (nesting.ok()) return nesting;
  }
  return nest_picture(picture, slack, context);
}

Rings drop_rings_inside_polygons(const Network& network, Rings rings) {
  const PolygonLocator polygons(network);
  std::vector<std::int64_t> around;
  Rings kept;
  for (Index r = 0; r < rings.ring_count(); ++r) {
    const auto first = rings.begin[r], last = rings.begin[r + 1];
    polygons.find(rings.vertex[first], around);
    if (!around.empty()) continue;
    kept.element.insert(kept.element.end(), rings.element.begin() + first, rings.element.begin() + last);
    kept.vertex.insert(kept.vertex.end(), rings.vertex.begin() + first, rings.vertex.begin() + last);
    kept.begin.push_back(Index(kept.element.size()));
  }
  return kept;
}

ShapedRings rings_by_polygons(const Network& network, const ShapedRings& rings, Point origin, bool inside) {
  const PolygonLocator polygons(network);
  std::vector<std::int64_t> around;
  const Point shift{origin.x - network.origin().x, origin.y - network.origin().y};
  return rings_where(rings, [&](Point start) {
    polygons.find({start.x + shift.x, start.y + shift.y}, around);
    return !around.empty() == inside;
  });
}

}  // namespace krepl::zone
