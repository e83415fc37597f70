#include "support/surface_faults.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <random>
#include <span>
#include <thread>

#include "krepl/incremental.hpp"
#include "support/ball_oracle.hpp"
#include "support/surface_comparison.hpp"

namespace krepl::test {

namespace {

using Index = Surface::Index;
using EdgeKind = Surface::EdgeKind;
using Fault = std::optional<std::string>;
const std::string late = "not done after ";

std::string at(Point3 p) {
  char buffer[100];
  std::snprintf(buffer, sizeof buffer, " at (%.12g, %.12g, %.12g)", p.x, p.y, p.z);
  return buffer;
}
std::string amount(Long x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, " by %.3Lg", x);
  return buffer;
}

/// Sets a flag after some seconds of the process's own time, whatever else the machine does, unless it is gone before. If the
/// flag is not heeded, nothing but the case's text would help, so that is printed and the program ends.
class Alarm {
 public:
  Alarm(double seconds, const SmallTerrain& c)
      : thread_([this, seconds, &c] {
          std::unique_lock lock(mutex_);
          const auto gone = [&](double more) {
            for (const std::clock_t start = std::clock(); double(std::clock() - start) < more * CLOCKS_PER_SEC;) {
              if (wake_.wait_for(lock, std::chrono::milliseconds(50), [this] { return done_; })) return true;
            }
            return false;
          };
          if (gone(seconds)) return;
          rung = true;
          if (gone(10 * seconds)) return;
          std::fprintf(stderr, "does not stop when cancelled:\n%s", text(c).c_str());
          std::abort();
        }) {}
  ~Alarm() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  std::atomic<bool> rung = false;

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread thread_;
};

class Checker {
 public:
  Checker(const Surface& surface, const SmallTerrain& c, const SurfaceEffort& effort)
      : surface_(surface),
        terrain_(surface.terrain()),
        topology_(surface.subdivision()),
        effort_(effort),
        oracle_(triangles_of(c), terrain_.origin(), c.radius),
        radius_(c.radius),
        scale_(std::max(c.radius, terrain_.extent())),
        close_(1e-9 * scale_) {}

  Fault run() {
    if (const auto wrong = surface_.validate()) return "validate: " + *wrong;
    for (Index v = 0; v < topology_.vertex_count; ++v) {
      if (const Fault f = hovering(surface_.vertex(v), "vertex " + std::to_string(v))) return f;
    }
    on_rim_.assign(topology_.vertex_count, false);
    for (Index e = 0; e < topology_.edge_count(); ++e) {
      if (surface_.edge(e).kind != EdgeKind::rim) continue;
      on_rim_[topology_.origin[2 * e]] = on_rim_[topology_.origin[2 * e + 1]] = true;
    }
    for (Index e = 0; e < topology_.edge_count(); ++e) {
      if (const Fault f = edge(e)) return f;
    }
    return lines();
  }

 private:
  Fault hovering(Point3 p, const std::string& who) const {
    const Long deep = radius_ - oracle_.distance({p.x, p.y, p.z});
    if (deep > close_) return who + " lies inside" + amount(deep) + at(p);
    return std::nullopt;
  }

  /// The place along the edge where a ball touches is well determined only across the curve; the distances see the
  /// rest.
  Fault touching(const Surface::Edge& edge, Point3 p, const std::string& who) const {
    LongPoint foot[2] = {};
    int count = 0;
    for (const Index f : edge.feature) {
      if (f == Surface::none) continue;
      const Nearest n = nearest_on(terrain_.corners(f), {p.x, p.y, p.z});
      if (std::fabs(n.distance - radius_) > close_) {
        return who + " misses its feature " + std::to_string(f) + amount(n.distance - radius_) + at(p);
      }
      // Walls: so much height for a place that is off by close_.
      if (n.at.z > p.z + 5e-5 * scale_) return who + " touches feature " + std::to_string(f) + " from below" + at(p);
      foot[count++] = n.at;
    }
    if (edge.kind == EdgeKind::rim) {
      const Long off = std::hypot(foot[0].x - p.x, foot[0].y - p.y) - radius_;
      if (count != 1 || std::fabs(off) > close_) return who + " is off the rim" + amount(off) + at(p);
    } else if (edge.kind == EdgeKind::seam) {
      const Long off = std::hypot(foot[0].x - foot[1].x, foot[0].y - foot[1].y, foot[0].z - foot[1].z);
      if (off > 100 * close_) return who + " is a seam, but touches at two places" + amount(off) + at(p);
    }
    return std::nullopt;
  }

  Fault edge(Index e) const {
    const Surface::Edge edge = surface_.edge(e);
    const std::string who = "edge " + std::to_string(e);
    const int features = (edge.feature[0] != Surface::none) + (edge.feature[1] != Surface::none);
    if (features != (edge.kind == EdgeKind::rim ? 1 : 2)) return who + " has the wrong number of features";
    if (edge.feature[0] == edge.feature[1])
      return who + " separates feature " + std::to_string(edge.feature[0]) + " from itself";
    const std::vector<Point3> points = surface_.curve(e, effort_.points);
    for (const Point3 p : points) {
      if (const Fault f = hovering(p, who)) return f;
      if (const Fault f = touching(edge, p, who)) return f;
    }
    for (const bool last : {false, true}) {
      const Index v = topology_.origin[2 * e + last];
      const Point3 p = last ? points.back() : points.front(), q = surface_.vertex(v);
      const double apart = std::hypot(p.x - q.x, p.y - q.y);
      const bool below = on_rim_[v] && p.z < q.z;  // what meets a wall further down
      if (apart > close_ || (!below && std::abs(p.z - q.z) > close_)) {
        return who + " does not end in its vertex " + std::to_string(v) + amount(std::max(apart, std::abs(p.z - q.z))) +
               at(q);
      }
    }
    return std::nullopt;
  }

  struct Crossing {
    double y;
    Index below, above;
    Index edge;
  };
  /// All crossings of the line with polygons through so many points of each edge, from least y.
  std::vector<Crossing> crossings(double x, int points) const {
    std::vector<Crossing> all;
    for (Index e = 0; e < topology_.edge_count(); ++e) {
      const std::vector<Point3> p = surface_.curve(e, points);
      for (std::size_t i = 0; i + 1 < p.size(); ++i) {
        const bool forth = p[i].x <= x && x < p[i + 1].x, back = p[i + 1].x <= x && x < p[i].x;
        if (!forth && !back) continue;
        const double y = p[i].y + (x - p[i].x) / (p[i + 1].x - p[i].x) * (p[i + 1].y - p[i].y);
        const Index left = topology_.face[2 * e], right = topology_.face[2 * e + 1];
        all.push_back({y, forth ? right : left, forth ? left : right, e});
      }
    }
    std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) { return a.y < b.y; });
    return all;
  }

  /// Chords deviate from curves, so what does not fit is looked at again with shorter ones; what is nearer than they
  /// are exact remains open.
  Fault line(double x) const {
    constexpr int coarse = 17, fine = 1025;
    if (!line_fault(crossings(x, coarse), x, 0)) return std::nullopt;
    return line_fault(crossings(x, fine), x, 1e-5 * scale_);
  }

  Fault line_fault(const std::vector<Crossing>& all, double x, double open) const {
    Index face = 0;
    for (std::size_t first = 0, last; first < all.size(); first = last) {
      for (last = first + 1; last < all.size() && all[last].y - all[last - 1].y <= open;) ++last;
      const std::optional<Index> above = beyond({all.data() + first, last - first}, face);
      if (!above)
        return "faces do not fit across x = " + std::to_string(x) + " near y = " + std::to_string(all[first].y);
      face = *above;
      if (last == all.size() || all[last].y - all[last - 1].y <= 2 * open) continue;
      if (const Fault f = label(face, {x, (all[last - 1].y + all[last].y) / 2})) return f;
    }
    if (face != 0) return "the line at x = " + std::to_string(x) + " does not end outside";
    return std::nullopt;
  }

  /// The face above some crossings that may come in any order, if there is an order that starts from this face.
  static std::optional<Index> beyond(std::span<const Crossing> some, Index face) {
    std::map<Index, int> balance{{face, 1}};
    for (const Crossing& c : some) --balance[c.below], ++balance[c.above];
    std::optional<Index> last;
    for (const auto& [f, n] : balance) {
      if (n == 0) continue;
      if (n != 1 || last) return std::nullopt;
      last = f;
    }
    return last;
  }

  Fault label(Index face, Point p) const {
    const Index feature = face == 0 ? Surface::none : surface_.face_feature(face);
    const Long best = oracle_.height(p);
    const Point3 where{p.x, p.y, double(best)};
    if (feature == Surface::none) {
      if (best < -1e300L) return std::nullopt;
      return "something is touched where the surface has a hole or ends," + at(where);
    }
    const Long own = oracle_.height(terrain_.corners(feature), p);
    if (own >= best - close_) return std::nullopt;
    return "face " + std::to_string(face) + " of feature " + std::to_string(feature) + " is not the highest" +
           amount(best - own) + at(where);
  }

  Fault lines() const {
    std::mt19937 random(effort_.seed);
    const double low = terrain_.lowest().x - radius_, high = terrain_.highest().x + radius_;
    for (int i = 0; i < effort_.lines; ++i) {
      const double share = (double(i) + double(random()) / 4294967296.0) / effort_.lines;
      if (const Fault f = line(low + share * (high - low))) return f;
    }
    return std::nullopt;
  }

  const Surface& surface_;
  const Terrain& terrain_;
  const Subdivision& topology_;
  const SurfaceEffort& effort_;
  BallOracle oracle_;
  Long radius_;
  double scale_, close_;
  std::vector<bool> on_rim_;
};

}  // namespace

Result<Surface> surface_within(const SmallTerrain& c, double seconds) {
  auto terrain = terrain_of(c);
  if (!terrain) return terrain.error();
  Alarm alarm(seconds, c);
  Context context;
  context.threads = 1;
  context.cancel = &alarm.rung;
  return compute_surface(*terrain, {c.radius}, context);
}

Fault fault_in(const Surface& surface, const SmallTerrain& c, const SurfaceEffort& effort) {
  return Checker(surface, c, effort).run();
}

Fault fault_in(const SmallTerrain& c, const SurfaceEffort& effort) {
  if (!terrain_of(c)) return std::nullopt;  // no triangle with an area
  const auto surface = surface_within(c, effort.seconds);
  if (!surface) {
    const bool stopped = surface.error().code == ErrorCode::cancelled;
    return stopped ? late + std::to_string(effort.seconds) + " s" : surface.error().text();
  }
  const std::size_t triangles = terrain_of(c).value()->triangle_count(), edges = surface->subdivision().edge_count();
  if (edges > 1000 + 100 * triangles)
    return std::to_string(edges) + " edges from " + std::to_string(triangles) + " triangles";
  if (const Fault fault = fault_in(*surface, c, effort)) return fault;
  // Any test of small terrains is one of both engines if it is run so.
  static const bool both = std::getenv("KREPL_TEST_BOTH_ENGINES") != nullptr;
  return both ? fault_between_engines(*surface, c) : std::nullopt;
}

Fault fault_between_engines(const Surface& surface, const SmallTerrain& c) {
  IncrementalOptions options;
  options.radius = c.radius;
  const auto other = compute_surface_incremental(terrain_of(c).value(), options);
  if (!other) return "incremental: " + other.error().text();
  if (const Fault fault = fault_in(*other, c, {})) return "incremental: " + *fault;
  const double scale = std::max(c.radius, surface.terrain().extent());
  const Comparison comparison = compare(surface, *other, 1e-9 * scale);
  if (comparison.difference) return "the engines differ: " + *comparison.difference;
  return std::nullopt;
}

SmallTerrain minimised(SmallTerrain c, const SurfaceEffort& effort) {
  // A case that is late must not stand for one that is wrong, and would take as long at each attempt.
  const auto wrong = [&](const SmallTerrain& s) {
    const Fault f = fault_in(s, effort);
    return f && !f->starts_with(late);
  };
  for (bool found = wrong(c); found;) {
    found = false;
    for (SmallTerrain& s : smaller(c)) {
      if (!wrong(s)) continue;
      c = std::move(s);
      found = true;
      break;
    }
  }
  return c;
}

}  // namespace krepl::test
