#include "verify/owner_verifier.hpp"

#include <algorithm>
#include <atomic>
#include <string>

#include "verify/boundary.hpp"
#include "verify/tally.hpp"

namespace krepl::verify {

namespace {

/// A segment of the input that knows its owner.
struct OwnedSegment {
  Point a, b;
  std::uint32_t owner;
  Box box() const {
    Box r;
    r.add(a), r.add(b);
    return r;
  }
  Real distance(Vec p) const { return distance_to_segment(p, a, b); }
};

class Owners {
 public:
  Owners(std::span<const std::vector<InputPart>> owners, const Obstacle& all) : all_(all), segments_(collect(owners)) {
    for (std::uint32_t o = 0; o < owners.size(); ++o) {
      const bool polygons = std::any_of(owners[o].begin(), owners[o].end(), [](const InputPart& p) { return p.ring; });
      if (polygons) polygons_.emplace_back(o, Obstacle(owners[o]));
    }
  }

  const NearestTree<OwnedSegment>& segments() const { return segments_; }

  struct Nearest {
    Real distance;
    std::uint32_t owner;
    bool certain;  ///< no other owner is as near, give or take the tolerance
  };
  Nearest nearest(Vec p, Real tolerance) const {
    for (const auto& [owner, polygon] : polygons_) {  // ascending
      if (polygon.box().meets(at(p)) && polygon.in_polygon(p)) return {0, owner, all_.distance(p) > tolerance};
    }
    const auto hit = segments_.nearest(p);
    return {hit.distance, segments_.items()[hit.item].owner, second(p, hit.distance, hit.item, tolerance) > tolerance};
  }
  /// By how much the next owner is farther; infinite where that is more than the tolerance.
  Real second(Vec p, Real distance, std::uint32_t item, Real tolerance) const {
    Real least = HUGE_VALL;
    const std::uint32_t owner = segments_.items()[item].owner;
    segments_.for_each_in(at(p).grown(distance + 2 * tolerance), [&](std::uint32_t i) {
      if (segments_.items()[i].owner != owner) least = std::min(least, segments_.items()[i].distance(p) - distance);
    });
    return least;
  }
  /// How far p is from being on a border: at the radius, as near to two owners, on a ring.
  Real off_border(Vec p, Real radius, Real tolerance) const {
    const auto hit = segments_.nearest(p);
    Real off = std::min(std::abs(hit.distance - radius), second(p, hit.distance, hit.item, tolerance));
    if (all_.has_polygons()) off = std::min(off, hit.distance);
    return off;
  }

 private:
  static Box at(Vec p) {
    Box b;
    b.add(p);
    return b;
  }
  static std::vector<OwnedSegment> collect(std::span<const std::vector<InputPart>> owners) {
    std::vector<OwnedSegment> all;
    for (std::uint32_t o = 0; o < owners.size(); ++o) {
      const Obstacle own(owners[o]);
      for (const auto& s : own.segments().items()) all.push_back({s.a, s.b, o});
    }
    return all;
  }

  const Obstacle& all_;
  NearestTree<OwnedSegment> segments_;
  std::vector<std::pair<std::uint32_t, Obstacle>> polygons_;
};

/// Anywhere, or around the input.
Vec sample_point(const Owners& owners, const Box& region, Real radius, std::uint64_t seed, std::size_t i) {
  Random random(seed, i);
  if (i % 4 == 0)
    return {region.x0 + random.unit() * (region.x1 - region.x0), region.y0 + random.unit() * (region.y1 - region.y0)};
  const auto& segments = owners.segments().items();
  const auto& s = segments[random.below(segments.size())];
  const Real t = random.unit(), far = 1.2L * radius * random.unit(), angle = 6.283185307179586L * random.unit();
  return Vec(s.a) + t * (Vec(s.b) - Vec(s.a)) + far * Vec(std::cos(angle), std::sin(angle));
}

}  // namespace

Result<std::vector<Check>> check_owners(std::span<const std::vector<InputPart>> owners,
                                        std::span<const std::vector<input::ResultPolygon>> shares,
                                        const OwnerCheckOptions& options, const Context& context) {
  std::vector<InputPart> parts;
  for (const auto& own : owners) parts.insert(parts.end(), own.begin(), own.end());
  const Obstacle all(parts);
  const Owners nearest(owners, all);
  const Real tolerance = std::max(Real(1e-9L) * std::max(Real(options.radius), all.extent()), 64 * all.resolution());
  const Real deviation = tolerance + options.max_error;
  std::vector<Boundary> boundaries;
  for (const auto& share : shares) boundaries.emplace_back(share, all, ArcPlaces{options.radius, tolerance});

  const Box region = all.box().grown(options.radius);
  std::atomic<std::uint64_t> undecided{0};
  const Tally membership = tally_all(context, options.samples, [&](std::size_t i, Tally& t) {
    const Vec p = sample_point(nearest, region, options.radius, options.seed, i);
    const auto found = nearest.nearest(p, 2 * deviation);
    const bool inside = found.distance < options.radius;
    if (!found.certain || std::abs(found.distance - options.radius) <= deviation) {
      undecided.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    bool right = true;
    for (std::uint32_t o = 0; o < boundaries.size(); ++o) {
      const int expected = inside && o == found.owner ? 1 : 0;
      const Box box = boundaries[o].box();
      const bool near = !box.empty() && box.square_distance(p) == 0;
      right = right && (near ? boundaries[o].winding(p) : 0) == expected;
    }
    t.add(right ? 0 : found.distance, 0, p);
  });
  const Tally borders = tally_all(context, boundaries.size(), [&](std::size_t o, Tally& t) {
    for (const Curve& curve : boundaries[o].curves().items()) {
      for (const Real at : {0.0L, 0.3L, 0.8L}) {
        const Vec p = curve.at(at);
        t.add(nearest.off_border(p, options.radius, 2 * deviation), 2 * deviation, p);
      }
    }
  });
  if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while checking", "", ""};
  std::vector<Check> checks{membership.check("places with the nearest owner", 0),
                            borders.check("borders between owners", 2 * deviation)};
  if (undecided > 0) checks[0].note = std::to_string(undecided.load()) + " too near a border to tell";
  return checks;
}

}  // namespace krepl::verify
