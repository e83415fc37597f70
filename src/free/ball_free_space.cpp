#include <tuple>

#include "free/motion.hpp"
#include "free/terrain_shadows.hpp"
#include "free/tolerance.hpp"
#include "kernel/orientation.hpp"
#include "kernel/parallel.hpp"
#include "krepl/free_space.hpp"
#include "model/radius_check.hpp"

namespace krepl {

using namespace free;
using kernel::quad;

namespace {

Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
bool is_finite(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }
double largest(Point3 p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

template <class Real>
Nearest<Real> nearest_of(const Part& part, Point3 place) {
  const Vector<Real> p[3] = {{part.corner[0], place}, {part.corner[1], place}, {part.corner[2], place}};
  return nearest_of_shadow(p, part.vertical);
}

/// What a nearest point belongs to. `order` is that among equal distances.
struct Feature {
  int dimension = 3;
  Terrain::Index number = Terrain::none;
  auto order() const { return std::tuple(dimension, number); }
};

/// The feature of lowest dimension that a point of the triangle, or below it, is on.
Feature settle(const Part& part, int where, Point3 p, double tolerance) {
  const auto from = [&](std::size_t k) { return Vector<double>(part.corner[k], p); };
  if (where < edge_part) return {0, part.vertex[std::size_t(where)]};
  const bool on_face = where == face_part;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!on_face && k != std::size_t(where - edge_part) && k != std::size_t(where - edge_part + 1) % 3) continue;
    const Vector<double> to = from(k);
    // Below an edge, what is near is told from above.
    const bool below = !on_face && to.z > 0 && part.corner[0].x != part.corner[1].x;
    if ((below ? std::hypot(to.x, to.y) : length(to)) <= tolerance) return {0, part.vertex[k]};
  }
  if (!on_face) return {1, part.edge[std::size_t(where - edge_part)]};
  for (std::size_t k = 0; k < 3; ++k)
    if (nearest_of_segment(from(k), from((k + 1) % 3)).distance() <= tolerance) return {1, part.edge[k]};
  return {2, part.face};
}

}  // namespace

class BallFreeSpace::Index {
 public:
  Index(const Terrain& terrain, const Context& context)
      : terrain_(terrain), origin_(terrain.origin()), shadows_(terrain, context) {}

  Tolerance tolerance(double radius, std::initializer_list<Point3> places) const {
    double scale = std::max(radius, terrain_.extent());
    for (const Point3& p : places) scale = std::max(scale, largest(p));
    return Tolerance(scale);
  }

  Contact clearance(Point3 c, double radius) const {
    const Tolerance tolerance = this->tolerance(radius, {c});
    if (std::optional<Contact> inside = below_upper_side(c, radius, tolerance)) return *inside;
    return nearest(c, radius, tolerance);
  }

  /// The contact with one part.
  Contact touch(const Part& part, Point3 c, double radius, const Tolerance& tolerance) const {
    const Nearest<quad> found = nearest_of<quad>(part, c);
    const Point3 p{double(c.x + found.at.x), double(c.y + found.at.y), double(c.z + found.at.z)};
    return {tolerance.clearance(double(found.distance() - radius)), p + origin_,
            settle(part, found.part, p, tolerance.touch).number};
  }

  std::optional<Cut> first_contact(Point3 from, Point3 to, double radius) const;

 private:
  std::optional<Contact> below_upper_side(Point3 c, double radius, const Tolerance& tolerance) const;
  Contact nearest(Point3 c, double radius, const Tolerance& tolerance) const;

  const Terrain& terrain_;
  Point3 origin_;
  TerrainShadows shadows_;
};

/// The highest upper side above the place, if there is one.
std::optional<BallFreeSpace::Contact> BallFreeSpace::Index::below_upper_side(Point3 c, double radius,
                                                                             const Tolerance& tolerance) const {
  const Point at{c.x, c.y};
  quad highest = c.z;
  Feature feature;
  double limit = -c.z;  // negative heights, for the search looks for the least
  const auto plane = [](Point3 p) { return Point{p.x, p.y}; };
  const auto bound = [&](const ShadowBox& b) { return b.covers(c) ? -b.top : never; };
  shadows_.tree().nearest(limit, bound, [&](std::size_t block) {
    shadows_.for_each(block, [&](const Part& part) {
      if (part.vertical) return;
      int left = 0, right = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const int side = kernel::orientation(plane(part.corner[k]), plane(part.corner[(k + 1) % 3]), at);
        left += side > 0, right += side < 0;
      }
      if (left > 0 && right > 0) return;
      const Vector<quad> p[3] = {{part.corner[0], c}, {part.corner[1], c}, {part.corner[2], c}};
      const Vector<quad> n = cross(p[1] - p[0], p[2] - p[0]);
      if (n.z == 0) return;
      const quad height = c.z + dot(n, p[0]) / n.z;
      const Feature here = settle(part, face_part, {c.x, c.y, double(height)}, tolerance.touch);
      if (!(height > c.z) || double(height) < double(highest)) return;
      if (double(height) == double(highest) && here.order() > feature.order()) return;
      highest = height, feature = here;
      limit = -double(highest) + tolerance.margin;
    });
  });
  if (feature.number == Terrain::none) return std::nullopt;
  return Contact{double(c.z - highest) - radius, Point3{c.x, c.y, double(highest)} + origin_, feature.number};
}

/// In double precision first; what may be the nearest is then measured in quadruple precision.
BallFreeSpace::Contact BallFreeSpace::Index::nearest(Point3 c, double radius, const Tolerance& tolerance) const {
  struct Candidate {
    double rough;
    Part part;
  };
  std::vector<Candidate> candidates;
  double limit = never;
  const auto bound = [&](const ShadowBox& b) { return length(b.nearest(c)); };
  shadows_.tree().nearest(limit, bound, [&](std::size_t block) {
    shadows_.for_each(block, [&](const Part& part) {
      const Vector<double> p[3] = {{part.corner[0], c}, {part.corner[1], c}, {part.corner[2], c}};
      double rough = nearest_of_shadow(p, part.vertical).distance();
      if (!std::isfinite(rough) || is_sliver(p)) rough = double(nearest_of<quad>(part, c).distance());
      if (!(rough <= limit)) return;
      if (rough + tolerance.margin < limit) {
        limit = rough + tolerance.margin;
        std::erase_if(candidates, [&](const Candidate& other) { return other.rough > limit; });
      }
      candidates.push_back({rough, part});
    });
  });
  double best = never;
  Feature feature;
  Contact contact;
  for (const Candidate& candidate : candidates) {
    const Nearest<quad> found = nearest_of<quad>(candidate.part, c);
    const quad distance = found.distance();
    if (double(distance) > best) continue;
    const Point3 p{double(c.x + found.at.x), double(c.y + found.at.y), double(c.z + found.at.z)};
    const Feature here = settle(candidate.part, found.part, p, tolerance.touch);
    if (double(distance) == best && here.order() > feature.order()) continue;
    best = double(distance), feature = here;
    contact = {tolerance.clearance(double(distance - radius)), p + origin_, here.number};
  }
  return contact;
}

std::optional<BallFreeSpace::Cut> BallFreeSpace::Index::first_contact(Point3 from, Point3 to, double radius) const {
  if (const Contact start = clearance(from, radius); !start.free()) return Cut{0, 0, from + origin_, start};
  const Tolerance tolerance = this->tolerance(radius, {from, to});
  const Vector<double> motion(to, from);
  const double speed = length(motion);
  double limit = std::nextafter(1.0, 2.0);
  std::optional<Part> hit;
  const auto at = [&](double t) { return from + Point3{t * motion.x, t * motion.y, t * motion.z}; };
  const auto bound = [&](const ShadowBox& b) {
    const auto measure = [&](double t) {
      const Vector<double> near = b.nearest(at(t));
      const double distance = length(near);
      return Approach{distance, -dot(near, motion) / distance - tolerance.slope_error(distance, speed)};
    };
    return fall_to(measure, radius + tolerance.margin, 0, 1, 3);
  };
  const auto approach = [&]<class Real>(const Part& part, double t, Real) {
    const Vector<Real> v(motion.x, motion.y, motion.z), shift = Real(t) * v;
    const Vector<Real> p[3] = {Vector<Real>(part.corner[0], from) - shift, Vector<Real>(part.corner[1], from) - shift,
                               Vector<Real>(part.corner[2], from) - shift};
    const Nearest<Real> near = nearest_of_shadow(p, part.vertical);
    const Real distance = near.distance();
    return Approach{double(distance), double(-dot(near.at, v) / distance)};
  };
  const auto cut_by = [&](const Part& part, bool sliver) {
    const auto measure = [&](double t) {
      if (sliver) return approach(part, t, quad());
      const Approach rough = approach(part, t, double());
      // Where a motion is nearly level with what it passes, rounding must not decide whether it comes nearer. A step on
      // a slope that is too steep rather than too gentle does not go too far.
      const double error = tolerance.slope_error(rough.distance, speed);
      if (std::abs(rough.slope) > error) return Approach{rough.distance, rough.slope - error};
      return approach(part, t, quad());
    };
    return first_cut(measure, radius, tolerance.touch, std::min(limit, 1.0));
  };
  shadows_.tree().nearest(limit, bound, [&](std::size_t block) {
    shadows_.for_each(block, [&](const Part& part) {
      ShadowBox box;
      for (const Point3& p : part.corner) box.add(p);
      if (!(bound(box) < limit)) return;
      const Vector<double> p[3] = {{part.corner[0], from}, {part.corner[1], from}, {part.corner[2], from}};
      const double t = cut_by(part, is_sliver(p));
      if (t < limit) limit = t, hit = part;
    });
  });
  if (!hit) return std::nullopt;
  const Point3 place = at(limit);
  return Cut{0, limit, place + origin_, touch(*hit, place, radius, tolerance)};
}

Result<BallFreeSpace> BallFreeSpace::build(std::shared_ptr<const Terrain> terrain, double radius,
                                           const Context& context) {
  if (auto error = refuse_radius(*terrain, radius, 0x1p-50)) return *error;
  auto index = std::make_shared<const Index>(*terrain, context);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return BallFreeSpace(std::move(terrain), std::move(index), radius);
}

Result<BallFreeSpace> BallFreeSpace::with_radius(double radius) const {
  if (auto error = refuse_radius(*terrain_, radius, 0x1p-50)) return *error;
  return BallFreeSpace(terrain_, index_, radius);
}

BallFreeSpace::Contact BallFreeSpace::clearance(Point3 place) const {
  if (!is_finite(place)) return {};
  return index_->clearance(place - terrain_->origin(), radius_);
}

Status BallFreeSpace::clearance(std::span<const Point3> places, std::span<Contact> contacts,
                                const Context& context) const {
  return for_each_place(places.size(), contacts.size(), context,
                        [&](std::size_t i) { contacts[i] = clearance(places[i]); });
}

std::optional<BallFreeSpace::Cut> BallFreeSpace::first_contact(Point3 from, Point3 to) const {
  if (!is_finite(from) || !is_finite(to)) return Cut{0, 0, from, {}};
  return index_->first_contact(from - terrain_->origin(), to - terrain_->origin(), radius_);
}

std::optional<BallFreeSpace::Cut> BallFreeSpace::first_contact(std::span<const Point3> points) const {
  return first_of_legs<Cut>(points, [&](Point3 from, Point3 to) { return first_contact(from, to); });
}

}  // namespace krepl
