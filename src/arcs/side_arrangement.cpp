#include "arcs/side_arrangement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/odd_ones.hpp"

namespace krepl::arcs {
namespace {

using kernel::Box;
using Q = Vector<quad>;

double distance(Q p, Q q) { return double(length(q - p)); }

/// Where the lines or circles of two sides cross; up to two places.
class Crossings {
 public:
  Crossings(const SideCourse& a, const SideCourse& b, double eps) {
    if (a.side().arc && b.side().arc)
      circles(a.side(), b.side(), eps);
    else if (a.side().arc)
      line_circle(b, a.side());
    else if (b.side().arc)
      line_circle(a, b.side());
    else
      lines(a, b);
  }
  const Q* begin() const { return place_; }
  const Q* end() const { return place_ + count_; }

 private:
  void add(Q p) { place_[count_++] = p; }
  void lines(const SideCourse& a, const SideCourse& b) {
    const Q d = a.q() - a.p(), e = b.q() - b.p();
    const quad turn = cross(d, e);
    if (turn != 0) add(a.p() + (cross(b.p() - a.p(), e) / turn) * d);
  }
  void line_circle(const SideCourse& line, const RingSide& circle) {
    const Q d = line.q() - line.p();
    const quad l = length(d), r = circle.radius;
    const Q w{d.x / l, d.y / l}, v = circle.centre - line.p();
    const quad along = dot(v, w), off = cross(w, v), square = (r - off) * (r + off);
    if (!(square > 0)) return;
    const quad half = kernel::square_root(square);
    add(line.p() + (along - half) * w), add(line.p() + (along + half) * w);
  }
  void circles(const RingSide& a, const RingSide& b, double eps) {
    const Q v = b.centre - a.centre;
    const quad l = length(v);
    if (double(l) <= eps && std::abs(double(a.radius - b.radius)) <= eps) return;  // one circle
    const quad below = (b.radius - a.radius + l) * (b.radius + a.radius - l),
               above = (a.radius + l - b.radius) * (a.radius + l + b.radius);
    if (!(below > 0) || !(above > 0)) return;
    const quad half = kernel::square_root(below * above) / (2 * l);
    const quad along = ((a.radius - b.radius) * (a.radius + b.radius) + l * l) / (2 * l);
    const Q w{v.x / l, v.y / l};
    add({a.centre.x + along * w.x + half * w.y, a.centre.y + along * w.y - half * w.x});
    add({a.centre.x + along * w.x - half * w.y, a.centre.y + along * w.y + half * w.x});
  }
  Q place_[2];
  int count_ = 0;
};

std::uint64_t cell(std::int64_t x, std::int64_t y) {
  return std::uint64_t(x) * 0x9e3779b97f4a7c15ULL ^ (std::uint64_t(y) * 0xc2b2ae3d27d4eb4fULL + 0x165667b19e3779f9ULL);
}

}  // namespace

std::optional<SideArrangement> SideArrangement::make(const CurveNetwork& network, std::span<const RingSide> sides,
                                                     const Context& context) {
  SideArrangement a(network, sides);
  std::vector<Box> boxes;
  for (Index i = 0; i < a.sides_.size(); ++i)
    boxes.push_back(a.course(i).box(2 * a.eps_));
  const kernel::BoxTree tree(boxes);
  for (Index i = 0; i < a.sides_.size(); ++i) {
    if (i % 256 == 0 && context.cancelled()) return std::nullopt;
    tree.visit_meeting(boxes[i], [&](std::size_t j) {
      if (j > i) a.cut_pair(i, Index(j));
    });
  }
  a.cut_at_poles();
  a.make_fragments();
  a.group();
  return a;
}

SideArrangement::SideArrangement(const CurveNetwork& network, std::span<const RingSide> sides)
    : sides_(sides.begin(), sides.end()), eps_(0x1p-46 * network.extent()) {
  const auto vertices = network.straight().vertices();
  std::vector<Index> used;
  for (const RingSide& s : sides_) used.push_back(s.from), used.push_back(s.to);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto vertex = [&](Index v) { return Q{vertices[v].x, vertices[v].y}; };
  std::unordered_map<Index, Index> number;
  for (const Index v : used) number[v] = place_at(vertex(v), v, false);
  std::size_t kept = 0;
  for (RingSide& s : sides_) {
    const Index p = number[s.from], q = number[s.to];
    if (s.arc && s.from != s.to) {
      // A flat arc's chord serves.
      const Q u = vertex(s.from) - s.centre, v = vertex(s.to) - s.centre;
      const double chord = distance(vertex(s.from), vertex(s.to));
      const bool is_short = dot(u, v) > 0 && (cross(u, v) > 0) == s.left;
      if (is_short && chord * chord <= 8 * double(s.radius) * eps_) s.arc = false;
    }
    if (p == q && !s.arc) continue;
    sides_[kept++] = s;
    from_.push_back(p), to_.push_back(q);
  }
  sides_.resize(kept, RingSide{});
  cuts_.resize(kept);
}

Index SideArrangement::place_at(Q p, Index original, bool pole) {
  const Point at{double(p.x), double(p.y)};
  const auto cx = std::int64_t(std::floor(at.x / (2 * eps_))), cy = std::int64_t(std::floor(at.y / (2 * eps_)));
  for (std::int64_t x = cx - 1; x <= cx + 1; ++x) {
    for (std::int64_t y = cy - 1; y <= cy + 1; ++y) {
      const auto found = cells_.find(cell(x, y));
      if (found == cells_.end()) continue;
      for (const Index i : found->second) {
        if (distance(this->at(i), p) > eps_) continue;
        place_[i].pole = place_[i].pole && pole;
        return i;
      }
    }
  }
  cells_[cell(cx, cy)].push_back(Index(place_.size()));
  place_.push_back({at, original, pole});
  return Index(place_.size() - 1);
}

SideCourse SideArrangement::course(Index side) const {
  return {sides_[side], at(from_[side]), at(to_[side]), from_[side] == to_[side]};
}

void SideArrangement::cut_pair(Index i, Index j) {
  const SideCourse a = course(i), b = course(j);
  const auto cut = [&](Index side, const SideCourse& course, Index place) {
    if (place == from_[side] || place == to_[side]) return;
    cuts_[side].push_back({course.along(at(place)), place});
  };
  const auto cut_by_ends = [&](Index side, const SideCourse& course, Index other) {
    for (const Index end : {from_[other], to_[other]})
      if (course.off(at(end)) <= 2 * eps_ && course.reaches(at(end), 0)) cut(side, course, end);
  };
  cut_by_ends(i, a, j), cut_by_ends(j, b, i);
  for (const Q x : Crossings(a, b, eps_)) {
    if (!a.reaches(x, eps_) || !b.reaches(x, eps_)) continue;
    const Index place = place_at(x, none, false);
    cut(i, a, place), cut(j, b, place);
  }
}

void SideArrangement::cut_at_poles() {
  for (Index i = 0; i < sides_.size(); ++i) {
    const RingSide& s = sides_[i];
    if (!s.arc) continue;
    const SideCourse course = this->course(i);
    for (const quad sign : {quad(1), quad(-1)}) {
      const Q pole{s.centre.x, s.centre.y + sign * s.radius};
      if (!course.reaches(pole, 0)) continue;
      // Beside a place as high the arc is level, and others may run along it.
      const auto as_high = [&](Index place) { return std::abs(double(at(place).y - pole.y)) <= 2 * eps_; };
      if (as_high(from_[i]) || as_high(to_[i])) continue;
      if (std::any_of(cuts_[i].begin(), cuts_[i].end(), [&](const Cut& c) { return as_high(c.place); })) continue;
      const Index place = place_at(pole, none, true);
      if (place != from_[i] && place != to_[i]) cuts_[i].push_back({course.along(pole), place});
    }
  }
}

void SideArrangement::make_fragments() {
  for (Index i = 0; i < sides_.size(); ++i) {
    auto& cuts = cuts_[i];
    std::sort(cuts.begin(), cuts.end(),
              [](const Cut& a, const Cut& b) { return a.along != b.along ? a.along < b.along : a.place < b.place; });
    Index before = from_[i];
    const auto go_on = [&](Index place) {  // circles have a pole beside the place they start in
      if (place != before) fragment_.push_back({before, place, i});
      before = place;
    };
    for (const Cut& c : cuts) go_on(c.place);
    go_on(to_[i]);
  }
}

/// Of the arc above its chord, on the left of the way from the lower place to the higher one; 0 for segments.
double SideArrangement::height(const Fragment& f) const {
  const RingSide& s = sides_[f.side];
  if (!s.arc) return 0;
  const double half = distance(at(f.from), at(f.to)) / 2, r = double(s.radius);
  const double h = half * half / (r + std::sqrt(std::max(0.0, (r - half) * (r + half))));
  return s.left == (f.from < f.to) ? -h : h;
}

void SideArrangement::group() {
  order_.resize(fragment_.size());
  std::iota(order_.begin(), order_.end(), Index{0});
  const auto ends = [&](Index i) {
    return std::pair{std::min(fragment_[i].from, fragment_[i].to), std::max(fragment_[i].from, fragment_[i].to)};
  };
  std::vector<double> heights;
  for (const Fragment& f : fragment_) heights.push_back(height(f));
  std::sort(order_.begin(), order_.end(), [&](Index i, Index j) {
    if (ends(i) != ends(j)) return ends(i) < ends(j);
    return heights[i] != heights[j] ? heights[i] < heights[j] : i < j;
  });
  for (Index i = 0; i < order_.size(); ++i) {
    const bool same = i > 0 && ends(order_[i - 1]) == ends(order_[i]) &&
                      heights[order_[i]] - heights[order_[i - 1]] <= 8 * eps_;
    if (!same) groups_.push_back(i);
  }
  groups_.push_back(Index(order_.size()));
}

bool SideArrangement::runs_up(Index fragment) const {
  const Point p = place_[fragment_[fragment].from].at, q = place_[fragment_[fragment].to].at;
  return p.y != q.y ? p.y < q.y : p.x < q.x;
}

Q SideArrangement::middle(Index fragment) const {
  const Fragment& f = fragment_[fragment];
  const Q p = at(f.from), q = at(f.to), d = q - p;
  const quad h = f.from < f.to ? height(f) : -height(f), l = length(d);
  return {(p.x + q.x) / 2 - h * d.y / l, (p.y + q.y) / 2 + h * d.x / l};
}

quad SideArrangement::x_at(Index fragment, quad y) const {
  const Fragment& f = fragment_[fragment];
  const Q p = at(f.from), q = at(f.to);
  const quad share = p.y == q.y ? quad(0.5) : (y - p.y) / (q.y - p.y);
  const RingSide& s = sides_[f.side];
  if (!s.arc || p.y == q.y) return p.x + share * (q.x - p.x);
  // On the circle, from the chord's own place: a centre far away makes no difference of large numbers.
  const Q chord{p.x + share * (q.x - p.x), y}, v = chord - s.centre;
  const bool right = middle(fragment).x > (p.x + q.x) / 2;
  const quad within = (s.radius - length(v)) * (s.radius + length(v));  // of x to either side: dx^2 + 2 v.x dx = within
  const quad root = kernel::square_root(v.x * v.x + within);
  return chord.x + (right ? -v.x + root : -v.x - root);
}

double SideArrangement::direction(Index fragment, bool from_start, double distance) const {
  const Fragment& f = fragment_[fragment];
  const RingSide& s = sides_[f.side];
  const Q p = at(from_start ? f.from : f.to), q = at(from_start ? f.to : f.from);
  if (!s.arc) return std::atan2(double(q.y - p.y), double(q.x - p.x));
  const bool left = s.left == from_start;
  const Q u = p - s.centre;
  const double tangent = left ? std::atan2(double(u.x), double(-u.y)) : std::atan2(double(-u.x), double(u.y));
  const double more = std::asin(std::min(1.0, distance / (2 * double(s.radius))));
  return left ? tangent + more : tangent - more;
}

RayToTheLeft::RayToTheLeft(const SideArrangement& arrangement)
    : a_(arrangement), group_of_(arrangement.fragments().size()), tree_(boxes_of(arrangement)) {
  for (std::size_t g = 0; g + 1 < a_.groups().size(); ++g)
    for (Index i = a_.groups()[g]; i < a_.groups()[g + 1]; ++i) group_of_[a_.order()[i]] = Index(g);
}

std::vector<Box> RayToTheLeft::boxes_of(const SideArrangement& a) {
  std::vector<Box> boxes;
  for (Index i = 0; i < a.fragments().size(); ++i) {
    const auto& f = a.fragments()[i];
    const Point p = a.places()[f.from].at, q = a.places()[f.to].at;
    const Q m = a.middle(i);
    Box box;
    box.add(p), box.add(q);
    const double bulge = std::hypot(double(m.x) - (p.x + q.x) / 2, double(m.y) - (p.y + q.y) / 2) + a.eps();
    boxes.push_back({box.min_x - bulge, box.min_y, box.max_x + bulge, box.max_y});
  }
  return boxes;
}

std::vector<std::int64_t> RayToTheLeft::holding(Index group) const {
  const Index own = a_.order()[a_.groups()[group]];
  const auto& f = a_.fragments()[own];
  // Between neighbouring doubles there is no other for the middle.
  const quad y = (a_.at(f.from).y + a_.at(f.to).y) / 2, x = a_.x_at(own, y);
  std::vector<std::int64_t> hits;
  tree_.visit_left_of(
      Point{double(x), double(y)}, [] { return -std::numeric_limits<double>::infinity(); },
      [&](std::size_t i) {
        if (group_of_[i] == group) return;
        const auto& g = a_.fragments()[i];
        const auto [low, high] = std::minmax(a_.places()[g.from].at.y, a_.places()[g.to].at.y);
        if (!(low <= y && y < high)) return;
        if (a_.x_at(Index(i), y) < x) hits.push_back(a_.sides()[g.side].feature);
      });
  kernel::keep_odd_ones(hits);
  return hits;
}

std::vector<std::int64_t> RayToTheLeft::changing(Index group) const {
  std::vector<std::int64_t> here;
  for (Index i = a_.groups()[group]; i < a_.groups()[group + 1]; ++i)
    here.push_back(a_.sides()[a_.fragments()[a_.order()[i]].side].feature);
  kernel::keep_odd_ones(here);
  return here;
}

}  // namespace krepl::arcs
