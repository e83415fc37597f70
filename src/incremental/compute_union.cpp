#include "incremental/compute_union.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>

namespace krepl::incremental {

using EdgeKind = Surface::EdgeKind;

namespace {

/// The labels are what the arc's curve separates.
bool is_about(const std::array<Index, 2>& label, const Arc& arc) {
  const auto& own = arc.curve->own;
  if (own[1] == none) return label[0] != label[1] && (label[0] == own[0] || label[1] == own[0]);
  return (label[0] == own[0] && label[1] == own[1]) || (label[0] == own[1] && label[1] == own[0]);
}

/// Where a stretch crosses an arc at an angle that tells the place.
std::optional<Real> crossing(const Arc& stretch, const Arc& arc, Real weld) {
  const Real width = stretch.end - stretch.begin,
             size = flat_distance(stretch.point(stretch.begin), stretch.point(stretch.end));
  if (!stretch.box.meets(arc.box)) return std::nullopt;
  const auto near = PlanarMap::passes(arc, stretch.point((stretch.begin + stretch.end) / 2), size);
  if (!near) return std::nullopt;
  const Real arc_step = (arc.end - arc.begin) / 4096, step = width / 8;
  Real t = (stretch.begin + stretch.end) / 2, s = *near;
  for (int i = 0; i < 20; ++i) {
    const Vector off = arc.point(s) - stretch.point(t);
    const Vector d = (1 / (2 * step)) * (stretch.point(t + step) - stretch.point(t - step)),
                 e = (1 / (2 * arc_step)) * (arc.point(s + arc_step) - arc.point(s - arc_step));
    const Real turn = d.x * e.y - d.y * e.x;
    if (!(std::fabs(turn) > 0x1p-12L * std::sqrt((d.x * d.x + d.y * d.y) * (e.x * e.x + e.y * e.y))))
      return std::nullopt;
    const Real dt = (off.x * e.y - off.y * e.x) / turn, ds = (off.x * d.y - off.y * d.x) / turn;
    t += dt, s += ds;
    if (!(t >= stretch.begin - width && t <= stretch.end + width && s >= std::min(arc.begin, arc.end) - arc_step &&
          s <= std::max(arc.begin, arc.end) + arc_step))
      return std::nullopt;
    if (std::fabs(dt) <= 0x1p-20L * width) break;
  }
  const bool inside = t >= stretch.begin && t <= stretch.end && s >= arc.begin && s <= arc.end;
  return inside && flat_distance(stretch.point(t), arc.point(s)) <= weld / 4 ? std::optional(t) : std::nullopt;
}

/// Of all arcs, the crossing nearest to t.
std::optional<Real> nearest_crossing(const Arc& stretch, Real t, const std::vector<Arc>& arcs, Real weld) {
  std::optional<Real> nearest;
  for (const Arc& arc : arcs) {
    if (arc.curve == stretch.curve) continue;
    const auto at = crossing(stretch, arc, weld);
    if (at && (!nearest || std::fabs(*at - t) < std::fabs(*nearest - t))) nearest = at;
  }
  return nearest;
}

}  // namespace

/// Face, edges and vertices of a triangle that no triangle so far has.
std::vector<Index> Union::new_parts(Index triangle) const {
  const TrianglePart& t = parts_.triangles()[triangle];
  std::vector<Index> found;
  const auto look = [&](Index part) {
    if (part != none && !has_part_[part]) found.push_back(part);
  };
  look(t.part);
  for (const Index e : t.edge) look(parts_.edges()[e].part);
  for (const Index v : t.vertex) look(parts_.vertices()[v].part);
  return found;
}

std::vector<Index> Union::triangles_near(const Box& box) const {
  std::vector<Index> near;
  const Box wide = box.grown(parts_.radius() + tolerance_.weld);
  for (const Index t : in_) {
    if (parts_.triangles()[t].box.meets(wide)) near.push_back(t);
  }
  return near;
}

std::optional<Fault> Union::add(Index triangle) {
  const std::vector<Index> added = new_parts(triangle);
  const Box box = parts_.triangles()[triangle].box.grown(parts_.radius() * (1 + 1e-9L));
  std::vector<bool> is_visible(parts_.parts().size(), false);
  for (const Arc& arc : map_.arcs()) {
    for (const Index label : arc.label) {
      if (label != none) is_visible[label] = true;
    }
  }
  is_in_[triangle] = true;
  in_.push_back(triangle);
  for (const Index p : added) has_part_[p] = true;
  in_parts_.insert(in_parts_.end(), added.begin(), added.end());
  std::sort(in_parts_.begin(), in_parts_.end());

  std::vector<Arc> arcs;
  touches_.clear();
  cut_old(triangle, map_.take(box), arcs);
  for (const Index part : added) {
    for (Curve& curve : outline(parts_, part)) {
      for (const Real t : {curve.begin, curve.end}) corners_.push_back(curve.point(t));
      trace(std::move(curve), arcs);
    }
    for (Index other = 0; other < is_visible.size(); ++other) {
      if (!is_visible[other] || !parts_[other].box.meets(parts_[part].box)) continue;
      for (Curve& curve : meetings(parts_, other, part)) trace(std::move(curve), arcs);
    }
  }
  set_ends(arcs);
  split_at_vertices(arcs);
  do {
    std::erase_if(arcs, [&](Arc& arc) { return !set_labels(arc); });
    drop_repeated(arcs);
  } while (rejoin(arcs));
  step_ = {triangle, 0, 0};
  step_.components = count_components(arcs, added);
  return map_.put(std::move(arcs));
}

/// What the new semi-krepl leaves of the old boundary's arcs.
void Union::cut_old(Index triangle, std::vector<Arc> old, std::vector<Arc>& arcs) {
  for (const Arc& arc : old) {
    std::vector<Condition> conditions;
    add_cover(parts_, arc.curve->own, triangle, conditions);
    keep(arc.curve, where_all_hold(parts_, *arc.curve, arc.begin, arc.end, conditions, tolerance_), &arc, arcs);
  }
}

/// Where a new curve is on the boundary.
void Union::trace(Curve curve, std::vector<Arc>& arcs) {
  ++curves_traced_;
  const CurvePointer pointer = std::make_shared<const Curve>(curve);
  std::vector<Condition> conditions;
  if (curve.role == Curve::Role::meeting) {
    for (const Index part : curve.own) add_domain(parts_, part, conditions);
  }
  Box box;
  for (int i = 0; i <= 16; ++i) box.add(curve.point(curve.begin + (curve.end - curve.begin) * Real(i) / 16));
  // Where it shows it is within both patches.
  Box within = parts_[curve.own[0]].box;
  if (curve.own[1] != none) {
    const Box& b = parts_[curve.own[1]].box;
    within.low_x = std::max(within.low_x, b.low_x), within.low_y = std::max(within.low_y, b.low_y);
    within.high_x = std::min(within.high_x, b.high_x), within.high_y = std::min(within.high_y, b.high_y);
  }
  for (const Index t : triangles_near(within)) add_cover(parts_, curve.own, t, conditions);
  const auto visible = where_all_hold(parts_, curve, curve.begin, curve.end, conditions, tolerance_);
  keep(pointer, visible, nullptr, arcs);
}

void Union::keep(const CurvePointer& curve, const std::vector<Interval>& intervals, const Arc* from,
                 std::vector<Arc>& arcs) {
  for (const Interval& i : intervals) {
    for (const StretchEnd& t : i.touches) {
      Arc around;
      around.curve = curve, around.begin = t.low, around.end = t.high;
      PlanarMap::measure(around);
      touches_.push_back({around, curve->point(t.t)});
    }
    const bool same_begin = from != nullptr && i.begin.t == from->begin,
               same_end = from != nullptr && i.end.t == from->end;
    if (same_begin && same_end) {
      arcs.push_back(*from);
      continue;
    }
    Arc arc;
    arc.curve = curve, arc.begin = i.begin.t, arc.end = i.end.t;
    arc.early = {i.begin.low, i.end.low}, arc.late = {i.begin.high, i.end.high};
    if (same_begin) arc.vertex[0] = from->vertex[0];
    if (same_end) arc.vertex[1] = from->vertex[1];
    PlanarMap::measure(arc);
    if (arc.reach > 2 * tolerance_.weld) arcs.push_back(std::move(arc));
  }
}

void Union::set_ends(std::vector<Arc>& arcs) {
  const auto place = [](const Arc& arc, int side) { return arc.point(side == 0 ? arc.begin : arc.end); };
  // Ends that are known first, then those that the tolerance leaves open, the longer the later: they go to a vertex if there is
  // one, or to a corner of a patch.
  struct End {
    Arc* arc;
    int side;
    Real open;
  };
  std::vector<End> ends;
  for (Arc& arc : arcs) {
    for (const int side : {0, 1}) {
      if (arc.vertex[side] == none) ends.push_back({&arc, side, flat_distance(arc.point(arc.early[side]), arc.point(arc.late[side]))});
    }
  }
  std::stable_sort(ends.begin(), ends.end(), [](const End& e, const End& f) { return e.open < f.open; });
  for (const End& end : ends) {
    Arc& arc = *end.arc;
    const int side = end.side;
    if (end.open <= tolerance_.weld / 16) {
      arc.vertex[side] = map_.vertex_at(place(arc, side));
      continue;
    }
    Arc open = arc;
    open.begin = arc.early[side], open.end = arc.late[side];
    PlanarMap::measure(open);
    const auto move_to = [&](Real t, Index vertex) {
      arc.vertex[side] = vertex;
      (side == 0 ? arc.begin : arc.end) = t;
    };
    const auto try_place = [&](Vector p, Real distance) {
      if (arc.vertex[side] != none) return;
      if (const auto t = PlanarMap::passes(open, p, distance)) move_to(*t, map_.vertex_at(p));
    };
    const auto try_vertices = [&](Real distance) {
      for (Index v = 0; v < map_.vertex_count() && arc.vertex[side] == none; ++v) try_place(map_.vertex(v), distance);
    };
    for (const Vector p : corners_) try_place(p, tolerance_.weld);
    try_vertices(tolerance_.weld);
    if (arc.vertex[side] == none) {
      if (const auto t = nearest_crossing(open, side == 0 ? arc.begin : arc.end, arcs, tolerance_.weld))
        move_to(*t, map_.vertex_at(open.point(*t)));
    }
    // Where surfaces meet at a small angle rounding moves their curve by as much more.
    try_vertices(64 * tolerance_.weld);
    if (arc.vertex[side] == none) arc.vertex[side] = map_.vertex_at(place(arc, side));
    PlanarMap::measure(arc);
  }
  std::erase_if(arcs,
                [&](const Arc& arc) { return arc.vertex[0] == arc.vertex[1] && arc.reach <= 4 * tolerance_.weld; });
}

/// Arcs end where others begin: a rim passes over the end of what lies below it.
void Union::split_at_vertices(std::vector<Arc>& arcs) {
  std::vector<Index> ends;
  for (const Arc& arc : arcs) ends.insert(ends.end(), {arc.vertex[0], arc.vertex[1]});
  // Where arcs touch is known as well as a tangent tells, so one place does for all that pass there.
  for (const Touch& touch : touches_) {
    const bool known = std::any_of(ends.begin(), ends.end(), [&](Index v) {
      return PlanarMap::passes(touch.around, map_.vertex(v), tolerance_.weld).has_value();
    });
    if (!known) ends.push_back(map_.vertex_at(touch.at));
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<Arc> split;
  for (const Arc& arc : arcs) {
    struct Cut {
      Real t;
      Index vertex;
    };
    std::vector<Cut> cuts;
    for (const Index v : ends) {
      if (v == arc.vertex[0] || v == arc.vertex[1]) continue;
      if (const auto t = PlanarMap::passes(arc, map_.vertex(v), tolerance_.weld)) cuts.push_back({*t, v});
    }
    if (cuts.empty()) {
      split.push_back(arc);
      continue;
    }
    std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.t < b.t; });
    cuts.push_back({arc.end, arc.vertex[1]});
    Cut last{arc.begin, arc.vertex[0]};
    for (const Cut& cut : cuts) {
      Arc piece = arc;
      piece.begin = last.t, piece.end = cut.t;
      piece.vertex = {last.vertex, cut.vertex};
      PlanarMap::measure(piece);
      if (piece.vertex[0] != piece.vertex[1] || piece.reach > 4 * tolerance_.weld) split.push_back(std::move(piece));
      last = cut;
    }
  }
  arcs = std::move(split);
}

/// Curves of several pairs of parts can be the same, and of curves in one wall only the uppermost is seen. Kept is the
/// one whose own parts are what is seen beside it, else the uppermost.
void Union::drop_repeated(std::vector<Arc>& arcs) const {
  std::stable_sort(arcs.begin(), arcs.end(), [&](const Arc& a, const Arc& b) {
    const bool first = is_about(a.label, a), second = is_about(b.label, b);
    return first != second ? first : a.middle().z > b.middle().z + tolerance_.weld;
  });
  std::map<std::pair<Index, Index>, std::vector<std::size_t>> between;
  std::vector<bool> dropped(arcs.size(), false);
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const auto ends = std::minmax(arcs[i].vertex[0], arcs[i].vertex[1]);
    auto& others = between[{ends.first, ends.second}];
    const Vector m = arcs[i].middle();
    for (const std::size_t k : others) dropped[i] = dropped[i] || PlanarMap::passes(arcs[k], m, 4 * tolerance_.weld);
    if (!dropped[i]) others.push_back(i);
  }
  std::vector<Arc> kept;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (!dropped[i]) kept.push_back(std::move(arcs[i]));
  }
  arcs = std::move(kept);
}

/// Pieces of one curve whose common vertex nothing else has: what ended there has turned out to separate nothing. The
/// longer the piece, the better its labels can be told. False if there are none.
bool Union::rejoin(std::vector<Arc>& arcs) const {
  std::map<Index, std::vector<std::size_t>> at;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    for (const Index v : arcs[i].vertex) at[v].push_back(i);
  }
  for (const Arc& arc : map_.arcs()) {  // those elsewhere
    for (const Index v : arc.vertex) at.erase(v);
  }
  bool found = false;
  for (const auto& [v, pair] : at) {
    if (pair.size() != 2 || pair[0] == pair[1]) continue;
    Arc *a = &arcs[pair[0]], *b = &arcs[pair[1]];
    if (a->begin == b->end) std::swap(a, b);
    if (a->curve != b->curve || a->end != b->begin || a->vertex[1] != v || b->vertex[0] != v) continue;
    // What is left of it stands at its first place; the other is taken out below.
    b->begin = a->begin, b->vertex[0] = a->vertex[0];
    PlanarMap::measure(*b);
    a->curve = nullptr;
    a->begin = a->end = std::numeric_limits<Real>::quiet_NaN();
    const auto first = a->vertex[0];
    for (std::size_t& i : at[first]) {
      if (&arcs[i] == a) i = std::size_t(b - arcs.data());
    }
    found = true;
  }
  std::erase_if(arcs, [](const Arc& arc) { return arc.curve == nullptr; });
  return found;
}

/// The part that is highest over a place. Among equals the first, but of two edges in one line the one of which the
/// other may be a part.
Index Union::label(Vector place) const {
  Real best = below_everything;
  std::vector<std::pair<Real, Index>> found;
  for (const Index p : in_parts_) {
    const Real h = parts_.height(p, place);
    if (h < best - tolerance_.tie || h == below_everything) continue;
    best = std::max(best, h);
    found.push_back({h, p});
  }
  Index first = none;
  for (const auto& [h, p] : found) {
    if (h < best - tolerance_.tie) continue;
    if (first == none)
      first = p;
    else if (parts_.are_in_one_line(p, first) && parts_.edge_of(p).length > parts_.edge_of(first).length)
      first = p;
  }
  return first;
}

/// The parts that are highest so far beside the middle of an arc, left and right.
std::array<Index, 2> Union::labels_beside(const Arc& arc, Real off) const {
  const Real middle = arc.middle_parameter(), step = (arc.end - arc.begin) / 1024;
  const Vector m = arc.point(middle), before = arc.point(middle - step), after = arc.point(middle + step);
  const Real x = after.x - before.x, y = after.y - before.y, size = std::sqrt(x * x + y * y);
  off = std::min(off, arc.reach / 64);
  const Real across_x = -off * y / size, across_y = off * x / size;
  return {label({m.x + across_x, m.y + across_y, m.z}), label({m.x - across_x, m.y - across_y, m.z})};
}

/// What is highest on both sides. False if that is the same: the arc separates nothing.
bool Union::set_labels(Arc& arc) const {
  // Beside a wall, and where curves are tangent, what is next to an arc can be very thin; where surfaces meet at a
  // small angle, heights differ little. So from near to far, the first place at which it is what the curve is about.
  const Real scale = tolerance_.scale;
  arc.label = labels_beside(arc, 0x1p-30L * scale);
  if (!is_about(arc.label, arc) || arc.curve->own[1] == none) {
    // Two rims that cross at an angle of 1e-5, one a bit below the other: beside a short arc only the nearest place
    // tells.
    const bool is_short = arc.reach < 0x1p-24L * scale;
    for (const Real share : {0x1p-46L, 0x1p-42L, 0x1p-36L, 0x1p-24L, 0x1p-18L}) {
      if (share == 0x1p-46L && !is_short) continue;
      const auto labels = labels_beside(arc, share * scale);
      if (!is_about(labels, arc)) continue;
      arc.label = labels;
      break;
    }
  }
  const Vector m = arc.middle();
  if (arc.label[0] == arc.label[1]) return false;
  arc.lower = 2;
  Vector contact[2];
  const Real radius = parts_.radius(), near = 4 * tolerance_.touch;
  for (const int side : {0, 1}) {
    const Index p = arc.label[side];
    bool touches = false;
    if (p != none) {
      contact[side] = parts_.contact(p, m);
      touches = std::fabs(length(m - contact[side]) - radius) <= near && contact[side].z <= m.z + near;
    }
    if (!touches) arc.lower = side;
  }
  if (arc.lower != 2)
    arc.kind = EdgeKind::rim;
  else
    arc.kind = length(contact[0] - contact[1]) <= 8 * near && parts_.continue_smoothly(arc.label[0], arc.label[1])
                   ? EdgeKind::seam
                   : EdgeKind::valley;
  return true;
}

/// Connected parts of where the new boundary meets the old one: arcs that are no rim and have a part that was added on
/// one side only.
std::size_t Union::count_components(const std::vector<Arc>& arcs, const std::vector<Index>& added) {
  std::map<Index, Index> root;
  const std::function<Index(Index)> find = [&](Index v) {
    const Index r = root.try_emplace(v, v).first->second;
    return r == v ? v : root[v] = find(r);
  };
  std::map<Index, int> degree;
  const auto is_new = [&](Index p) { return std::find(added.begin(), added.end(), p) != added.end(); };
  for (const Arc& arc : arcs) {
    if (arc.kind == EdgeKind::rim || is_new(arc.label[0]) == is_new(arc.label[1])) continue;
    for (const Index v : arc.vertex) ++degree[v];
    const Index a = find(arc.vertex[0]), b = find(arc.vertex[1]);
    root[a] = b;
  }
  std::map<Index, bool> closed;
  for (const auto& [v, n] : degree) {
    const auto place = closed.try_emplace(find(v), true).first;
    place->second = place->second && n % 2 == 0;
  }
  for (const auto& [v, is_closed] : closed) step_.closed += is_closed;
  return closed.size();
}

}  // namespace krepl::incremental
