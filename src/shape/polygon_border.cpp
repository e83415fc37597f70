#include "shape/polygon_border.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kernel/box_tree.hpp"
#include "kernel/odd_ones.hpp"
#include "kernel/orientation.hpp"
#include "shape/rings_by_feature.hpp"
#include "shape/side_arrangement.hpp"

namespace krepl::shape {
namespace {

Error cancelled() { return {ErrorCode::cancelled, "cancelled", "", ""}; }

/// A feature's rings, cut where they meet.
struct FeatureRings {
  std::vector<RingSide> sides;
  SideArrangement arrangement;
  Coinciding coinciding;
  std::vector<Index> collapsed;  // rings without sides

  bool is_sound() const {
    return collapsed.empty() && arrangement.fragments.size() == sides.size() &&
           coinciding.groups.size() == sides.size() + 1;
  }
};

Result<FeatureRings> take_apart(const Network& network, const std::vector<Index>& rings, const Context& context) {
  FeatureRings f;
  for (const Index ring : rings) {
    const std::size_t before = f.sides.size();
    append_sides(network, ring, f.sides);
    if (f.sides.size() == before) f.collapsed.push_back(ring);
  }
  auto arrangement = arrange(network, f.sides, context);
  if (!arrangement) return cancelled();
  f.arrangement = std::move(*arrangement);
  f.coinciding = group_coinciding(f.arrangement);
  return f;
}

Point absolute(const Network& network, Point p) { return {p.x + network.origin().x, p.y + network.origin().y}; }

/// Collects the faults of one feature.
class RingCheck {
 public:
  RingCheck(const Network& network, const FeatureRings& f, std::int64_t feature, std::vector<RingFault>& out)
      : network_(network), f_(f), feature_(feature), out_(out) {}

  void run() {
    find_cuts();
    find_overlaps();
    find_returns();
    for (const Index ring : f_.collapsed) note(RingFault::Kind::collapsed, network_.vertices()[network_.part(ring)[0]]);
    if (f_.is_sound()) find_directions();
    for (const auto& [kind, fault] : found_) out_.push_back(fault);
  }

 private:
  void note(RingFault::Kind kind, Point where) {
    const auto [at, is_new] = found_.try_emplace(kind, RingFault{kind, feature_, absolute(network_, where), 0});
    ++at->second.count;
  }
  /// Where a side was cut: at a new place it crosses another, at a vertex it touches one.
  void find_cuts() {
    const auto& a = f_.arrangement;
    std::vector<bool> seen(a.place.size(), false);
    for (const auto& fragment : a.fragments) {
      const Index v = fragment.to;
      if (seen[v] || a.original[v] == f_.sides[fragment.side].to) continue;
      if (a.original[v] != none &&
          network_.vertices()[a.original[v]] == network_.vertices()[f_.sides[fragment.side].to])
        continue;
      seen[v] = true;
      note(a.original[v] == none ? RingFault::Kind::crossing : RingFault::Kind::touching, a.place[v]);
    }
  }
  void find_overlaps() {
    const auto& c = f_.coinciding;
    for (std::size_t g = 0; g + 1 < c.groups.size(); ++g) {
      if (c.groups[g + 1] - c.groups[g] < 2) continue;
      const auto& fragment = f_.arrangement.fragments[c.order[c.groups[g]]];
      const Point p = f_.arrangement.place[fragment.from], q = f_.arrangement.place[fragment.to];
      note(RingFault::Kind::overlapping, {p.x + (q.x - p.x) / 2, p.y + (q.y - p.y) / 2});
    }
  }
  /// Each ring may start a side at a vertex only once.
  void find_returns() {
    std::vector<std::pair<Index, Index>> starts;
    for (const RingSide& s : f_.sides) starts.emplace_back(s.part, s.from);
    std::sort(starts.begin(), starts.end());
    for (std::size_t i = 1; i < starts.size(); ++i)
      if (starts[i] == starts[i - 1]) note(RingFault::Kind::touching, network_.vertices()[starts[i].second]);
  }
  /// A ring is outer where the inside is on the side that its sense of rotation has on its inner side.
  void find_directions() {
    const RayToTheLeft ray(f_.arrangement, f_.sides);
    bool outer_left = false, outer_right = false;
    std::vector<std::pair<Index, bool>> holes;  // first side and whether it runs counter-clockwise
    for (Index first = 0, last; first < f_.sides.size(); first = last) {
      last = first;
      double twice = 0;
      const Point base = network_.vertices()[f_.sides[first].from];
      for (; last < f_.sides.size() && f_.sides[last].part == f_.sides[first].part; ++last) {
        const Point p = network_.vertices()[f_.sides[last].from], q = network_.vertices()[f_.sides[last].to];
        twice += (p.x - base.x) * (q.y - base.y) - (p.y - base.y) * (q.x - base.x);
      }
      // Sound: side and fragment have the same number.
      const auto& fragment = f_.arrangement.fragments[first];
      const Point p = f_.arrangement.snapped[fragment.from], q = f_.arrangement.snapped[fragment.to];
      const bool runs_up = p.y != q.y ? q.y > p.y : q.x > p.x;  // then what the ray tells is on its left
      const bool inside_left = ray.holding(first).empty() != runs_up;
      const bool counter_clockwise = twice > 0;
      if (inside_left != counter_clockwise) {
        holes.emplace_back(first, counter_clockwise);
      } else {
        (counter_clockwise ? outer_left : outer_right) = true;
      }
    }
    for (const auto& [first, counter_clockwise] : holes)
      if (counter_clockwise ? outer_left : outer_right)
        note(RingFault::Kind::direction, network_.vertices()[f_.sides[first].from]);
  }

  const Network& network_;
  const FeatureRings& f_;
  std::int64_t feature_;
  std::vector<RingFault>& out_;
  std::map<RingFault::Kind, RingFault> found_;
};

/// Finds the segment of a network that a short stretch lies on.
class SegmentFinder {
 public:
  explicit SegmentFinder(const Network& network) : network_(network), tree_(boxes(network)) {}

  Index operator()(Point p) const {
    const double reach = 0x1p-40 * network_.extent();
    Index best = 0;
    double least = INFINITY;
    tree_.visit_meeting({p.x - reach, p.y - reach, p.x + reach, p.y + reach}, [&](std::size_t i) {
      const auto s = network_.segments()[i];
      const Point a = network_.vertices()[s.a], b = network_.vertices()[s.b];
      const double dx = b.x - a.x, dy = b.y - a.y;
      const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
      const double off = std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
      if (off < least) least = off, best = Index(i);
    });
    return best;
  }

 private:
  static std::vector<kernel::Box> boxes(const Network& network) {
    std::vector<kernel::Box> result;
    for (const auto s : network.segments()) {
      result.emplace_back();
      result.back().add(network.vertices()[s.a]);
      result.back().add(network.vertices()[s.b]);
    }
    return result;
  }
  const Network& network_;
  kernel::BoxTree tree_;
};

struct DirectedSide {
  Index from, to;  // places
};

/// The sides of the union's border, with the inside on their left.
std::vector<DirectedSide> directed_border(const SideArrangement& a, std::span<const RingSide> sides) {
  const Coinciding c = group_coinciding(a);
  const RayToTheLeft ray(a, sides);
  std::vector<DirectedSide> border;
  for (std::size_t g = 0; g + 1 < c.groups.size(); ++g) {
    std::vector<std::int64_t> here;
    for (Index i = c.groups[g]; i < c.groups[g + 1]; ++i) here.push_back(sides[a.fragments[c.order[i]].side].feature);
    kernel::keep_odd_ones(here);
    const Index fragment = c.order[c.groups[g]];
    const auto before = ray.holding(fragment);
    std::vector<std::int64_t> after;
    std::set_symmetric_difference(before.begin(), before.end(), here.begin(), here.end(), std::back_inserter(after));
    if (before.empty() == after.empty()) continue;
    Index low = a.fragments[fragment].from, high = a.fragments[fragment].to;
    const Point p = a.snapped[low], q = a.snapped[high];
    if (p.y != q.y ? p.y > q.y : p.x > q.x) std::swap(low, high);
    border.push_back(before.empty() ? DirectedSide{high, low} : DirectedSide{low, high});
  }
  return border;
}

/// Of the sides that leave a place, the one that bounds the same face: the first clockwise from the way back.
class NextSide {
 public:
  NextSide(const SideArrangement& a, const std::vector<DirectedSide>& border)
      : a_(a), border_(border), begin_(a.place.size() + 1, 0), leaving_(border.size()) {
    for (const auto& s : border) ++begin_[s.from + 1];
    for (std::size_t v = 0; v < a.place.size(); ++v) begin_[v + 1] += begin_[v];
    std::vector<Index> at(begin_.begin(), begin_.end() - 1);
    for (Index i = 0; i < border.size(); ++i) leaving_[at[border[i].from]++] = i;
  }
  Index operator()(Index side) const {
    const Index v = border_[side].to;
    Index best = none;
    for (Index i = begin_[v]; i < begin_[v + 1]; ++i)
      if (best == none || before(v, border_[side].from, border_[leaving_[i]].to, border_[best].to)) best = leaving_[i];
    return best;
  }

 private:
  bool before(Index v, Index back, Index p, Index q) const {
    const int kp = sector(v, back, p), kq = sector(v, back, q);
    if (kp != kq) return kp < kq;
    return kernel::orientation(a_.snapped[v], a_.snapped[p], a_.snapped[q]) < 0;
  }
  int sector(Index v, Index back, Index p) const {
    const int turn = kernel::orientation(a_.snapped[v], a_.snapped[back], a_.snapped[p]);
    if (turn != 0) return turn < 0 ? 0 : 2;
    const Point o = a_.snapped[v], b = a_.snapped[back], x = a_.snapped[p];
    return (b.x - o.x) * (x.x - o.x) + (b.y - o.y) * (x.y - o.y) < 0 ? 1 : 3;
  }
  const SideArrangement& a_;
  const std::vector<DirectedSide>& border_;
  std::vector<Index> begin_, leaving_;
};

}  // namespace

Result<std::shared_ptr<const Network>> border_network(std::shared_ptr<const Network> network, const Context& context) {
  const auto parts = rings_by_feature(*network);
  std::vector<FeatureRings> features;
  bool sound = true;
  for (const auto& [feature, rings] : parts) {
    auto f = take_apart(*network, rings, context);
    if (!f) return f.error();
    sound = sound && f->is_sound();
    features.push_back(std::move(*f));
  }
  if (sound) return network;
  Network::Builder builder;
  for (const FeatureRings& f : features) {
    for (std::size_t g = 0; g + 1 < f.coinciding.groups.size(); ++g) {
      if ((f.coinciding.groups[g + 1] - f.coinciding.groups[g]) % 2 == 0) continue;
      const auto& fragment = f.arrangement.fragments[f.coinciding.order[f.coinciding.groups[g]]];
      const Point side[] = {absolute(*network, f.arrangement.place[fragment.from]),
                            absolute(*network, f.arrangement.place[fragment.to])};
      builder.add_line(side, f.sides[fragment.side].feature);
    }
  }
  if (builder.vertex_count() == 0) return std::shared_ptr<const Network>();
  auto built = std::move(builder).build(context);
  if (!built) return built.error();
  return std::make_shared<const Network>(std::move(*built));
}

Result<zone::ShapedRings> union_border(const Network& network, const Network& target, const Context& context) {
  std::vector<RingSide> sides;
  for (Index p = 0; p < network.part_count(); ++p)
    if (network.part_is_ring(p)) append_sides(network, p, sides);
  const auto arrangement = arrange(network, sides, context);
  if (!arrangement) return cancelled();
  const std::vector<DirectedSide> border = directed_border(*arrangement, sides);
  const NextSide next(*arrangement, border);
  const SegmentFinder segment_at(target);
  const Point shift{network.origin().x - target.origin().x, network.origin().y - target.origin().y};
  const auto place = [&](Index i) {
    return Point{arrangement->place[i].x + shift.x, arrangement->place[i].y + shift.y};
  };
  zone::ShapedRings rings;
  rings.touch = true;  // polygons that share a vertex
  std::vector<bool> done(border.size(), false);
  for (Index first = 0; first < border.size(); ++first) {
    if (done[first]) continue;
    for (Index i = first; i != none && !done[i]; i = next(i)) {
      done[i] = true;
      const Point p = place(border[i].from), q = place(border[i].to);
      const Index source = segment_at({p.x + (q.x - p.x) / 2, p.y + (q.y - p.y) / 2});
      const auto s = target.segments()[source];
      const Point a = target.vertices()[s.a], b = target.vertices()[s.b];
      Zone::Piece piece{
          Zone::Kind::segment, p, q, {}, source, (q.x - p.x) * (b.x - a.x) + (q.y - p.y) * (b.y - a.y) < 0};
      piece.role = Zone::Role::input;
      rings.piece.push_back(piece);
    }
    rings.close();
  }
  return rings;
}

}  // namespace krepl::shape

namespace krepl {

Result<std::vector<RingFault>> check_rings(const Network& network, const Context& context) {
  std::vector<RingFault> faults;
  for (const auto& [feature, rings] : shape::rings_by_feature(network)) {
    const auto f = shape::take_apart(network, rings, context);
    if (!f) return f.error();
    shape::RingCheck(network, *f, feature, faults).run();
  }
  return faults;
}

}  // namespace krepl
