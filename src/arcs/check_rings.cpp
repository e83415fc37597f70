#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "arcs/feature_rings.hpp"
#include "krepl/curve_zone.hpp"
#include "shape/rings_by_feature.hpp"
#include "zone/arc_turn.hpp"

namespace krepl {
namespace arcs {
namespace {

/// Collects the faults of one feature.
class RingCheck {
 public:
  RingCheck(const CurveNetwork& network, const FeatureRings& f, std::int64_t feature)
      : network_(network), f_(f), a_(f.arrangement), feature_(feature) {}

  void run(std::vector<RingFault>& out) {
    find_cuts();
    find_overlaps();
    find_returns();
    const Network& straight = network_.straight();
    for (const Index ring : f_.collapsed) note(RingFault::Kind::collapsed, straight.vertices()[straight.part(ring)[0]]);
    if (found_.empty()) find_directions();
    for (const auto& entry : found_) out.push_back(entry.second);
  }

 private:
  void note(RingFault::Kind kind, Point where) {
    const Point o = network_.straight().origin();
    const auto at = found_.try_emplace(kind, RingFault{kind, feature_, {where.x + o.x, where.y + o.y}, 0}).first;
    ++at->second.count;
  }
  /// Where a side was cut: at a vertex it touches one, elsewhere it crosses another side.
  void find_cuts() {
    std::vector<bool> seen(a_.places().size(), false);
    const auto& fragments = a_.fragments();
    for (std::size_t i = 0; i + 1 < fragments.size(); ++i) {
      const auto& place = a_.places()[fragments[i].to];
      if (fragments[i].side != fragments[i + 1].side || place.pole || seen[fragments[i].to]) continue;
      seen[fragments[i].to] = true;
      note(place.original == none ? RingFault::Kind::crossing : RingFault::Kind::touching, place.at);
    }
  }
  void find_overlaps() {
    for (std::size_t g = 0; g + 1 < a_.groups().size(); ++g) {
      if (a_.groups()[g + 1] - a_.groups()[g] < 2) continue;
      const auto m = a_.middle(a_.order()[a_.groups()[g]]);
      note(RingFault::Kind::overlapping, {double(m.x), double(m.y)});
    }
  }
  /// Each ring may start a side at a vertex only once.
  void find_returns() {
    std::set<std::pair<Index, Index>> starts;
    for (const RingSide& s : a_.sides())
      if (!starts.emplace(s.part, s.from).second)
        note(RingFault::Kind::touching, network_.straight().vertices()[s.from]);
  }
  /// A ring is outer where the inside is on the side that its sense of rotation has on its inner side.
  void find_directions() {
    const RayToTheLeft ray(a_);
    std::map<Index, double> twice;  // per ring
    for (Index i = 0; i < a_.fragments().size(); ++i) {
      const auto& f = a_.fragments()[i];
      const Point p = a_.places()[f.from].at, q = a_.places()[f.to].at;
      twice[a_.sides()[f.side].part] += p.x * q.y - p.y * q.x + twice_bulge(i);
    }
    bool outer_left = false, outer_right = false;
    std::map<Index, std::pair<Point, bool>> holes;  // with a vertex, and whether it runs counter-clockwise
    std::map<Index, bool> done;
    for (Index g = 0; g + 1 < a_.groups().size(); ++g) {
      const Index i = a_.order()[a_.groups()[g]];
      const RingSide& side = a_.sides()[a_.fragments()[i].side];
      if (std::exchange(done[side.part], true)) continue;
      const bool inside_left = ray.holding(g).empty() != a_.runs_up(i), counter_clockwise = twice[side.part] > 0;
      if (inside_left != counter_clockwise)
        holes[side.part] = {network_.straight().vertices()[side.from], counter_clockwise};
      else
        (counter_clockwise ? outer_left : outer_right) = true;
    }
    for (const auto& [ring, hole] : holes)
      if (hole.second ? outer_left : outer_right) note(RingFault::Kind::direction, hole.first);
  }
  /// Twice the area between a fragment and its chord, negative where it turns right.
  double twice_bulge(Index i) const {
    const auto& f = a_.fragments()[i];
    const RingSide& s = a_.sides()[f.side];
    if (!s.arc) return 0;
    const double chord = double(length(a_.at(f.to) - a_.at(f.from))), r = double(s.radius);
    const double turn = 2 * std::asin(std::min(1.0, chord / (2 * r)));  // no fragment is more than half a turn
    return (s.left ? 1 : -1) * r * r * zone::bulge_factor(turn);
  }

  const CurveNetwork& network_;
  const FeatureRings& f_;
  const SideArrangement& a_;
  std::int64_t feature_;
  std::map<RingFault::Kind, RingFault> found_;
};

}  // namespace
}  // namespace arcs

Result<std::vector<RingFault>> check_rings(const CurveNetwork& network, const Context& context) {
  std::vector<RingFault> faults;
  for (const auto& [feature, rings] : shape::rings_by_feature(network.straight())) {
    const auto f = arcs::take_apart(network, rings, context);
    if (!f) return f.error();
    arcs::RingCheck(network, *f, feature).run(faults);
  }
  return faults;
}

}  // namespace krepl
