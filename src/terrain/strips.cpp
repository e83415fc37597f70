#include <algorithm>

#include "terrain/cells.hpp"

// Cells that curves pass side by side.
namespace krepl::terrain {
namespace {

template <class Point, class Real = decltype(Point::x)>
Real distance(Point p, Point a, Point b) {
  const Real dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const Real t = square > 0 ? std::clamp<Real>(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0, 1) : Real(0);
  return norm<Real>(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/// Of two segments whose ends lie on the border of a box, not crossing each other.
template <class Point, class Real = decltype(Point::x)>
Real distance(Point a, Point b, Point c, Point d) {
  return std::min({distance(a, c, d), distance(b, c, d), distance(c, a, b), distance(d, a, b)});
}

}  // namespace

/// True if the curves of both turns are sides of one patch, which lies between them.
template <class Real>
bool Cells<Real>::sides_of_one_patch(const Turn& s, const Turn& t, const Box& box, Index& patch) const {
  const auto is_side = [&](const Turn& turn) {
    return turn.meeting != Meeting::valley || is_thin_bend(turn.before, turn.after, box);
  };
  if (!is_side(s) || !is_side(t)) return false;
  for (const Index l : {s.before, s.after}) {
    if (l == none || (l != t.before && l != t.after)) continue;
    const auto own = [&](const Turn& turn) { return turn.meeting != Meeting::rim || is_wall_of(turn, l); };
    if (own(s) && own(t)) {
      patch = l;
      return true;
    }
  }
  return false;
}

/// True if the straight wall between two turns is nowhere reached by the other patch of the valley beside it: that
/// one's height is concave, so its tangent bounds it, or it ends in a wall of its own before.
template <class Real>
bool Cells<Real>::wall_keeps_off(const Turn& from, Point to, const Turn& valley) const {
  const Index upper = sides_of_wall(from).first;
  const Index other = valley.before == upper ? valley.after : valley.before;
  if (valley.before != upper && valley.after != upper) return false;
  const PatchSet<Real>& patches = envelope_.patches();
  if (patches[upper].kind != Terrain::FeatureKind::edge) return false;
  const Patch& f = patches[other];
  const Real radius = patches.radius();
  if (f.kind == Terrain::FeatureKind::vertex && distance(f.at, from.at, to) >= radius) return true;
  if (f.kind == Terrain::FeatureKind::edge && f.is_clear_of(from.at, to, radius)) return true;
  const Point mid{(from.at.x + to.x) / 2, (from.at.y + to.y) / 2};
  const Real h = envelope_.clamped_height(other, mid);
  const Gradient g = patches.gradient(other, mid);
  for (const Point p : {from.at, to}) {
    if (!(h + g.x * (p.x - mid.x) + g.y * (p.y - mid.y) < envelope_.rim_height(upper, p))) return false;
  }
  return true;
}

/// True if the patch has a corner in the box.
template <class Real>
bool Cells<Real>::corner_in(Index patch, const Box& box) const {
  return has_corner_where(patch, box, [](Point) { return true; });
}

/// True if a seam or rim may end in the box, in a corner of the patches beside it other than the vertex.
template <class Real>
bool Cells<Real>::may_end(const Turn& side, std::optional<Point> vertex, const Box& box) const {
  const auto is_other = [&](Point c) {
    return !vertex || norm(c.x - vertex->x, c.y - vertex->y) > 4 * envelope_.tolerance();
  };
  if (side.meeting == Meeting::rim || side.before == none || side.after == none)
    return has_corner_where(side.before, box, is_other) || has_corner_where(side.after, box, is_other);
  return has_corner_where(side.before, box, [&](Point c) { return is_other(c) && has_corner(side.after, c); });
}

/// True if a cylinder or sphere is nearly vertical at p.
template <class Real>
bool Cells<Real>::is_upright(Index patch, Point p) const {
  const PatchSet<Real>& patches = envelope_.patches();
  return patches[patch].kind != Terrain::FeatureKind::face && size(patches.gradient(patch, p)) > steep;
}

/// How far the curve from a turn to another place on it can be from its chord within the box; infinite if that is not
/// known.
///
/// The function f that vanishes along it is zero at both ends, so where its derivative along the chord is within w of
/// itself, |f| <= w / 4 times the chord's length; across it, f changes by at least its least derivative there.
template <class Real>
Real Cells<Real>::bend(const Turn& turn, Point end, const Box& box) const {
  const Real dx = end.x - turn.at.x, dy = end.y - turn.at.y, length = square_root(dx * dx + dy * dy);
  if (!(length > 0)) return 0;
  const Gradient along{dx / length, dy / length}, across{-along.y, along.x};
  const auto bent = [&](auto&& derivative) {
    const Range a = derivative(along), b = derivative(across);
    if (!b.excludes_zero()) return Real(std::numeric_limits<double>::infinity());
    return (a.high - a.low) * length / (4 * std::min(absolute(b.low), absolute(b.high)));
  };
  if (turn.meeting != Meeting::valley) {
    const Bound* side = side_along(turn);
    if (side == nullptr) return std::numeric_limits<double>::infinity();
    if (side->type == BoundType::line) return 0;
    const GradientRange g = envelope_.bound_gradient_range(*side, box);
    const Real least = bent([&](Gradient d) { return g.x * Range{d.x, d.x} + g.y * Range{d.y, d.y}; });
    if (side->type != BoundType::cone || size(envelope_.bound_gradient(*side, turn.at)) < steep) return least;
    return std::min(least, bent([&](Gradient d) { return envelope_.upright_derivative_range(*side, box, d); }));
  }
  Real least = bent([&](Gradient d) { return slope_of_difference(turn.before, turn.after, box, d); });
  for (const Index upright : {turn.before, turn.after}) {
    if (!is_upright(upright, turn.at)) continue;
    const Index other = upright == turn.before ? turn.after : turn.before;
    least =
        std::min(least, bent([&](Gradient d) { return envelope_.upright_derivative_range(upright, other, box, d); }));
  }
  return least;
}

/// Which turns are the two ends of one curve: those with the same labels the other way round. False if it is not clear,
/// or if two such curves would cross.
template <class Real>
bool Cells<Real>::pair_turns() {
  const std::size_t n = turns_.size();
  mate_.assign(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (turns_[i].before != turns_[j].after || turns_[i].after != turns_[j].before) continue;
      if (mate_[i] >= 0 || mate_[j] >= 0 || turns_[i].meeting != turns_[j].meeting) return false;
      mate_[i] = int(j);
      mate_[j] = int(i);
    }
  }
  star_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (mate_[i] < 0) star_.push_back(turns_[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (mate_[i] < int(i)) continue;
    std::size_t arms = 0;  // between the curve's ends
    for (int j = int(i) + 1; j < mate_[i]; ++j) {
      if (mate_[j] < 0)
        ++arms;
      else if (mate_[j] < int(i) || mate_[j] > mate_[i])
        return false;
    }
    if (arms != 0 && arms != star_.size()) return false;
  }
  return true;
}

/// The vertex in which the curves of all turns without a mate end.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::vertex_of_star(const Box& box) {
  turns_.swap(star_);
  std::optional<Point> p;
  if (turns_.size() >= 3 && labels_differ() && !(finer_ != nullptr && is_steep())) p = star_point(box);
  if (p) p = known_beside(*p);
  turns_.swap(star_);
  return p;
}

/// True if two curves that share a label, each from a turn to an end, do not meet in the box.
template <class Real>
bool Cells<Real>::are_apart(const Strand& a, const Strand& b, std::optional<Point> vertex, const Box& box) const {
  const Turn &s = turns_[a.turn], &t = turns_[b.turn];
  Index patch = none;
  if (sides_of_one_patch(s, t, box, patch)) {
    // They meet only in a corner, which what lies beyond them has, too.
    const auto beyond = [&](const Turn& turn) { return turn.before == patch ? turn.after : turn.before; };
    const auto ends = [&](const Turn& turn, Point c) {
      return turn.meeting != Meeting::seam || has_corner(beyond(turn), c);
    };
    const auto meet = [&](Point c) { return ends(s, c) && ends(t, c); };
    if (!has_corner_where(patch, box, meet)) return true;
    if (!vertex) return false;
  }
  if (!vertex) {
    if (s.meeting == Meeting::rim && t.meeting == Meeting::valley && wall_keeps_off(s, a.end, t)) return true;
    if (t.meeting == Meeting::rim && s.meeting == Meeting::valley && wall_keeps_off(t, b.end, s)) return true;
  }
  for (const Turn* turn : {&s, &t}) {
    if (turn->meeting != Meeting::valley && may_end(*turn, vertex, box)) return false;
  }
  if (envelope_.is_far() || is_fine<Real>) {
    for (const Index l : {s.before, s.after}) {
      if (l == none || (l != t.before && l != t.after)) continue;
      const auto beyond = [&](const Turn& turn) {
        if (turn.meeting == Meeting::rim) return none;
        return turn.before == l ? turn.after : turn.before;
      };
      if ((s.meeting == Meeting::rim && !is_wall_of(s, l)) || (t.meeting == Meeting::rim && !is_wall_of(t, l)))
        continue;
      if (envelope_.stay_apart(l, beyond(s), beyond(t), box)) return true;
    }
  }
  if (!vertex && are_apart_by_expansion(s, t, box)) return true;
  // Closer than the tolerance they may touch: a seam and a valley that are tangent.
  const Real room = std::max(distance(s.at, a.end, t.at, b.end), envelope_.tolerance());
  return bend(s, a.end, box) + bend(t, b.end, box) < room;
}

/// Curves side by side, and at most one vertex: each pair of labels meets at exactly two turns, which nest like
/// brackets, or at one, from which a curve leads to the vertex.
template <class Real>
bool Cells<Real>::settle_strips(const Box& box) {
  const std::size_t n = turns_.size();
  if (n > 16 || !pair_turns() || star_.size() == n) return false;
  std::optional<Point> vertex;
  if (!star_.empty()) {
    if (std::any_of(turns_.begin(), turns_.end(), [](const Turn& t) { return t.meeting == Meeting::rim; }))
      return false;
    vertex = vertex_of_star(box);
    if (!vertex) return false;
  }
  const auto strand = [&](std::size_t i) {
    return Strand{i, mate_[i] < 0 ? *vertex : turns_[std::size_t(mate_[i])].at};
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (!curve_is_simple(turns_[i], box) || !stays_wall(turns_[i], strand(i).end, box)) return false;
    if (mate_[i] >= 0 && !stays_valley(turns_[i], strand(i).end, box)) return false;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (mate_[i] >= 0 && mate_[i] < int(i)) continue;
    if (mate_[i] >= 0 && vertex && !is_beside(strand(i), *vertex)) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (mate_[j] >= 0 && mate_[j] < int(j)) continue;
      if (mate_[i] < 0 && mate_[j] < 0) continue;  // meet in the vertex
      const Turn &s = turns_[i], &t = turns_[j];
      const bool share = s.before == t.before || s.before == t.after || s.after == t.before || s.after == t.after;
      if (share && !are_apart(strand(i), strand(j), vertex, box)) return false;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (mate_[i] < int(i)) continue;
    const std::size_t j = std::size_t(mate_[i]);
    connect(turns_[i], turns_[j]);
    // The run that ends at turn i goes on after turn j; the one that starts at turn i ends at turn j.
    map_.unite(turn_piece_[i], turn_piece_[(j + 1) % n]);
    map_.unite(turn_piece_[(i + 1) % n], turn_piece_[j]);
  }
  if (vertex) {
    turns_.swap(star_);
    add_vertex(*vertex);
    turns_.swap(star_);
  }
  return true;
}

/// True if the vertex lies on that side of a curve between two turns on which the turns without a mate are.
template <class Real>
bool Cells<Real>::is_beside(const Strand& s, Point vertex) const {
  const Point a = turns_[s.turn].at;
  const Real side = (s.end.x - a.x) * (vertex.y - a.y) - (s.end.y - a.y) * (vertex.x - a.x);
  const int from = int(s.turn), to = mate_[s.turn];
  bool between = false;  // the turns, which lie to the right of the chord then
  for (int j = from + 1; j < to; ++j) between = between || mate_[std::size_t(j)] < 0;
  return between ? side < 0 : side > 0;
}

template class Cells<double>;
template class Cells<DoubleDouble>;

}  // namespace krepl::terrain
