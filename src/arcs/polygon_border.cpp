#include "arcs/polygon_border.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "arcs/feature_rings.hpp"
#include "shape/rings_by_feature.hpp"

namespace krepl::arcs {
namespace {

using Q = Vector<quad>;
Error cancelled() { return {ErrorCode::cancelled, "cancelled", "", ""}; }

Point rounded(Q v) { return {double(v.x), double(v.y)}; }

/// A stretch of a side between places that are more than poles of its circle.
struct Run {
  Index first, last;  // fragments of one side, in order
  bool forward;       // the way the side runs
};

/// The middle place of a run, for an arc by three places.
Q middle_of(const SideArrangement& a, const Run& run) {
  const RingSide& s = a.sides()[a.fragments()[run.first].side];
  const Q p = a.at(a.fragments()[run.first].from), q = a.at(a.fragments()[run.last].to);
  if (!s.arc) return {(p.x + q.x) / 2, (p.y + q.y) / 2};
  if (run.first == run.last) return a.middle(run.first);
  const Q u = p - s.centre, v = q - s.centre;
  double angle = std::atan2(double(cross(u, v)), double(dot(u, v))) * (s.left ? 1 : -1);
  if (angle <= 0) angle += 2 * M_PI;
  const quad c = std::cos(angle / 2), n = std::sin(angle / 2) * (s.left ? 1 : -1);
  return {s.centre.x + c * u.x - n * u.y, s.centre.y + n * u.x + c * u.y};
}

bool is_more_than_half(const SideArrangement& a, const Run& run) {
  const RingSide& s = a.sides()[a.fragments()[run.first].side];
  const Q p = a.at(a.fragments()[run.first].from), m = middle_of(a, run);
  return dot(p - s.centre, m - s.centre) < 0;
}

/// Finds the segment or arc of a network of lines that a short stretch lies on.
class SourceFinder {
 public:
  explicit SourceFinder(const CurveNetwork& network) : network_(network), sides_(sides_of(network)), tree_(boxes()) {}

  /// Fills in source and direction of a piece with that middle.
  void find(Zone::Piece& piece, Q middle) const {
    const double reach = 0x1p-40 * network_.extent();
    const Point m = rounded(middle);
    const RingSide* best = nullptr;
    double least = INFINITY;
    tree_.visit_meeting({m.x - reach, m.y - reach, m.x + reach, m.y + reach}, [&](std::size_t i) {
      if (sides_[i].from_arc != piece.from_arc) return;
      const double off = course(sides_[i]).distance(middle);
      if (off < least) least = off, best = &sides_[i];
    });
    if (best == nullptr) return;
    piece.source = best->source;
    const auto v = network_.straight().vertices();
    const auto segment = network_.straight().segments();
    if (!piece.from_arc) {
      const Point a = v[segment[best->source].a], b = v[segment[best->source].b];
      piece.reversed = (piece.end.x - piece.start.x) * (b.x - a.x) + (piece.end.y - piece.start.y) * (b.y - a.y) < 0;
    }
  }

 private:
  SideCourse course(const RingSide& side) const {
    const auto v = network_.straight().vertices();
    return {side, {v[side.from].x, v[side.from].y}, {v[side.to].x, v[side.to].y}, side.from == side.to};
  }
  static std::vector<RingSide> sides_of(const CurveNetwork& network) {
    std::vector<RingSide> sides;
    for (Index p = 0; p < network.straight().part_count(); ++p)
      if (network.straight().part(p).size() > 1) append_sides(network, p, sides);
    return sides;
  }
  std::vector<kernel::Box> boxes() const {
    std::vector<kernel::Box> result;
    for (const RingSide& s : sides_) result.push_back(course(s).box(0));
    return result;
  }
  const CurveNetwork& network_;
  std::vector<RingSide> sides_;
  kernel::BoxTree tree_;
};

/// The fragments of the union's border, and whether the inside is on their left as they run.
std::vector<std::pair<Index, bool>> directed_border(const SideArrangement& a) {
  const RayToTheLeft ray(a);
  std::vector<std::pair<Index, bool>> border;
  for (Index g = 0; g + 1 < a.groups().size(); ++g) {
    const auto before = ray.holding(g), odd = ray.changing(g);
    std::vector<std::int64_t> after;
    std::set_symmetric_difference(before.begin(), before.end(), odd.begin(), odd.end(), std::back_inserter(after));
    if (before.empty() == after.empty()) continue;
    const Index fragment = a.order()[a.groups()[g]];
    border.emplace_back(fragment, a.runs_up(fragment) != before.empty());
  }
  return border;
}

/// Walks along the border: of what leaves a place, the first clockwise from the way back bounds the same face.
class Walk {
 public:
  Walk(const SideArrangement& a, const std::vector<std::pair<Index, bool>>& border)
      : a_(a), border_(border), leaving_(a.places().size()), nearest_(a.places().size(), INFINITY) {
    for (Index i = 0; i < border.size(); ++i) {
      leaving_[start(i)].push_back(i);
      const double chord = double(length(a.at(end(i)) - a.at(start(i))));
      for (const Index place : {start(i), end(i)}) nearest_[place] = std::min(nearest_[place], chord);
    }
  }
  Index start(Index i) const { return border_[i].second ? fragment(i).from : fragment(i).to; }
  Index end(Index i) const { return border_[i].second ? fragment(i).to : fragment(i).from; }
  /// What goes on where i ends; none if nothing does.
  Index next(Index i) const {
    const auto& out = leaving_[end(i)];
    if (out.size() < 2) return out.empty() ? none : out.front();
    const double away = nearest_[end(i)] / 2;
    const double back = a_.direction(border_[i].first, !border_[i].second, away);
    Index best = none;
    double least = INFINITY;
    for (const Index j : out) {
      double turn = std::remainder(back - a_.direction(border_[j].first, border_[j].second, away), 2 * M_PI);
      if (turn <= 0) turn += 2 * M_PI;
      if (turn < least) least = turn, best = j;
    }
    return best;
  }

 private:
  const SideArrangement::Fragment& fragment(Index i) const { return a_.fragments()[border_[i].first]; }
  const SideArrangement& a_;
  const std::vector<std::pair<Index, bool>>& border_;
  std::vector<std::vector<Index>> leaving_;
  std::vector<double> nearest_;  // per place half the shortest fragment's chord
};

Error unclosed(const CurveNetwork& network, Point at) {
  const Point o = network.straight().origin();
  return {ErrorCode::computation, "the border of the polygons could not be told: it does not close",
          "near x " + std::to_string(at.x + o.x) + ", y " + std::to_string(at.y + o.y), "please report this input"};
}

Result<std::vector<std::vector<Index>>> loops(const CurveNetwork& network, const SideArrangement& a, const Walk& walk,
                                              std::size_t count) {
  std::vector<std::vector<Index>> result;
  std::vector<bool> done(count, false);
  for (Index first = 0; first < count; ++first) {
    if (done[first]) continue;
    result.emplace_back();
    Index i = first;
    do {
      done[i] = true;
      result.back().push_back(i);
      i = walk.next(i);
      if (i == none || (done[i] && i != first)) return unclosed(network, a.places()[walk.end(result.back().back())].at);
    } while (i != first);
  }
  return result;
}

/// The loop's fragments joined over mere poles.
std::vector<Run> runs_of(const SideArrangement& a, const std::vector<std::pair<Index, bool>>& border,
                         std::vector<Index> loop, const Walk& walk) {
  const auto side = [&](Index i) { return a.fragments()[border[i].first].side; };
  const auto goes_on = [&](Index i, Index j) {
    return side(i) == side(j) && border[i].second == border[j].second && a.places()[walk.start(j)].pole;
  };
  for (std::size_t k = 0; k < loop.size(); ++k) {  // begin where something begins
    if (goes_on(loop[(k + loop.size() - 1) % loop.size()], loop[k])) continue;
    std::rotate(loop.begin(), loop.begin() + std::ptrdiff_t(k), loop.end());
    break;
  }
  std::vector<Run> runs;
  Index start = none;  // of the run's first fragment
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Index fragment = border[loop[k]].first;
    const bool forward = border[loop[k]].second;
    // A full circle among other pieces stays in two.
    const bool closes = walk.end(loop[k]) == start && (k + 1 < loop.size() || runs.size() > 1);
    if (k > 0 && goes_on(loop[k - 1], loop[k]) && !closes) {
      (forward ? runs.back().last : runs.back().first) = fragment;
    } else {
      runs.push_back({fragment, fragment, forward});
      start = walk.start(loop[k]);
    }
  }
  return runs;
}

Zone::Piece piece_of(const SideArrangement& a, const Run& run, Point shift) {
  const RingSide& s = a.sides()[a.fragments()[run.first].side];
  const auto place = [&](Index i) { return Point{a.places()[i].at.x + shift.x, a.places()[i].at.y + shift.y}; };
  Point p = place(a.fragments()[run.first].from), q = place(a.fragments()[run.last].to);
  if (!run.forward) std::swap(p, q);
  Zone::Piece piece{Zone::Kind::segment, p, q, {}, 0, false};
  piece.role = Zone::Role::input;
  piece.from_arc = s.from_arc;
  if (s.arc) {
    piece.kind = Zone::Kind::arc;
    piece.center = {double(s.centre.x + shift.x), double(s.centre.y + shift.y)};
    piece.radius = double(s.radius);
    piece.clockwise = s.left != run.forward;
  }
  return piece;
}

/// Of fragments that coincide one if they are an odd number, else none; joined along their sides. True if there is any.
bool add_border(const CurveNetwork& network, const SideArrangement& a, CurveNetwork::Builder& builder) {
  std::vector<bool> stays(a.fragments().size(), false);
  for (std::size_t g = 0; g + 1 < a.groups().size(); ++g)
    if ((a.groups()[g + 1] - a.groups()[g]) % 2 == 1) stays[a.order()[a.groups()[g]]] = true;
  const Point o = network.straight().origin();
  const auto absolute = [&](Point p) { return Point{p.x + o.x, p.y + o.y}; };
  bool any = false;
  for (Index i = 0; i < a.fragments().size(); ++i) {
    if (!stays[i]) continue;
    any = true;
    Run run{i, i, true};
    const auto& first = a.fragments()[i];
    while (i + 1 < a.fragments().size() && stays[i + 1] && a.fragments()[i + 1].side == first.side &&
           a.places()[a.fragments()[i + 1].from].pole)
      run.last = ++i;
    const Point ends[] = {absolute(a.places()[first.from].at), absolute(a.places()[a.fragments()[run.last].to].at)};
    const RingSide& s = a.sides()[first.side];
    if (!s.arc) {
      builder.add_line(ends, {}, s.feature);
      continue;
    }
    const Point arc[] = {ends[0], absolute(rounded(middle_of(a, run))), ends[1]};
    const std::uint32_t middle[] = {1};
    builder.add_line(arc, middle, s.feature);
  }
  return any;
}

}  // namespace

Result<std::shared_ptr<const CurveNetwork>> border_network(std::shared_ptr<const CurveNetwork> network,
                                                           const Context& context) {
  std::vector<FeatureRings> features;
  bool overlap = false;
  for (const auto& [feature, rings] : shape::rings_by_feature(network->straight())) {
    auto f = take_apart(*network, rings, context);
    if (!f) return f.error();
    overlap = overlap || f->overlaps() || !f->collapsed.empty();
    features.push_back(std::move(*f));
  }
  if (!overlap) return network;
  CurveNetwork::Builder builder;
  bool any = false;
  for (const FeatureRings& f : features) any = add_border(*network, f.arrangement, builder) || any;
  if (!any) return std::shared_ptr<const CurveNetwork>();
  auto built = std::move(builder).build(context);
  if (!built) return built.error();
  return std::make_shared<const CurveNetwork>(std::move(*built));
}

Result<zone::ShapedRings> union_border(const CurveNetwork& network, const CurveNetwork& target,
                                       const Context& context) {
  std::vector<RingSide> sides;
  for (Index p = 0; p < network.straight().part_count(); ++p)
    if (network.straight().part_is_ring(p)) append_sides(network, p, sides);
  const auto arrangement = SideArrangement::make(network, sides, context);
  if (!arrangement) return cancelled();
  const auto border = directed_border(*arrangement);
  const Walk walk(*arrangement, border);
  const auto found = loops(network, *arrangement, walk, border.size());
  if (!found) return found.error();
  const SourceFinder sources(target);
  // Shorter ones may turn round, or become full circles, when they are written with the origin added.
  const double shortest = std::max(4 * target.straight().resolution(), arrangement->eps());
  const Point from = network.straight().origin(), to = target.straight().origin(), shift{from.x - to.x, from.y - to.y};
  zone::ShapedRings rings;
  rings.touch = true;  // polygons that share a vertex
  for (const auto& loop : *found) {
    for (const Run& run : runs_of(*arrangement, border, loop, walk)) {
      Zone::Piece piece = piece_of(*arrangement, run, shift);
      sources.find(piece, middle_of(*arrangement, run) + Q{shift.x, shift.y});
      if (rings.piece.size() > rings.begin.back()) piece.start = rings.piece.back().end;
      const double chord = std::hypot(piece.end.x - piece.start.x, piece.end.y - piece.start.y);
      const bool tiny = chord <= shortest && !(piece.kind == Zone::Kind::arc && is_more_than_half(*arrangement, run));
      if (!tiny) rings.piece.push_back(piece);
    }
    if (rings.piece.size() == rings.begin.back()) continue;
    rings.piece[rings.begin.back()].start = rings.piece.back().end;
    rings.close();
  }
  return rings;
}

}  // namespace krepl::arcs
