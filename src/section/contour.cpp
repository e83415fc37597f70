#include "section/contour.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vectors.hpp"
#include "section/each_cut.hpp"
#include "section/nesting.hpp"

namespace krepl::section {

using namespace vectors;
using Side = Crossing::Side;

ContourTracer::ContourTracer(const Parts& parts, double level, const ContourOptions& options)
    : parts_(parts), options_(options), level_(level), tracing_(parts) {
  contour_.level = level;
}

Result<Contour> ContourTracer::run() {
  collect_edges();
  move_off_vertices();
  for (const Index e : edges_) parts_.is_rim(e) ? cross_rim(e) : cross_edge(e);
  const bool paired = tracing_.pair(
      [&](const Patch& patch, const Crossing& c) {
        return patch.place_at_level({c.at.x, c.at.y}, level_);
      },
      [&](Index face, const Patch& patch, double angle) {
        return parts_.face_holds(face, patch.on_level_circle(level_, angle));  // just inside, as it may run along a rim
      });
  if (!paired || !trace())
    return Error{ErrorCode::computation, "the contour at " + std::to_string(contour_.level) + " does not close", "",
                 "please report this input"};
  add_domes();
  nest(contour_);
  return std::move(contour_);
}

void ContourTracer::collect_edges() {
  const double slack = 2 * parts_.shift;
  parts_.each_edge([&](const auto& box) { return box.low.z <= level_ + slack && box.high.z >= level_ - slack; },
                   [&](Index e) { edges_.push_back(e); });
}

/// Flat ground exactly at the level would be crossed wherever rounding has it.
void ContourTracer::move_off_vertices() {
  const double near = parts_.shift / 4;
  const auto is_near = [&](double height) { return std::abs(height - level_) <= near; };
  const auto edge_is_near = [&](Index e) {
    for (const Index h : {2 * e, 2 * e + 1}) {
      if (is_near(parts_.corner_height(h)) || is_near(parts_.corner_height(parts_.corner_beyond(h)))) return true;
      const Index face = parts_.topology().face[h];
      if (parts_.surface->face_feature(face) != none && is_near(parts_.patch(face).top())) return true;
    }
    return false;
  };
  const auto& domes = parts_.domes;
  const bool touches =
      std::any_of(edges_.begin(), edges_.end(), edge_is_near) ||
      std::any_of(domes.begin(), domes.end(), [&](const auto& d) { return is_near(d.top) || is_near(d.low); });
  if (touches) level_ += options_.ties_are_high ? -parts_.shift : parts_.shift;
}

void ContourTracer::cross_edge(Index e) {
  const bool starts_high = is_high(2 * e), ends_high = is_high(2 * e + 1);
  if (starts_high == ends_high && parts_.surface->edge(e).curve == Surface::Curve::line) return;
  find_crossings(
      EdgeCourse(parts_, e), e, Side::both, starts_high, ends_high, [&](Point3 p) { return p.z - level_; },
      2 * parts_.shift, tracing_.crossings);
}

void ContourTracer::cross_rim(Index e) {
  const Subdivision& topology = parts_.topology();
  const bool left_is_upper = parts_.surface->edge(e).feature[0] != none;
  const bool starts[2] = {is_high(2 * e), is_high(parts_.corner_beyond(2 * e))};
  const bool ends[2] = {is_high(parts_.corner_beyond(2 * e + 1)), is_high(2 * e + 1)};
  const Index first = Index(tracing_.crossings.size());
  for (const int side : {0, 1}) {
    const bool is_upper = (side == 0) == left_is_upper;
    const Index face = topology.face[2 * e + Index(side)];
    // The upper patch goes up or down evenly along a rim.
    if (parts_.surface->face_feature(face) == none || (is_upper && starts[side] == ends[side])) continue;
    const EdgeCourse course(parts_, e);
    const Patch patch = parts_.patch(face);
    const auto value = [&](Point3 p) { return (is_upper ? p.z : patch.height({p.x, p.y})) - level_; };
    find_crossings(course, e, side == 0 ? Side::left : Side::right, starts[side], ends[side], value, 2 * parts_.shift,
                   tracing_.crossings);
  }
  const auto begin = tracing_.crossings.begin() + first;
  std::stable_sort(begin, tracing_.crossings.end(), [](const Crossing& a, const Crossing& b) { return a.s < b.s; });
  const Index count = Index(tracing_.crossings.size()) - first;
  if (count > 0 || starts[0] != starts[1]) rims_.push_back({e, first, count, starts[0], starts[1]});
}

bool ContourTracer::is_wall(const Rim& rim, Index stretch) const {
  return (rim.left_starts_high != rim.right_starts_high) == (stretch % 2 == 0);
}

std::size_t ContourTracer::find_rim(Index edge) const {
  const auto at = std::lower_bound(rims_.begin(), rims_.end(), edge, [](const Rim& r, Index e) { return r.edge < e; });
  return std::size_t(at - rims_.begin());
}

/// The wall that begins where the contour leaves a face at a rim.
ContourTracer::Stretch ContourTracer::stretch_from(Index crossing) const {
  const std::size_t r = find_rim(tracing_.crossings[crossing].edge);
  const Index after = crossing - rims_[r].first_crossing + 1;
  return is_wall(rims_[r], after) ? Stretch{r, after, true} : Stretch{r, after - 1, false};
}

/// The wall that goes on where one ends along a half-edge: the next one clockwise, beyond what is high. So rings that
/// meet in a vertex touch there and do not cross.
ContourTracer::Stretch ContourTracer::stretch_after(Index half_edge) const {
  Index h = parts_.topology().next[half_edge];
  while (is_high(parts_.corner_beyond(h))) h = parts_.corner_beyond(h);
  const std::size_t r = find_rim(Subdivision::edge(h));
  return {r, h % 2 == 0 ? 0 : rims_[r].crossing_count, h % 2 == 0};
}

/// From the start of the stretch to the next crossing by which the contour enters a face. That, or none at a stretch
/// that it has been at before.
Index ContourTracer::add_wall(Stretch stretch) {
  const Subdivision& topology = parts_.topology();
  for (;;) {
    if (walked_[visited_index(stretch)]) return none;
    walked_[visited_index(stretch)] = true;
    const Rim& rim = rims_[stretch.rim];
    const Index half_edge = 2 * rim.edge + (stretch.forwards ? 0 : 1);
    const auto vertex = [&](Index v) { return at_level(parts_.surface->vertex(v)); };
    const Index before = rim.first_crossing + stretch.number - 1, after = before + 1;
    const bool starts_edge = stretch.number == 0, ends_edge = stretch.number == rim.crossing_count;
    const Point3 low = starts_edge ? vertex(topology.origin[2 * rim.edge]) : at_level(tracing_.crossings[before].at);
    const Point3 high = ends_edge ? vertex(topology.origin[2 * rim.edge + 1]) : at_level(tracing_.crossings[after].at);

    CutPiece piece;
    piece.wall = true;
    piece.start = stretch.forwards ? low : high;
    piece.end = stretch.forwards ? high : low;
    const Surface::Edge edge = parts_.surface->edge(rim.edge);
    const int upper = edge.feature[0] != none ? 0 : 1;
    piece.feature = edge.feature[std::size_t(upper)];
    piece.face = topology.face[2 * rim.edge + Index(upper)];
    if (parts_.surface->terrain().feature_kind(piece.feature) == Terrain::FeatureKind::vertex) {
      const Point at = parts_.patch(piece.face).at();
      const double radius = parts_.surface->radius(), turn = 2 * std::numbers::pi;
      piece.kind = CutPiece::Kind::circle;
      piece.centre = {at.x, at.y, contour_.level};
      const bool counter_clockwise = (half_edge & 1u) == Index(upper);
      piece.axis = {Point3{radius, 0, 0}, Point3{0, counter_clockwise ? radius : -radius, 0}};
      const auto angle = [&](Point3 p) { return std::atan2((p.y - at.y) * (counter_clockwise ? 1 : -1), p.x - at.x); };
      piece.from = angle(piece.start);
      piece.to = angle(piece.end);
      const bool whole = starts_edge && ends_edge && topology.origin[2 * rim.edge] == topology.origin[2 * rim.edge + 1];
      if (whole)
        piece.to = piece.from + turn;
      else if (piece.to < piece.from)
        piece.to += turn;
      if (!whole && piece.to - piece.from > turn - 1e-6 && distance(piece.start, piece.end) <= 1e-6 * radius)
        piece.to -= turn;
    }
    if (!(piece.start == piece.end) || piece.kind == CutPiece::Kind::circle) contour_.pieces.push_back(piece);
    if (stretch.forwards ? !ends_edge : !starts_edge) return stretch.forwards ? after : before;
    stretch = stretch_after(half_edge);
  }
}

void ContourTracer::add_patch_piece(Index from, Index to) {
  const Index face = tracing_.entered(from);
  const Patch patch = parts_.patch(face);
  const auto& crossings = tracing_.crossings;
  const Point3 start = crossings[from].at, end = crossings[to].at;
  CutPiece piece = patch.level_piece({start.x, start.y, level_}, {end.x, end.y, level_});
  piece.start.z = piece.end.z = piece.centre.z = contour_.level;
  piece.face = face;
  piece.feature = parts_.surface->face_feature(face);
  if (patch.is_sphere()) piece.to = piece.from + tracing_.sweep(from);
  contour_.pieces.push_back(piece);
}

/// From a crossing by which the contour enters a face until it is back there.
bool ContourTracer::follow(Index first) {
  Index crossing = first;
  do {
    if (crossing == none || !tracing_.enters(crossing) || entered_[crossing]) return false;
    entered_[crossing] = true;
    const Index exit = tracing_.exit(crossing);
    add_patch_piece(crossing, exit);
    crossing = tracing_.crossings[exit].side == Side::both ? exit : add_wall(stretch_from(exit));
  } while (crossing != first);
  end_ring();
  return true;
}

bool ContourTracer::trace() {
  entered_.assign(tracing_.crossings.size(), false);
  walked_.assign(tracing_.crossings.size() + rims_.size(), false);
  for (Index c = 0; c < tracing_.crossings.size(); ++c) {
    if (tracing_.enters(c) && !entered_[c] && !follow(c)) return false;
  }
  for (std::size_t r = 0; r < rims_.size(); ++r) {
    if (!is_wall(rims_[r], 0)) continue;
    const Stretch stretch{r, 0, rims_[r].left_starts_high};
    // What has crossings has been followed; the others make rings of walls alone.
    if (walked_[visited_index(stretch)] || rims_[r].crossing_count > 0) continue;
    if (add_wall(stretch) != none) return false;
    end_ring();
  }
  return true;
}

void ContourTracer::add_domes() {
  for (const auto& dome : parts_.domes) {
    if (level_ < dome.low || level_ >= dome.top || tracing_.meets(dome.face)) continue;
    const Subdivision& topology = parts_.topology();
    if (is_high(topology.face_outer[dome.face])) continue;
    const auto holes = topology.inner_loops(dome.face);
    const bool around = std::any_of(holes.begin(), holes.end(), [&](Index h) { return is_high(h); });
    if (!around && !dome.holds_top) continue;
    CutPiece piece = parts_.patch(dome.face).level_circle(level_);
    piece.start.z = piece.end.z = piece.centre.z = contour_.level;
    piece.face = dome.face;
    piece.feature = parts_.surface->face_feature(dome.face);
    contour_.pieces.push_back(piece);
    end_ring();
  }
}

/// Too small to be told from a point: rounding at a place where the level is tangent.
void ContourTracer::end_ring() {
  const auto begin = contour_.pieces.begin() + contour_.ring_begin.back();
  const double least = 0x1p-36 * parts_.scale;
  const bool shows = std::any_of(begin, contour_.pieces.end(), [&](const CutPiece& piece) {
    return distance(begin->start, piece.at(0.5)) > least || distance(begin->start, piece.end) > least;
  });
  if (!shows)
    contour_.pieces.erase(begin, contour_.pieces.end());
  else
    contour_.ring_begin.push_back(Index(contour_.pieces.size()));
}

}  // namespace krepl::section

namespace krepl {

const Surface& SurfaceCutter::surface() const { return *parts_->surface; }

Result<SurfaceCutter> SurfaceCutter::build(std::shared_ptr<const Surface> surface, const Context& context) {
  auto parts = std::make_shared<section::Parts>(std::move(surface));
  if (!parts->build(context)) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return SurfaceCutter(std::move(parts));
}

Result<Contour> SurfaceCutter::contour(double level, const ContourOptions& options) const {
  if (!std::isfinite(level)) return Error{ErrorCode::usage, "the level is not finite", "", ""};
  return section::ContourTracer(*parts_, level, options).run();
}

Result<std::vector<Contour>> SurfaceCutter::contours(std::span<const double> levels, const ContourOptions& options,
                                                     const Context& context) const {
  return section::make_each<Contour>(levels.size(), context, [&](std::size_t i) { return contour(levels[i], options); });
}

}  // namespace krepl
