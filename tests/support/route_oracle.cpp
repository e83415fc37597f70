#include "support/route_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <queue>
#include <set>
#include <sstream>

namespace krepl::test {
namespace {

using Long = long double;
using Place = std::complex<Long>;
constexpr Long pi = 3.14159265358979323846264338327950288L;
constexpr Long unlimited = std::numeric_limits<Long>::infinity();

struct Stick {
  Place a, b;
};

Place place(Point p) { return {p.x, p.y}; }
Long dot(Place a, Place b) { return (std::conj(a) * b).real(); }
Long cross(Place a, Place b) { return (std::conj(a) * b).imag(); }

std::vector<Stick> sticks_of(const ZoneCase& c) {
  std::vector<Stick> sticks;
  for (const InputPart& part : c.parts) {
    const std::size_t n = part.vertices.size();
    if (n == 1) sticks.push_back({place(part.vertices[0]), place(part.vertices[0])});
    for (std::size_t i = 0; i + (part.ring ? 0 : 1) < n; ++i)
      sticks.push_back({place(part.vertices[i]), place(part.vertices[(i + 1) % n])});
  }
  return sticks;
}

Long distance(const Stick& s, Place p) {
  const Place d = s.b - s.a;
  const Long square = std::norm(d), t = square > 0 ? std::clamp<Long>(dot(d, p - s.a) / square, 0, 1) : 0;
  return std::abs(p - (s.a + t * d));
}

Long clearance(const std::vector<Stick>& sticks, Place p) {
  Long least = unlimited;
  for (const Stick& s : sticks) least = std::min(least, distance(s, p));
  return least;
}

bool cross_each_other(const Stick& s, const Stick& t) {
  return cross(s.b - s.a, t.a - s.a) * cross(s.b - s.a, t.b - s.a) < 0 &&
         cross(t.b - t.a, s.a - t.a) * cross(t.b - t.a, s.b - t.a) < 0;
}

Long distance(const Stick& s, const Stick& t) {
  if (cross_each_other(s, t)) return 0;
  return std::min({distance(s, t.a), distance(s, t.b), distance(t, s.a), distance(t, s.b)});
}

/// Least distance along an arc: at its ends and wherever it can be extremal or zero.
Long arc_clearance(const std::vector<Stick>& sticks, Place center, Long radius, Long from, Long span) {
  Long least = unlimited;
  for (const Stick& s : sticks) {
    std::vector<Long> angles{from, from + span};
    for (Place v : {s.a - center, s.b - center, s.b - s.a}) {
      if (v == Place{}) continue;
      for (int quarter = 0; quarter < 4; ++quarter) angles.push_back(std::arg(v) + quarter * pi / 2);
    }
    const Place d = s.b - s.a;
    if (d != Place{}) {  // where the circle crosses the line
      const Place u = d / std::abs(d);
      const Long across = cross(u, center - s.a), square = radius * radius - across * across;
      if (square > 0)
        for (Long side : {1.0L, -1.0L})
          angles.push_back(std::arg(side * std::sqrt(square) * u - Place{0, 1} * u * across));
    }
    for (Long angle : angles) {
      Long ahead = std::fmod(angle - from, 2 * pi);
      if (ahead < 0) ahead += 2 * pi;
      if (ahead <= span || angle == from + span)
        least = std::min(least, distance(s, center + std::polar(radius, angle)));
    }
  }
  return least;
}

struct Node {
  std::size_t circle;
  bool clockwise;
  Long angle;
};

/// The whole visibility graph.
class Graph {
 public:
  Graph(const ZoneCase& c, Point from, Point to, Long slack)
      : sticks_(sticks_of(c)), radius_(c.radius), least_(Long(c.radius) - slack), slack_(slack) {
    std::set<std::pair<double, double>> seen;
    for (const InputPart& part : c.parts)
      for (Point p : part.vertices)
        if (seen.insert({p.x, p.y}).second) circles_.push_back(place(p));
    const std::size_t n = circles_.size();
    centers_ = circles_;
    centers_.push_back(place(from)), centers_.push_back(place(to));
    nodes_ = {{n, false, 0}, {n + 1, false, 0}};
    edges_.resize(2);
    for (std::size_t a = 0; a < n + 2; ++a)
      for (std::size_t b = 0; b < n + 2; ++b) add_tangents(a, b);
    for (std::size_t circle = 0; circle < n; ++circle)
      for (bool clockwise : {false, true}) add_arcs(circle, clockwise);
  }

  std::optional<double> shortest() const {
    std::vector<Long> cost(nodes_.size(), unlimited);
    using Waiting = std::pair<Long, std::size_t>;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
    cost[0] = 0, queue.push({0, 0});
    while (!queue.empty()) {
      const auto [c, node] = queue.top();
      queue.pop();
      if (c > cost[node]) continue;
      if (node == 1) return double(c);
      for (auto [other, length] : edges_[node])
        if (c + length < cost[other]) cost[other] = c + length, queue.push({cost[other], other});
    }
    return std::nullopt;
  }

 private:
  bool is_end(std::size_t circle) const { return circle >= circles_.size(); }

  /// Tangents from a to b in the four pairs of senses, by the right triangle over the line of centres.
  void add_tangents(std::size_t a, std::size_t b) {
    const Place d = centers_[b] - centers_[a];
    const Long apart = std::abs(d);
    if (a == b || b == circles_.size() || a == circles_.size() + 1) return;
    if (apart == 0) {
      if (is_end(a) && is_end(b)) connect(0, 1, 0);
      return;
    }
    for (bool a_clockwise : {false, true}) {
      for (bool b_clockwise : {false, true}) {
        if ((is_end(a) && a_clockwise) || (is_end(b) && b_clockwise)) continue;
        const Long ra = is_end(a)     ? 0
                        : a_clockwise ? -radius_
                                      : radius_,
                   rb = is_end(b)     ? 0
                        : b_clockwise ? -radius_
                                      : radius_;
        if (apart < std::abs(ra - rb) - slack_) continue;
        const Long tilt = std::acos(std::clamp<Long>((ra - rb) / apart, -1, 1));
        // The radius to the tangent point, for positive sense on the right of the way.
        const Place normal = d / apart * std::polar<Long>(1, -tilt);
        const Place start = centers_[a] + ra * normal, end = centers_[b] + rb * normal;
        bool free = true;
        for (const Stick& s : sticks_) free = free && distance(s, Stick{start, end}) >= least_;
        if (!free) continue;
        connect(node(a, a_clockwise, std::arg(ra < 0 ? -normal : normal)),
                node(b, b_clockwise, std::arg(rb < 0 ? -normal : normal)), std::abs(end - start));
      }
    }
  }
  std::size_t node(std::size_t circle, bool clockwise, Long angle) {
    if (is_end(circle)) return circle - circles_.size();
    nodes_.push_back({circle, clockwise, angle});
    edges_.emplace_back();
    return nodes_.size() - 1;
  }
  void connect(std::size_t a, std::size_t b, Long length) { edges_[a].push_back({b, length}); }

  /// From every tangent point to the next one in the sense, if that is free.
  void add_arcs(std::size_t circle, bool clockwise) {
    std::vector<std::size_t> order;
    for (std::size_t i = 2; i < nodes_.size(); ++i)
      if (nodes_[i].circle == circle && nodes_[i].clockwise == clockwise) order.push_back(i);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return nodes_[a].angle < nodes_[b].angle; });
    for (std::size_t i = 0; i < order.size() && order.size() > 1; ++i) {
      const std::size_t a = order[i], b = order[(i + 1) % order.size()];
      Long span = nodes_[b].angle - nodes_[a].angle;
      if (span < 0) span += 2 * pi;
      if (arc_clearance(sticks_, circles_[circle], radius_, nodes_[a].angle, span) < least_) continue;
      clockwise ? connect(b, a, radius_ * span) : connect(a, b, radius_ * span);
      // Angles that differ by rounding only are one.
      if (span < 1e-9L) connect(a, b, radius_ * span), connect(b, a, radius_ * span);
    }
  }

  std::vector<Stick> sticks_;
  Long radius_, least_, slack_;
  std::vector<Place> circles_, centers_;
  std::vector<Node> nodes_;
  std::vector<std::vector<std::pair<std::size_t, Long>>> edges_;
};

/// A place on a piece, from 0 to 1, and the direction there.
struct OnPiece {
  Place at, direction;
};

struct Course {
  const Route::Piece& piece;
  Long radius, from = 0, span = 0;

  explicit Course(const Route::Piece& p) : piece(p), radius(std::abs(place(p.start) - place(p.center))) {
    const Place c = place(p.center);
    if (p.kind == Route::Kind::arc) {
      from = std::arg(place(p.start) - c), span = std::arg(place(p.end) - c) - from;
      if (!p.clockwise && span < 0) span += 2 * pi;
      if (p.clockwise && span > 0) span -= 2 * pi;
    }
  }
  OnPiece at(Long t) const {
    const Place a = place(piece.start), b = place(piece.end), c = place(piece.center), m = place(piece.control);
    if (piece.kind == Route::Kind::parabola)
      return {(1 - t) * (1 - t) * a + 2 * t * (1 - t) * m + t * t * b, 2 * (1 - t) * (m - a) + 2 * t * (b - m)};
    if (piece.kind != Route::Kind::arc) return {a + t * (b - a), b - a};
    const Place n = std::polar<Long>(1, from + t * span);
    return {c + radius * n, n * Place{0, piece.clockwise ? -1.0L : 1.0L}};
  }
};

std::string complaint(const char* what, std::size_t piece, Long found, Long wanted) {
  std::ostringstream text;
  text.precision(17);
  text << "piece " << piece << ": " << what << ": " << found << " against " << wanted;
  return text.str();
}

}  // namespace

long double clearance_of(const ZoneCase& c, Point p) { return clearance(sticks_of(c), place(p)); }

std::optional<double> brute_shortest(const ZoneCase& c, Point from, Point to, double slack) {
  return Graph(c, from, to, slack).shortest();
}

double sampled_widest(const ZoneCase& c, Point from, Point to, int steps, double* cell) {
  const std::vector<Stick> sticks = sticks_of(c);
  Long west = std::min(from.x, to.x), east = std::max(from.x, to.x), south = std::min(from.y, to.y),
       north = std::max(from.y, to.y);
  for (const Stick& s : sticks)
    for (Place p : {s.a, s.b})
      west = std::min(west, p.real()), east = std::max(east, p.real()), south = std::min(south, p.imag()),
      north = std::max(north, p.imag());
  const Long away = std::max({east - west, north - south, 4 * Long(c.radius)});
  west -= away, south -= away, east += away, north += away;
  const Long step = std::max(east - west, north - south) / steps;
  *cell = double(step);
  const std::size_t columns = std::size_t((east - west) / step) + 2, rows = std::size_t((north - south) / step) + 2;
  const auto at = [&](std::size_t i) {
    return Place{west + step * Long(i % columns), south + step * Long(i / columns)};
  };
  std::vector<Long> clear(columns * rows), best(columns * rows, -1);
  for (std::size_t i = 0; i < clear.size(); ++i) {
    const Place p = at(i);
    const Long frame = std::min({p.real() - west, east - p.real(), p.imag() - south, north - p.imag()});
    clear[i] = std::min(frame, clearance(sticks, p));
  }
  const auto near = [&](Point p) {
    return std::size_t(std::lround((Long(p.y) - south) / step)) * columns +
           std::size_t(std::lround((Long(p.x) - west) / step));
  };
  std::priority_queue<std::pair<Long, std::size_t>> queue;
  best[near(from)] = clear[near(from)];
  queue.push({best[near(from)], near(from)});
  while (!queue.empty()) {
    const auto [b, i] = queue.top();
    queue.pop();
    if (b < best[i]) continue;
    if (i == near(to)) return double(b);
    const std::size_t x = i % columns, y = i / columns;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if ((x == 0 && dx < 0) || (x + 1 == columns && dx > 0) || (y == 0 && dy < 0) || (y + 1 == rows && dy > 0))
          continue;
        const std::size_t j = std::size_t(std::ptrdiff_t(i) + dy * std::ptrdiff_t(columns) + dx);
        // Between two samples a thin wall may stand.
        bool walled = false;
        for (const Stick& s : sticks) walled = walled || cross_each_other(s, {at(i), at(j)});
        const Long through = walled ? 0 : std::min(b, clear[j]);
        if (through > best[j]) best[j] = through, queue.push({through, j});
      }
  }
  return 0;
}

std::optional<std::string> fault_in_route(const Route& route, const ZoneCase& c, Point from, Point to, bool smooth) {
  const std::vector<Stick> sticks = sticks_of(c);
  if (route.pieces.empty()) return "no pieces";
  Long scale = c.radius;
  for (const Stick& s : sticks)
    for (Place p : {s.a, s.b}) scale = std::max({scale, std::abs(p.real()), std::abs(p.imag())});
  const Long tolerance = 1e-9L * scale;
  if (std::abs(place(route.pieces.front().start) - place(from)) > tolerance) return "does not start at the start";
  if (std::abs(place(route.pieces.back().end) - place(to)) > tolerance) return "does not end at the goal";
  Long length = 0, least = unlimited;
  for (std::size_t i = 0; i < route.pieces.size(); ++i) {
    const Route::Piece& piece = route.pieces[i];
    const Course course(piece);
    constexpr int samples = 64;
    Long chords = 0, nearest = unlimited;
    for (int k = 0; k <= samples; ++k) {
      const Place p = course.at(Long(k) / samples).at;
      if (k > 0) chords += std::abs(p - course.at(Long(k - 1) / samples).at);
      nearest = std::min(nearest, clearance(sticks, p));
    }
    {
      if (nearest < c.radius - tolerance) return complaint("too near", i, nearest, c.radius);
      if (nearest < piece.clearance - tolerance) return complaint("clearance", i, nearest, piece.clearance);
      if (std::abs(chords - piece.length) > 2e-3L * chords + tolerance)
        return complaint("length", i, piece.length, chords);
      if (piece.kind == Route::Kind::arc && std::abs(course.radius - route.turn_radius) > tolerance)
        return complaint("radius of arc", i, course.radius, route.turn_radius);
      if (piece.kind == Route::Kind::arc && std::abs(std::abs(course.span) * course.radius - piece.length) > tolerance)
        return complaint("length of arc", i, piece.length, std::abs(course.span) * course.radius);
    }
    length += piece.length, least = std::min<Long>(least, piece.clearance);
    if (i == 0) continue;
    const Course before(route.pieces[i - 1]);
    if (std::abs(place(piece.start) - place(route.pieces[i - 1].end)) > tolerance)
      return complaint("gap before it", i, std::abs(place(piece.start) - place(route.pieces[i - 1].end)), 0);
    const Place u = before.at(1).direction, v = course.at(0).direction;
    const Long kink = std::abs(std::arg(std::conj(u) * v));
    // A short piece's direction is as good as its ends.
    if (smooth && kink > 1e-6L + 4 * tolerance / std::min<Long>(route.pieces[i - 1].length, piece.length))
      return complaint("kink before it", i, kink, 0);
  }
  if (std::abs(length - route.length) > tolerance) return complaint("length in all", 0, route.length, length);
  if (std::abs(least - route.clearance) > tolerance && least != route.clearance)
    return complaint("clearance in all", 0, route.clearance, least);
  return std::nullopt;
}

}  // namespace krepl::test
