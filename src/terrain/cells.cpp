#include "terrain/cells.hpp"

#include <algorithm>

namespace krepl::terrain {

template <class Real>
Cells<Real>::Cells(CellMap& map, Envelope<Real>& envelope, SurfaceCounters& counters, const Context& context,
                   Cells<DoubleDouble>* finer)
    : map_(map), envelope_(envelope), counters_(counters), context_(context), finer_(finer) {}

template <class Real>
bool Cells<Real>::run(const Cell& cell, std::span<const Index> candidates) {
  stack_.assign(candidates.begin(), candidates.end());
  return subdivide(cell, 0, 0);
}

/// Collects the turns and the pieces between them, and unites pieces that meet at the cell's corners.
template <class Real>
void Cells<Real>::walk(const Cell& cell) {
  turns_.clear();
  turn_piece_.clear();
  Index previous = none, first_piece = none;
  const auto pass = [&](Index piece) {
    if (previous == none)
      first_piece = piece;
    else
      map_.unite(previous, piece);
    previous = piece;
  };
  const auto turn = [&](const CellSide& s, Index c, Index before, Index after, int side) {
    const CellMap::Crossing& x = map_.crossings()[c];
    const auto at = map_.place(s.line, x);
    turns_.push_back({c, side, before, after, x.meeting, {at.x, at.y}});
    turn_piece_.push_back(previous);
  };
  for (int i = 0; i < 4; ++i) {
    const CellSide& s = cell.side[i];
    const Index base = map_.lines()[s.line].first_crossing;
    const auto label_before = [&](Index c) { return c == s.first ? s.label : map_.crossings()[c - 1].after; };
    if (i < 2) {
      pass(map_.piece(s.line, s.first - base));
      for (Index c = s.first; c < s.last; ++c) {
        turn(s, c, label_before(c), map_.crossings()[c].after, i == 0 ? 1 : 0);
        previous = map_.piece(s.line, c + 1 - base);
      }
    } else {
      pass(map_.piece(s.line, s.last - base));
      for (Index c = s.last; c-- > s.first;) {
        turn(s, c, map_.crossings()[c].after, label_before(c), i == 2 ? 0 : 1);
        previous = map_.piece(s.line, c - base);
      }
    }
  }
  map_.unite(previous, first_piece);
}

template <class Real>
bool Cells<Real>::subdivide(const Cell& cell, std::size_t first, int depth) {
  ++counters_.cells;
  if (context_.cancelled()) return false;
  const std::size_t begin = stack_.size();
  std::array<Index, 4> champions;
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    // Labels at the corners: the ends of bottom and top.
    const CellSide& s = cell.side[i < 2 ? 0 : 2];
    const Index label = i % 2 == 1 && s.last > s.first ? map_.crossings()[s.last - 1].after : s.label;
    if (label != none && std::find(champions.begin(), champions.begin() + count, label) == champions.begin() + count) {
      champions[count++] = label;
    }
  }
  kept_.clear();
  const std::size_t hidden = envelope_.filter(cell.box, {champions.data(), std::size_t(count)},
                                              {stack_.data() + first, begin - first}, kept_, !cell.just_asked);
  const bool just_asked = !cell.just_asked && kept_.size() > most_settled && 16 * hidden < kept_.size();
  stack_.insert(stack_.end(), kept_.begin(), kept_.end());
  const bool smallest = cell.box.larger_side() <= envelope_.smallest_cell();
  bool done = true;
  const std::span<Index> kept(stack_.data() + begin, stack_.size() - begin);
  const bool few = smallest || kept.size() <= most_settled;
  if (!few || !settle(cell, kept, smallest)) {
    stack_.erase(std::remove(stack_.begin() + std::ptrdiff_t(begin), stack_.end(), none), stack_.end());
    const bool hard = finer_ != nullptr && stack_.size() - begin <= most_settled && is_hard(cell.box);
    if (hard || (is_fine<Real> && few)) add_seen(begin);
    done = hard ? refine(cell, {stack_.data() + begin, stack_.size() - begin}) : split(cell, begin, depth, just_asked);
  }
  stack_.resize(begin);
  return done;
}

/// Makes candidates of all labels around the cell: some may show there by less than is told apart, and not inside.
template <class Real>
void Cells<Real>::add_seen(std::size_t first) {
  for (const Turn& t : turns_) {
    if (t.after != none && std::find(stack_.begin() + std::ptrdiff_t(first), stack_.end(), t.after) == stack_.end())
      stack_.push_back(t.after);
  }
}

/// True if double may not tell what is in a cell that has been walked around: in small ones where surfaces meet at
/// small angles or are steep, in the smallest ones anyway.
template <class Real>
bool Cells<Real>::is_hard(const Box& box) const {
  const Real size_of_cell = box.larger_side();
  if (size_of_cell > envelope_.fine_cell()) return false;
  if (size_of_cell <= envelope_.fine_cell() / 64) return true;
  constexpr double flat = 0x1p-7;
  return std::any_of(turns_.begin(), turns_.end(), [&](const Turn& t) {
    if (t.meeting == Meeting::rim) return true;
    const Gradient g = envelope_.patches().gradient(t.before, t.at), h = envelope_.patches().gradient(t.after, t.at);
    return size(g) > steep || (t.meeting == Meeting::valley && size(Gradient{g.x - h.x, g.y - h.y}) < flat);
  });
}

template <class Real>
bool Cells<Real>::refine(const Cell& cell, std::span<const Index> candidates) {
  const auto coordinates = [](Point p) { return PointOf<DoubleDouble>{p.x, p.y}; };
  typename Cells<DoubleDouble>::Cell same{{coordinates(cell.box.low), coordinates(cell.box.high)}, {}};
  std::copy(cell.side, cell.side + 4, same.side);
  envelope_.finer(candidates, true);
  return finer_->run(same, candidates);
}

template <class Real>
bool Cells<Real>::split(const Cell& cell, std::size_t first, int depth, bool just_asked) {
  const Box& box = cell.box;
  const Cut where = cut(cell, {stack_.data() + first, stack_.size() - first});
  const bool vertical = where.vertical;
  const CellSide &low_side = cell.side[vertical ? 0 : 3], &high_side = cell.side[vertical ? 2 : 1];
  const Real low = vertical ? box.low.x : box.low.y, high = vertical ? box.high.x : box.high.y;
  const double at = where.at;
  if (!(at > low && at < high) || depth > 200) {
    map_.failed_at = {double(box.middle().x), double(box.middle().y)};
    return false;
  }
  const auto first_beyond = [&](const CellSide& s) {
    Index c = s.first;
    while (c < s.last && map_.crossings()[c].t <= at) ++c;
    return c;
  };
  const auto label_at = [&](const CellSide& s, Index c) {
    return c == s.first ? s.label : map_.crossings()[c - 1].after;
  };
  const Index low_cut = first_beyond(low_side), high_cut = first_beyond(high_side);
  const Index start = label_at(low_side, low_cut), end = label_at(high_side, high_cut);
  found_.clear();
  const Real from = vertical ? box.low.y : box.low.x, to = vertical ? box.high.y : box.high.x;
  envelope_.section(vertical, at, double(from), double(to), start, end, {stack_.data() + first, stack_.size() - first},
                    found_);
  const Index line = map_.add_line(vertical, at, start, found_);
  const Index first_crossing = map_.lines()[line].first_crossing;
  const CellSide middle{line, first_crossing, first_crossing + Index(found_.size()), start};

  Cell below = cell, above = cell;
  below.just_asked = above.just_asked = just_asked;
  const int a = vertical ? 0 : 3, b = vertical ? 2 : 1;
  below.side[a].last = low_cut;
  below.side[b].last = high_cut;
  above.side[a] = {low_side.line, low_cut, low_side.last, start};
  above.side[b] = {high_side.line, high_cut, high_side.last, end};
  if (vertical) {
    below.box.high.x = above.box.low.x = at;
    below.side[1] = above.side[3] = middle;
  } else {
    below.box.high.y = above.box.low.y = at;
    below.side[2] = above.side[0] = middle;
  }
  return subdivide(below, first, depth + 1) && subdivide(above, first, depth + 1);
}

template <class Real>
bool Cells<Real>::settle(const Cell& cell, std::span<Index> candidates, bool smallest) {
  walk(cell);
  if (!smallest && !shows_all(cell, candidates)) return false;
  const std::size_t n = turns_.size();
  bool settled = n == 0;
  if (n == 2) settled = settle_arc(cell.box, smallest);
  if (n == 4) settled = settle_crossing(cell.box);
  if (n >= 3 && !settled)
    settled = settle_star(cell.box, false) || settle_strips(cell.box) || (smallest && settle_star(cell.box, true));
  if (!settled) return false;
  ++counters_.leaves;
  if (smallest) ++counters_.smallest_cells;
  return true;
}

template <class Real>
void Cells<Real>::connect(const Turn& a, const Turn& b) {
  map_.link(a.crossing, a.side, Link::crossing(b.crossing, b.side));
  map_.link(b.crossing, b.side, Link::crossing(a.crossing, a.side));
}

/// True if two patches cannot be equally high along a closed curve in the box. Inside it their heights would differ
/// most where they have one normal, so that what the ball touches there is at one place in the plane. Of two spheres
/// and of a sphere and a cylinder this is so nowhere, or all along an arc from rim to rim; of two cylinders it is a
/// saddle, since each is straight in one direction; of a plane and a cylinder it is so nowhere or along a line. A plane
/// can cut a cap off a sphere.
template <class Real>
bool Cells<Real>::cannot_close(Index a, Index b, const Box& box) const {
  using Kind = Terrain::FeatureKind;
  const PatchSet<Real>& patches = envelope_.patches();
  if (a == none || b == none) return false;
  for (const Index l : {a, b}) {
    if (!patches[l].has_rim) continue;
    for (const Bound& side : patches.bounds(l)) {
      if (!side.rim || envelope_.covers(side, box)) continue;
      if (!envelope_.is_far() || !envelope_.stay_apart(l, l == a ? b : a, none, box)) return false;
    }
  }
  if (patches[a].kind != Kind::face && patches[b].kind != Kind::face) return true;
  if (patches[a].kind == Kind::edge || patches[b].kind == Kind::edge) return true;
  if (patches[a].kind == patches[b].kind) return false;
  const Patch &face = patches[patches[a].kind == Kind::face ? a : b],
              &sphere = patches[patches[a].kind == Kind::face ? b : a];
  const Real reach = patches.radius() / face.q, slack = envelope_.smallest_cell();
  const Point top{sphere.at.x - face.gx * reach, sphere.at.y - face.gy * reach};
  return !Box{{box.low.x - slack, box.low.y - slack}, {box.high.x + slack, box.high.y + slack}}.contains(top);
}

/// Range of the derivative of the difference of two heights where both patches can be seen.
template <class Real>
RangeOf<Real> Cells<Real>::slope_of_difference(Index a, Index b, const Box& box, Gradient direction) const {
  constexpr auto where = Envelope<Real>::Where::in_domain;
  return envelope_.derivative_range(a, box, direction, where) - envelope_.derivative_range(b, box, direction, where);
}

/// True if the curve between the turn's labels cannot close inside the box: some direction is never along it.
template <class Real>
bool Cells<Real>::curve_is_simple(const Turn& t, const Box& box) const {
  if (t.meeting != Meeting::valley || is_thin_bend(t.before, t.after, box))
    return box.larger_side() < envelope_.patches().radius();
  if (cannot_close(t.before, t.after, box)) return true;
  const auto never_along = [&](Real x, Real y) {
    return slope_of_difference(t.before, t.after, box, {x, y}).excludes_zero();
  };
  const auto is_simple = [](auto&& never) { return never(1, 0) || never(0, 1) || never(1, 1) || never(1, -1); };
  if (is_simple(never_along)) return true;
  for (const Index upright : {t.before, t.after}) {
    const Index other = upright == t.before ? t.after : t.before;
    if (upright == none || other == none || !is_upright(upright, t.at)) continue;
    if (is_simple([&](Real x, Real y) {
          return envelope_.upright_derivative_range(upright, other, box, {x, y}).excludes_zero();
        }))
      return true;
  }
  if (const Index first = first_in_plane(t, box); first != none) return !corner_in(first, box);
  // Along an edge its cylinder rises evenly, even near the rim.
  for (const Index l : {t.before, t.after}) {
    const Patch& f = envelope_.patches()[l];
    if (f.kind == Terrain::FeatureKind::edge && (never_along(f.gx, f.gy) || never_along(-f.gy, f.gx))) return true;
  }
  return false;
}

/// True if a wall from a turn to another place on it stays one: where the lower patch reaches its height the two meet
/// in a valley.
///
/// The lower patch is concave, so its tangents at the two ends bound it.
template <class Real>
bool Cells<Real>::stays_wall(const Turn& from, Point to, const Box& box) const {
  if (from.meeting != Meeting::rim || from.before == none || from.after == none ||
      is_thin_bend(from.before, from.after, box))
    return true;
  const auto [upper, lower] = sides_of_wall(from);
  const PatchSet<Real>& patches = envelope_.patches();
  if (patches[upper].kind == Terrain::FeatureKind::face) return true;
  const Real dx = to.x - from.at.x, dy = to.y - from.at.y;
  const bool round = patches[upper].kind == Terrain::FeatureKind::vertex;
  const Real sagitta = round ? (dx * dx + dy * dy) / (4 * patches.radius()) : 0;
  const Gradient wall = envelope_.rim_gradient(upper);
  // Of the lower patch over the wall, and how fast that grows on the way to the other end.
  Real steepest = 0, excess[2], slope[2];
  for (const int end : {0, 1}) {
    const Point p = end == 0 ? from.at : to;
    const Gradient g = patches.gradient(lower, p), d{g.x - wall.x, g.y - wall.y};
    excess[end] = envelope_.clamped_height(lower, p) - envelope_.rim_height(upper, p) + size(d) * sagitta;
    slope[end] = (end == 0 ? 1 : -1) * (d.x * dx + d.y * dy);
    steepest = std::max(steepest, size(d));
  }
  Real most = std::max(excess[0], excess[1]);
  if (slope[0] > 0 && slope[1] > 0)
    most = std::max(most, excess[0] + slope[0] * (excess[1] - excess[0] + slope[1]) / (slope[0] + slope[1]));
  return most <= 64 * envelope_.tolerance() * (1 + steepest);
}

/// True if a valley from a turn to another place in it stays one: where it comes down to the height at which one of its patches
/// ends in a wall, that wall goes on. The other patch is concave, so that it is no lower between the two ends but for how far a
/// round wall is from the straight line.
template <class Real>
bool Cells<Real>::stays_valley(const Turn& from, Point to, const Box& box) const {
  if (from.meeting != Meeting::valley) return true;
  const PatchSet<Real>& patches = envelope_.patches();
  const Real dx = to.x - from.at.x, dy = to.y - from.at.y;
  for (const Index upright : {from.before, from.after}) {
    const Index other = upright == from.before ? from.after : from.before;
    if (upright == none || other == none || patches[upright].kind == Terrain::FeatureKind::face) continue;
    const std::span<const Bound> sides = patches.bounds(upright);
    if (std::none_of(sides.begin(), sides.end(), [&](const Bound& b) { return b.rim && !envelope_.covers(b, box); })) continue;
    const Gradient wall = envelope_.rim_gradient(upright);
    const bool round = patches[upright].kind == Terrain::FeatureKind::vertex;
    Real above[2], steepest = 0;
    for (const int end : {0, 1}) {
      const Point p = end == 0 ? from.at : to;
      const Gradient g = patches.gradient(other, p);
      steepest = std::max(steepest, norm(g.x - wall.x, g.y - wall.y));
      above[end] = envelope_.clamped_height(other, p) - envelope_.rim_height(upright, p);
    }
    // Between the ends, at u in [0, 1], at least (1 - u) above[0] + u above[1] - most u (1 - u).
    const Real most = round ? steepest * (dx * dx + dy * dy) / patches.radius() : Real(0), rise = above[1] - above[0];
    Real least = std::min(above[0], above[1]);
    if (most > absolute(rise)) least = (above[0] + above[1]) / 2 - (most + rise * rise / most) / 4;
    if (least < -64 * envelope_.tolerance() * (1 + steepest)) return false;
  }
  return true;
}

/// Of two faces in one plane the first one shows wherever it is: along its straight sides. None if the labels are no such
/// faces.
template <class Real>
Index Cells<Real>::first_in_plane(const Turn& t, const Box& box) const {
  if (t.meeting != Meeting::valley || !envelope_.are_coplanar(t.before, t.after, box)) return none;
  return std::min(t.before, t.after);
}

/// The one corner in the box of the first of two faces in one plane.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::corner_of_first(const Turn& t, const Box& box) const {
  const Index first = first_in_plane(t, box);
  std::optional<Point> corner;
  if (first == none) return corner;
  for (const Point c : envelope_.patches().corners(first)) {
    if (!box.contains(c)) continue;
    if (corner) return std::nullopt;
    corner = c;
  }
  return corner;
}

/// Where two cylinders are equally high and tangent at once, if that is in the box: a ball there touches the point in
/// which their edges cross. Four valleys meet there, of which a cell has two if a cut runs through.
template <class Real>
std::optional<PointOf<Real>> Cells<Real>::crossing_of_edges(const Turn& t, const Box& box) const {
  const PatchSet<Real>& patches = envelope_.patches();
  if (t.meeting != Meeting::valley) return std::nullopt;
  const Patch &a = patches[t.before], &b = patches[t.after];
  if (a.kind != Terrain::FeatureKind::edge || b.kind != Terrain::FeatureKind::edge) return std::nullopt;
  const Real sine = a.gx * b.gy - a.gy * b.gx;
  if (absolute(sine) < 0x1p-20) return std::nullopt;
  const Real dx = b.at.x - a.at.x, dy = b.at.y - a.at.y;
  const Real along_a = (dx * b.gy - dy * b.gx) / sine, along_b = (dx * a.gy - dy * a.gx) / sine;
  if (absolute(a.z + along_a * a.m - b.z - along_b * b.m) > envelope_.tolerance()) return std::nullopt;
  // The normal is at right angles to both edges: its slopes along them are -m.
  const Real nx = (a.gy * b.m - b.gy * a.m) / sine, ny = (b.gx * a.m - a.gx * b.m) / sine;
  const Real reach = patches.radius() / square_root(1 + nx * nx + ny * ny), slack = envelope_.tolerance();
  const Point p{a.at.x + along_a * a.gx + reach * nx, a.at.y + along_a * a.gy + reach * ny};
  const bool inside =
      p.x >= box.low.x - slack && p.x <= box.high.x + slack && p.y >= box.low.y - slack && p.y <= box.high.y + slack;
  return inside && shows_at(t.before, p) && shows_at(t.after, p) ? std::optional(p) : std::nullopt;
}

/// Two cylinders whose edges cross, and nothing else: each of the two curves along which they are equally high runs
/// through the crossing from wall to wall of the cylinders. With the walls outside, so do the four ends, and the four
/// turns are where they leave.
template <class Real>
bool Cells<Real>::settle_crossing(const Box& box) {
  const Turn& t = turns_[0];
  if (turns_[1].after != t.before || turns_[2].after != t.after || turns_[3].after != t.before) return false;
  if (std::any_of(turns_.begin(), turns_.end(), [](const Turn& u) { return u.meeting != Meeting::valley; }))
    return false;
  const std::optional<Point> p = crossing_of_edges(t, box);
  if (!p || !box.contains(*p)) return false;
  const PatchSet<Real>& patches = envelope_.patches();
  for (const Index l : {t.before, t.after}) {
    const Patch& f = patches[l];
    for (const Point c : box.corners()) {
      if (absolute(f.aside(c)) >= patches.radius()) return false;
    }
  }
  add_vertex(*p);
  return true;
}

template <class Real>
bool Cells<Real>::settle_arc(const Box& box, bool smallest) {
  const Turn &a = turns_[0], &b = turns_[1];
  if (a.meeting != b.meeting) return settle_star(box, smallest);  // where a valley ends in a wall
  if (const std::optional<Point> corner = corner_of_first(a, box)) {
    add_vertex(*corner);
    return true;
  }
  if (const std::optional<Point> level = change_of_upper_wall(a, b, box)) {
    add_vertex(*level);
    return true;
  }
  if (!smallest && !(curve_is_simple(a, box) && stays_wall(a, b.at, box) && stays_valley(a, b.at, box))) return false;
  if (const std::optional<Point> p = crossing_of_edges(a, box))
    add_vertex(*p);
  else
    connect(a, b);
  return true;
}

/// True if the label is the upper one of a wall, or has one of two walls of one height with a gap between them that is
/// too narrow to show.
template <class Real>
bool Cells<Real>::is_wall_of(const Turn& turn, Index label) const {
  if (turn.meeting != Meeting::rim || label == none || (turn.before != label && turn.after != label)) return false;
  const Index other = turn.before == label ? turn.after : turn.before;
  if (other == none || envelope_.upper_at_wall(other, label, turn.at) == label) return true;
  if (envelope_.rim_at(label, turn.at) == nullptr || envelope_.rim_at(other, turn.at) == nullptr) return false;
  const Real apart = envelope_.rim_height(label, turn.at) - envelope_.rim_height(other, turn.at);
  return absolute(apart) <= envelope_.tolerance();
}

/// The upper and the lower label of a wall between two.
template <class Real>
std::pair<Index, Index> Cells<Real>::sides_of_wall(const Turn& t) const {
  return is_wall_of(t, t.before) ? std::pair(t.before, t.after) : std::pair(t.after, t.before);
}

/// True if each label shows in one run of the cell's boundary.
template <class Real>
bool Cells<Real>::labels_differ() const {
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (turns_[i].after == turns_[j].after) return false;
    }
  }
  return true;
}

/// True if one patch, between two walls that touch in the box, shows on both sides of that place, and so near to it that what
/// is between the walls is not told apart.
template <class Real>
bool Cells<Real>::is_pinched(const Box& box) const {
  if (turns_.size() != 4 || box.larger_side() > reach_of_touch()) return false;
  const bool once[2] = {turns_[0].after != turns_[2].after, turns_[1].after != turns_[3].after};
  return once[0] != once[1] && touch_of_walls(box);
}

template <class Real>
bool Cells<Real>::settle_star(const Box& box, bool smallest) {
  if (!smallest && !labels_differ() && !is_pinched(box)) return false;
  const std::optional<Point> found = star_point(box);
  if (!found && !smallest) return false;
  if (found && finer_ != nullptr && is_steep()) return false;
  if (!smallest &&
      !std::all_of(turns_.begin(), turns_.end(), [&](const Turn& t) { return stays_wall(t, *found, box) && stays_valley(t, *found, box); }))
    return false;
  const Point p = found ? *found : least_gap(box);
  add_vertex(known_beside(p));
  return true;
}

/// True if a face there is so steep that what the plane's tolerance leaves open is much on the surface; one that is
/// vertical but for rounding is a wall.
template <class Real>
bool Cells<Real>::is_steep() const {
  const PatchSet<Real>& patches = envelope_.patches();
  return std::any_of(turns_.begin(), turns_.end(), [&](const Turn& t) {
    if (t.after == none || patches[t.after].kind != Terrain::FeatureKind::face) return false;
    return patches[t.after].q > steep && patches[t.after].q < 0x1p20;
  });
}

/// Where the patches around the smallest cell come closest in height, of the places known there: near walls the middle
/// can be far off in height.
template <class Real>
PointOf<Real> Cells<Real>::least_gap(const Box& box) const {
  Point best = box.middle();
  Real least = std::numeric_limits<double>::infinity();
  const auto consider = [&](Point p) {
    Real gap = 0;
    for (const Turn& t : turns_) {
      if (t.meeting != Meeting::rim)
        gap += absolute(envelope_.border_height(t.before, p) - envelope_.border_height(t.after, p));
    }
    if (gap < least) least = gap, best = p;
  };
  consider(best);
  for (const Turn& t : turns_) {
    consider(t.at);
    if (t.after == none) continue;
    for (const Point c : envelope_.patches().corners(t.after)) {
      if (absolute(c.x - box.middle().x) <= box.larger_side() && absolute(c.y - box.middle().y) <= box.larger_side())
        consider(c);
    }
  }
  return best;
}

template class Cells<double>;
template class Cells<DoubleDouble>;

}  // namespace krepl::terrain
