#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "mill/flat_fit.hpp"
#include "mill/free_moves.hpp"
#include "mill/grown_cutter.hpp"
#include "mill/rough_job.hpp"
#include "mill/rough_rings.hpp"
#include "mill/stock_raster.hpp"
#include "model/radius_check.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

constexpr double steps_a_spacing = 8;
constexpr double most_places = 0x1p23;

/// Places where the tool has been on a level, to find the nearest.
class VisitedPlaces {
 public:
  explicit VisitedPlaces(double size) : size_(size) {}
  void clear() { places_.clear(); }
  void add(Point p) { places_[key(p)].push_back(p); }
  /// Within `size` of p.
  std::optional<Point> nearest(Point p) const {
    std::optional<Point> best;
    double least = size_;
    const auto [i, j] = key(p);
    for (int x = i - 1; x <= i + 1; ++x)
      for (int y = j - 1; y <= j + 1; ++y)
        if (const auto found = places_.find({x, y}); found != places_.end())
          for (const Point q : found->second)
            if (const double d = length(q - p); d < least) least = d, best = q;
    return best;
  }

 private:
  std::pair<int, int> key(Point p) const { return {int(std::floor(p.x / size_)), int(std::floor(p.y / size_))}; }
  double size_;
  std::map<std::pair<int, int>, std::vector<Point>> places_;
};

/// A polyline of a level that is to be run, relative to the part's origin.
struct Piece {
  std::vector<Point> points;
  bool is_closed = false;
};

class OffsetRougher {
 public:
  OffsetRougher(const RoughJob& job, const LiftedCutter& prover, const Band& band, MillReport& report)
      : job_(job),
        o_(job.o),
        plan_(job.plan),
        report_(report),
        free_(prover, band, plan_, o_.accuracy.unit),
        radius_(radius_of(o_.tool)),
        spacing_(std::min(o_.step_over, radius_)),
        visited_(3 * spacing_) {
    const Terrain& part = job.cutter.drop.terrain();
    origin_ = part.origin();
    const double margin = o_.stock_margin;
    low_ = {part.lowest().x - margin, part.lowest().y - margin},
    high_ = {part.highest().x + margin, part.highest().y + margin};
    const double beyond = radius_ + 2 * spacing_;
    raster_.step = spacing_ / steps_a_spacing;
    raster_.first = {low_.x - beyond, low_.y - beyond};
    const double columns = std::ceil((high_.x - low_.x + 2 * beyond) / raster_.step) + 1,
                 rows = std::ceil((high_.y - low_.y + 2 * beyond) / raster_.step) + 1;
    places_ = columns * rows;
    if (places_ <= most_places) raster_.columns = std::size_t(columns), raster_.rows = std::size_t(rows);
    first_ = std::max(raster_.step / 2, 2 * o_.accuracy.tolerance);
    fit_.lattice = {o_.accuracy.unit, origin_};
    fit_.within = std::max(first_ / 4, 2 * o_.accuracy.unit);
    if (o_.accuracy.arcs) fit_.most_radius = 64 * (plan_.radius + part.extent());
    fit_.least_radius = o_.accuracy.least_arc_radius;
  }

  ToolPath path;

  Status run(const Context& context) {
    if (places_ > most_places)
      return usage("the step-over " + shown(o_.step_over) + " means a raster of more than 8 million places",
                   "use a larger one, or the pattern zigzag");
    Context quiet;
    quiet.threads = context.threads, quiet.cancel = context.cancel;
    if (!field_.build(job_.cutter, raster_, low_, high_, quiet)) return cancelled();
    const Cutter tool = o_.tool.cutter ? *o_.tool.cutter : *Cutter::ball(2 * radius_);
    stock_.emplace(raster_, low_, high_, job_.level(job_.heights.front()) - job_.above_tip(), tool);
    kernel::Progress progress(context, job_.heights.size() - 1);
    for (std::size_t n = 1; n < job_.heights.size(); ++n) {
      k_ = job_.heights[n], tip_ = job_.level(k_) - job_.above_tip();
      // Ridges between rings are not worth a move of their own.
      least_ = 0.05 * double(job_.heights[n - 1] - k_) * o_.accuracy.unit;
      field_.lay(job_.level(k_));
      forest_ = find_rings(field_, first_, spacing_);
      visited_.clear();
      std::vector<std::size_t> roots = forest_.roots;
      cut_nearest(roots);
      if (context.cancelled()) return cancelled();
      progress.add(1);
    }
    if (!path.moves.empty()) go({MoveKind::rapid, ArcPlane::xy, {at_.x, at_.y, plan_.safe}, {}, 0});
    report_.step_over = spacing_;
    return std::monostate{};
  }

 private:
  // Places.
  Point3 place(FlatPoint p, std::int64_t k) const {
    return {double(p.i) * o_.accuracy.unit, double(p.j) * o_.accuracy.unit, job_.absolute(k)};
  }
  FlatPoint rounded(Point p) const {
    return {std::llround((p.x + origin_.x) / o_.accuracy.unit), std::llround((p.y + origin_.y) / o_.accuracy.unit)};
  }
  Point flat(Point3 p) const { return {p.x - origin_.x, p.y - origin_.y}; }
  bool is_on_level() const { return !path.moves.empty() && at_.z == job_.absolute(k_); }
  /// The lowest height of the lattice at which the tool takes nothing off there, at least the level.
  std::int64_t clear_level(Point p) const {
    // Beside the block there is nothing, whatever the raster tells.
    if (std::hypot(std::max({0.0, low_.x - p.x, p.x - high_.x}), std::max({0.0, low_.y - p.y, p.y - high_.y})) >=
        radius_)
      return k_;
    const double tip = stock_->clear_height(p);
    return tip <= tip_ ? k_ : k_ + std::int64_t(std::ceil((tip - tip_) / o_.accuracy.unit));
  }

  // Moves.
  void go(const Move& m) {
    if (m.end == at_ && m.kind != MoveKind::clockwise && m.kind != MoveKind::counter_clockwise) return;
    path.moves.push_back(m);
    at_ = m.end;
  }
  Move line(Point3 to, double feed) const { return {MoveKind::line, ArcPlane::xy, to, {}, feed}; }
  /// Runs a move at a level, or down to one, and takes the stock off.
  void cut(const Move& m) {
    const bool arc = m.kind != MoveKind::line;
    std::vector<Point3> points;
    if (arc)
      append_chords(at_, m, raster_.step / 8, points);
    else
      points.push_back(m.end);
    Point3 from = at_;
    for (const Point3 p : points) {
      stock_->cut(flat(from), from.z - origin_.z - job_.above_tip(), flat(p), p.z - origin_.z - job_.above_tip());
      from = p;
    }
    go(m);
    if (is_on_level()) visited_.add(flat(at_));
  }
  /// Rapidly over everything, and down to where nothing is taken off yet, `k` units high at least.
  void descend(FlatPoint to, std::int64_t k) {
    const Point3 end = place(to, k);
    if (path.moves.empty()) path.start = at_ = {end.x, end.y, plan_.safe};
    go({MoveKind::rapid, ArcPlane::xy, {at_.x, at_.y, plan_.safe}, {}, 0});
    go({MoveKind::rapid, ArcPlane::xy, {end.x, end.y, plan_.safe}, {}, 0});
    const std::int64_t near =
        std::max(k, clear_level(flat(end))) + std::int64_t(std::ceil(job_.clearance() / o_.accuracy.unit));
    if (const Point3 above = place(to, near); above.z < at_.z) go({MoveKind::rapid, ArcPlane::xy, above, {}, 0});
    if (end.z < at_.z) go(line(end, o_.motion.plunge_feed));
  }

  // Order.
  double away(const RingNode& node) const {
    double least = 1e300;
    for (const RasterContour& ring : node.rings)
      for (std::size_t k = 0; k < ring.points.size(); k += 4)
        least = std::min(least, length(ring.points[k] - flat(at_)));
    return least;
  }
  void cut_nearest(std::vector<std::size_t>& nodes) {
    while (!nodes.empty()) {
      const auto next = std::min_element(nodes.begin(), nodes.end(), [&](std::size_t a, std::size_t b) {
        return away(forest_.nodes[a]) < away(forest_.nodes[b]);
      });
      const std::size_t node = *next;
      nodes.erase(next);
      cut_node(node);
    }
  }
  /// What is farther from the part first.
  void cut_node(std::size_t number) {
    std::vector<std::size_t> children = forest_.nodes[number].children;
    cut_nearest(children);
    RingNode& node = forest_.nodes[number];
    while (!node.rings.empty()) {
      std::size_t best = 0;
      double least = 1e300;
      for (std::size_t k = 0; k < node.rings.size(); ++k)
        for (std::size_t n = 0; n < node.rings[k].points.size(); n += 4)
          if (const double d = length(node.rings[k].points[n] - flat(at_)); d < least) best = k, least = d;
      const RasterContour ring = std::move(node.rings[best]);
      node.rings.erase(node.rings.begin() + std::ptrdiff_t(best));
      for (Piece& piece : to_cut(ring)) cut_piece(piece, node.farthest);
    }
  }

  /// The parts of a ring along which there is something to take off, a bit longer.
  std::vector<Piece> to_cut(const RasterContour& ring) const {
    const std::vector<Point>& points = ring.points;
    const std::size_t n = ring.is_closed() ? points.size() - 1 : points.size();
    const auto lead = std::size_t(std::ceil(spacing_ / 4 / raster_.step)) + 2;
    std::vector<char> wanted(n, 0);
    bool all = true;
    for (std::size_t k = 0; k < n; ++k) {
      if (!stock_->is_cut(points[k], tip_, least_)) continue;
      for (std::size_t m = 0; m <= 2 * lead; ++m) {
        const std::size_t at = k + m + n * (1 + lead / n) - lead;
        if (ring.is_closed())
          wanted[at % n] = 1;
        else if (k + m >= lead && k + m - lead < n)
          wanted[k + m - lead] = 1;
      }
    }
    std::size_t begin = 0;
    for (std::size_t k = 0; k < n; ++k)
      if (!wanted[k]) all = false, begin = k;
    if (all) return {{points, ring.is_closed()}};
    std::vector<Piece> pieces;
    const auto at = [&](std::size_t m) { return ring.is_closed() ? (begin + m) % n : m - 1; };
    for (std::size_t m = 1; m <= n; ++m) {
      if (!wanted[at(m)]) continue;
      if (m == 1 || !wanted[at(m - 1)]) {
        pieces.emplace_back();
        lead_in(points, m, at, pieces.back());
      }
      pieces.back().points.push_back(points[at(m)]);
    }
    std::erase_if(pieces, [](const Piece& p) { return p.points.size() < 2; });
    return pieces;
  }

  /// From farther back, if the tool gets down there beside the stock.
  template <class At>
  void lead_in(const std::vector<Point>& points, std::size_t first, const At& at, Piece& piece) const {
    const auto most = std::min(first, std::size_t(std::ceil(2 * radius_ / raster_.step)));
    std::size_t back = 0;
    while (back < most && clear_level(points[at(first - back)]) != k_) ++back;
    if (back == most) return;
    for (; back > 0; --back) piece.points.push_back(points[at(first - back)]);
  }

  void cut_piece(Piece& piece, std::size_t farthest) {
    ++report_.passes;
    if (piece.is_closed) start_near(piece, flat(at_));
    if (!enter(piece, farthest)) {
      ++report_.skipped_cuts;
      return;
    }
    ++report_.cuts;
    run_along(piece, farthest);
  }

  static void start_near(Piece& piece, Point p) {
    std::vector<Point>& points = piece.points;
    points.pop_back();
    const auto best =
        std::min_element(points.begin(), points.end(), [p](Point a, Point b) { return length(a - p) < length(b - p); });
    std::rotate(points.begin(), best, points.end());
    points.push_back(points.front());
  }

  /// To the start of a piece on the level: from where the tool is, or has been, or beside the stock, or by a helix or a
  /// ramp.
  bool enter(Piece& piece, std::size_t farthest) {
    const Point3 start = place(rounded(piece.points.front()), k_);
    if (is_on_level() && length(flat(start) - flat(at_)) <= 1.6 * spacing_ && free_.is_free(at_, line(start, 0))) {
      cut(line(start, o_.motion.feed));
      return true;
    }
    if (clear_level(flat(start)) == k_) {
      descend(rounded(piece.points.front()), k_);
      return true;
    }
    if (enter_from_visited(piece) || enter_by_helix(piece, farthest)) return true;
    return enter_by_ramp(piece);
  }

  bool enter_from_visited(Piece& piece) {
    const std::size_t every = piece.is_closed ? 2 : piece.points.size();
    for (std::size_t k = 0; k < piece.points.size(); k += every) {
      const std::optional<Point> near = visited_.nearest(piece.points[k]);
      if (!near) continue;
      const FlatPoint from = rounded(*near);  // a place of the lattice, where moves have ended
      const Point3 start = place(rounded(piece.points[k]), k_);
      if (stock_->is_cut(flat(place(from, k_)), tip_, least_) || !free_.is_free(place(from, k_), line(start, 0)))
        continue;
      descend(from, k_);
      if (piece.is_closed) start_near(piece, Point(piece.points[k]));
      cut(line(place(rounded(piece.points.front()), k_), o_.motion.feed));
      return true;
    }
    return false;
  }

  /// Down a helix about the place with the most room, and from it to the piece.
  bool enter_by_helix(Piece& piece, std::size_t farthest) {
    if (!o_.accuracy.arcs) return false;
    const FlatPoint centre = rounded(raster_.place(farthest));
    const double room = std::min(field_.distance()[farthest] - first_, 0.9 * radius_);
    const auto r = std::int64_t(std::floor(room / o_.accuracy.unit));
    if (room < radius_ / 4 || r < 1 || room < 2 * o_.accuracy.least_arc_radius) return false;
    const FlatPoint ends[2] = {{centre.i + r, centre.j}, {centre.i - r, centre.j}};
    Piece rotated = piece;
    if (piece.is_closed) start_near(rotated, flat(place(ends[0], k_)));
    const Point3 start = place(rounded(rotated.points.front()), k_);
    if (length(flat(start) - flat(place(ends[0], k_))) > 3 * spacing_ ||
        !free_.is_free(place(ends[0], k_), line(start, 0)))
      return false;
    const auto half_turn = [&](int n, std::int64_t k, double feed) {
      return Move{MoveKind::counter_clockwise, ArcPlane::xy, place(ends[n % 2], k), place(centre, k), feed};
    };
    for (const int n : {1, 2})
      if (!free_.is_free(place(ends[(n + 1) % 2], k_), half_turn(n, k_, 0))) return false;
    std::int64_t top = k_;
    for (int n = 0; n < 8; ++n) {
      const double turn = n * std::numbers::pi / 4;
      const Point c = flat(place(centre, k_));
      top = std::max(top, clear_level({c.x + room * std::cos(turn), c.y + room * std::sin(turn)}));
    }
    descend(ends[0], top);
    const double a_half =
        std::max(1.0, std::numbers::pi * double(r) * std::tan(o_.ramp_angle * std::numbers::pi / 180) - 1);
    // An even number of half turns, and one turn more on the level; none beside the stock.
    const int turns = 2 * int(std::ceil(double(top - k_) / a_half / 2));
    for (int n = 1; n <= turns; ++n) {
      const std::int64_t k = top - std::int64_t(double(top - k_) * n / turns);
      cut(half_turn(n, n == turns ? k_ : k, o_.motion.plunge_feed));
    }
    if (turns > 0)
      for (const int n : {1, 2}) cut(half_turn(n, k_, o_.motion.feed));
    cut(line(start, o_.motion.feed));
    piece = std::move(rotated);
    return true;
  }

  /// Down along the piece itself: around if it is closed, else to and fro.
  bool enter_by_ramp(const Piece& piece) {
    std::vector<FlatMove> moves;
    FlatFitOptions lines = fit_;
    lines.most_radius = 0;
    std::vector<FlatPoint> way{FlatFit(piece.points, lines).run(moves)};
    double around = 0;
    std::int64_t top = k_;
    for (const FlatMove& m : moves) {
      const Point3 from = place(way.back(), k_), to = place(m.end, k_);
      if (!free_.is_free(from, line(to, 0))) break;
      around += length(flat(to) - flat(from));
      way.push_back(m.end);
    }
    for (const Point p : piece.points) top = std::max(top, clear_level(p));
    if (around < radius_ || way.size() < 2) return false;
    descend(way.front(), top);
    run_down(way, piece.is_closed && way.size() == moves.size() + 1, top);
    return true;
  }

  /// Along a way, again and again, down to the level and on to its start.
  void run_down(const std::vector<FlatPoint>& way, bool is_closed, std::int64_t top) {
    const double slope = std::tan(o_.ramp_angle * std::numbers::pi / 180) / o_.accuracy.unit;  // units a length
    double z = double(top);  // the ramp, which the moves are not below
    std::int64_t k = top;
    for (bool is_back = false;; is_back = !is_closed && !is_back) {
      const std::int64_t before = k;
      for (std::size_t n = 1; n < way.size(); ++n) {
        const std::size_t from = is_back ? way.size() - n : n - 1, to = is_back ? from - 1 : n;
        const double down = length(flat(place(way[to], k_)) - flat(place(way[from], k_))) * slope;
        z = std::max(z - down, double(k_));
        k = std::max(std::int64_t(std::ceil(z)), k - std::int64_t(std::floor(down)));
        // The least of ramps still goes down.
        if (n + 1 == way.size() && k == before && k > k_) --k;
        cut(line(place(way[to], k), o_.motion.plunge_feed));
      }
      if (k == k_ && (is_closed || is_back)) return;
    }
  }

  /// The moves along a piece, from its start. Where one is not proven free, as at something too small for the raster,
  /// the tool goes as far as it can and on beyond that as along another piece.
  void run_along(const Piece& piece, std::size_t farthest) {
    std::vector<FlatMove> moves;
    FlatFit(piece.points, fit_).run(moves);
    std::size_t index = 0;  // of the point where the tool is
    for (const FlatMove& m : moves) {
      Move move = line(place(m.end, k_), o_.motion.feed);
      if (m.turn != 0)
        move.kind = m.turn > 0 ? MoveKind::counter_clockwise : MoveKind::clockwise, move.centre = place(m.centre, k_);
      if (!free_.is_free(at_, move)) {
        ++report_.lifted_moves;
        if (m.turn == 0) go_towards(move.end);
        go_on_beyond(piece, nearest_point(piece, index, flat(at_)), farthest);
        return;
      }
      cut(move);
      index = nearest_point(piece, index, flat(at_));
    }
  }

  /// As far as is proven free.
  void go_towards(Point3 end) {
    std::optional<Point3> last;
    double good = 0, bad = 1;
    for (int n = 0; n < 6; ++n) {
      const double t = 0.5 * (good + bad);
      const Point3 p = place(rounded(flat(at_) + t * (flat(end) - flat(at_))), k_);
      const bool is_free = p != at_ && free_.is_free(at_, line(p, 0));
      (is_free ? good : bad) = t;
      if (is_free) last = p;
    }
    if (last) cut(line(*last, o_.motion.feed));
  }

  static std::size_t nearest_point(const Piece& piece, std::size_t from, Point p) {
    std::size_t best = from;
    for (std::size_t k = from; k < piece.points.size(); ++k)
      if (length(piece.points[k] - p) < length(piece.points[best] - p)) best = k;
    return best;
  }

  void go_on_beyond(const Piece& piece, std::size_t index, std::size_t farthest) {
    double skipped = 0, left = 0;
    while (index + 1 < piece.points.size() && skipped < 4 * raster_.step)
      skipped += length(piece.points[index + 1] - piece.points[index]), ++index;
    Piece rest{{piece.points.begin() + std::ptrdiff_t(index), piece.points.end()}, false};
    for (std::size_t k = 1; k < rest.points.size(); ++k) left += length(rest.points[k] - rest.points[k - 1]);
    if (left >= radius_) cut_piece(rest, farthest);
  }

  const RoughJob& job_;
  const RoughOptions& o_;
  const Plan& plan_;
  MillReport& report_;
  FreeMoves free_;
  double radius_, spacing_, first_ = 0, places_ = 0, least_ = 0, tip_ = 0;
  Point3 origin_, at_;
  Point low_, high_;
  PlaneRaster raster_;
  LevelField field_;
  RingForest forest_;
  std::optional<StockRaster> stock_;
  FlatFitOptions fit_;
  VisitedPlaces visited_;
  std::int64_t k_ = 0;
};

}  // namespace

Result<ToolPath> rough_by_offsets(const RoughJob& job, MillReport& report, const Context& context) {
  const Band band =
      make_band(job.plan, job.o.accuracy, job.plan.lift == 0 ? 1 : roundness(*job.o.tool.cutter, job.o.tool.allowance));
  const Result<DropCutter> prover = make_prover(job.cutter.drop, job.plan, band, job.o.tool);
  if (!prover) return prover.error();
  const LiftedCutter lifted(*prover, prover_lift(job.plan, band, job.o.tool));
  OffsetRougher rougher(job, lifted, band, report);
  if (Status done = rougher.run(context); !done) return done.error();
  return std::move(rougher.path);
}

}  // namespace krepl::mill
