#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "free/motion.hpp"
#include "free/shadow.hpp"
#include "free/tolerance.hpp"
#include "kernel/box_tree.hpp"
#include "kernel/packed_tree.hpp"
#include "krepl/free_space.hpp"
#include "model/isolated_vertices.hpp"
#include "model/radius_check.hpp"
#include "zone/polygon_locator.hpp"

namespace krepl {

using namespace free;
using kernel::Box;
using kernel::quad;

namespace {

Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
bool is_finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }
double largest(Point p) { return std::max(std::abs(p.x), std::abs(p.y)); }

template <class Real>
Vector<Real> seen(Point p, Point place) {
  return {Real(p.x) - place.x, Real(p.y) - place.y, 0};
}
Vector<double> nearest_of(const Box& b, Point c) {
  return {std::clamp(c.x, b.min_x, b.max_x) - c.x, std::clamp(c.y, b.min_y, b.max_y) - c.y, 0};
}

}  // namespace

/// The segments and isolated vertices of a network. Coordinates are relative to its origin.
class DiskFreeSpace::Index {
 public:
  explicit Index(const Network& network) : network_(network), isolated_(model::isolated_vertices(network)), tree_(boxes()) {
    if (network.has_polygons()) polygons_.emplace(network);
  }

  Tolerance tolerance(double radius, std::initializer_list<Point> places) const {
    double scale = std::max(radius, network_.extent());
    for (const Point& p : places) scale = std::max(scale, largest(p));
    return Tolerance(scale);
  }
  Contact clearance(Point c, double radius) const;
  std::optional<Cut> first_contact(Point from, Point to, double radius) const;

 private:
  struct Item {
    std::uint32_t a, b;
  };
  Item item(std::size_t i) const {
    const auto segments = network_.segments();
    if (i < segments.size()) return {segments[i].a, segments[i].b};
    return {isolated_[i - segments.size()], isolated_[i - segments.size()]};
  }
  template <class Real>
  Nearest<Real> nearest(std::size_t i, Point c) const {
    const Item ends = item(i);
    return nearest_of_segment(seen<Real>(network_.vertices()[ends.a], c), seen<Real>(network_.vertices()[ends.b], c));
  }
  std::vector<Box> boxes() const;

  /// Where an item is touched: its vertex, if it is near one.
  struct Feature {
    int dimension = 2;
    std::uint32_t number = 0;
    auto order() const { return std::tuple(dimension, number); }
  };
  Feature settle(std::size_t i, int where, Point p, double tolerance) const;
  Contact contact(Point c, double radius, const Nearest<quad>& found, Feature feature, bool inside,
                  const Tolerance& tolerance) const;

  const Network& network_;
  std::vector<std::uint32_t> isolated_;
  kernel::PackedTree<Box> tree_;
  std::optional<zone::PolygonLocator> polygons_;
};

std::vector<Box> DiskFreeSpace::Index::boxes() const {
  std::vector<Box> boxes(network_.segments().size() + isolated_.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const std::uint32_t v : {item(i).a, item(i).b}) boxes[i].add(network_.vertices()[v]);
  return boxes;
}

DiskFreeSpace::Index::Feature DiskFreeSpace::Index::settle(std::size_t i, int where, Point p, double tolerance) const {
  const Item ends = item(i);
  if (where == 0) return {0, ends.a};
  if (where == 1) return {0, ends.b};
  for (const std::uint32_t v : {ends.a, ends.b})
    if (std::hypot(network_.vertices()[v].x - p.x, network_.vertices()[v].y - p.y) <= tolerance) return {0, v};
  return {1, std::uint32_t(i)};
}

DiskFreeSpace::Contact DiskFreeSpace::Index::contact(Point c, double radius, const Nearest<quad>& found,
                                                     Feature feature, bool inside, const Tolerance& tolerance) const {
  Contact contact;
  const quad distance = found.distance();
  contact.clearance = tolerance.clearance(double(inside ? -distance - radius : distance - radius));
  contact.point = Point{double(c.x + found.at.x), double(c.y + found.at.y)} + network_.origin();
  contact.at_vertex = feature.dimension == 0;
  contact.source = contact.at_vertex ? network_.vertex_source(feature.number) : network_.segment_source(feature.number);
  return contact;
}

DiskFreeSpace::Contact DiskFreeSpace::Index::clearance(Point c, double radius) const {
  const Tolerance tolerance = this->tolerance(radius, {c});
  std::vector<std::pair<double, std::size_t>> candidates;  // rough distance, item
  double limit = never;
  tree_.nearest(
      limit,
      [&](const Box& b) {
        const auto near = nearest_of(b, c);
        return std::hypot(near.x, near.y);
      },
      [&](std::size_t i) {
        double rough = nearest<double>(i, c).distance();
        if (!std::isfinite(rough)) rough = double(nearest<quad>(i, c).distance());
        if (!(rough <= limit)) return;
        if (rough + tolerance.margin < limit) {
          limit = rough + tolerance.margin;
          std::erase_if(candidates, [&](const auto& other) { return other.first > limit; });
        }
        candidates.emplace_back(rough, i);
      });
  double best = never;
  Feature feature;
  std::optional<Nearest<quad>> nearest_one;
  for (const auto& candidate : candidates) {
    const Nearest<quad> found = nearest<quad>(candidate.second, c);
    const double distance = double(found.distance());
    if (distance > best) continue;
    const Point p{double(c.x + found.at.x), double(c.y + found.at.y)};
    const Feature here = settle(candidate.second, found.part, p, tolerance.touch);
    if (distance == best && here.order() > feature.order()) continue;
    best = distance, feature = here, nearest_one = found;
  }
  bool inside = false;
  if (polygons_) {
    std::vector<std::int64_t> features;
    polygons_->find(c, features);
    inside = !features.empty();
  }
  return contact(c, radius, *nearest_one, feature, inside, tolerance);
}

/// A motion that starts outside all polygons meets their outlines first.
std::optional<DiskFreeSpace::Cut> DiskFreeSpace::Index::first_contact(Point from, Point to, double radius) const {
  if (const Contact start = clearance(from, radius); !start.free()) return Cut{0, 0, from + network_.origin(), start};
  const Tolerance tolerance = this->tolerance(radius, {from, to});
  const Vector<double> motion = seen<double>(to, from);
  const double speed = std::hypot(motion.x, motion.y);
  double limit = std::nextafter(1.0, 2.0);
  std::optional<std::size_t> hit;
  const auto at = [&](double t) { return from + Point{t * motion.x, t * motion.y}; };
  const auto bound = [&](const Box& b) {
    const auto measure = [&](double t) {
      const Vector<double> near = nearest_of(b, at(t));
      const double distance = std::hypot(near.x, near.y);
      return Approach{distance, -dot(near, motion) / distance - tolerance.slope_error(distance, speed)};
    };
    return fall_to(measure, radius + tolerance.margin, 0, 1, 3);
  };
  const auto approach = [&]<class Real>(std::size_t i, double t, Real) {
    const Vector<Real> v(motion.x, motion.y, 0), shift = Real(t) * v;
    const Item ends = item(i);
    const Nearest<Real> near = nearest_of_segment(seen<Real>(network_.vertices()[ends.a], from) - shift,
                                                  seen<Real>(network_.vertices()[ends.b], from) - shift);
    const Real distance = near.distance();
    return Approach{double(distance), double(-dot(near.at, v) / distance)};
  };
  tree_.nearest(limit, bound, [&](std::size_t i) {
    const auto measure = [&](double t) {
      const Approach rough = approach(i, t, double());
      // Where a motion is nearly parallel, rounding must not decide whether it comes nearer. A step on a slope that is
      // too steep rather than too gentle does not go too far.
      const double error = tolerance.slope_error(rough.distance, speed);
      if (std::abs(rough.slope) > error) return Approach{rough.distance, rough.slope - error};
      return approach(i, t, quad());
    };
    const double t = first_cut(measure, radius, tolerance.touch, std::min(limit, 1.0));
    if (t < limit) limit = t, hit = i;
  });
  if (!hit) return std::nullopt;
  const Point place = at(limit);
  const Nearest<quad> found = nearest<quad>(*hit, place);
  const Point p{double(place.x + found.at.x), double(place.y + found.at.y)};
  const Feature feature = settle(*hit, found.part, p, tolerance.touch);
  return Cut{0, limit, place + network_.origin(), contact(place, radius, found, feature, false, tolerance)};
}

Result<DiskFreeSpace> DiskFreeSpace::build(std::shared_ptr<const Network> network, double radius,
                                           const Context& context) {
  if (!std::isfinite(radius) || radius <= 0)
    return Error{ErrorCode::usage, "the radius is " + shown(radius), "", "give a positive, finite number"};
  if (std::max(radius, network->extent()) > 1e100 || radius < 1e-100) {
    return Error{ErrorCode::input, "coordinates or radius are beyond 1e100, or the radius is below 1e-100", "",
                 "scale the input"};
  }
  auto index = std::make_shared<const Index>(*network);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return DiskFreeSpace(std::move(network), std::move(index), radius);
}

DiskFreeSpace::Contact DiskFreeSpace::clearance(Point place) const {
  if (!is_finite(place)) return {};
  return index_->clearance(place - network_->origin(), radius_);
}

Status DiskFreeSpace::clearance(std::span<const Point> places, std::span<Contact> contacts,
                                const Context& context) const {
  return for_each_place(places.size(), contacts.size(), context,
                        [&](std::size_t i) { contacts[i] = clearance(places[i]); });
}

std::optional<DiskFreeSpace::Cut> DiskFreeSpace::first_contact(Point from, Point to) const {
  if (!is_finite(from) || !is_finite(to)) return Cut{0, 0, from, {}};
  return index_->first_contact(from - network_->origin(), to - network_->origin(), radius_);
}

std::optional<DiskFreeSpace::Cut> DiskFreeSpace::first_contact(std::span<const Point> points) const {
  return first_of_legs<Cut>(points, [&](Point from, Point to) { return first_contact(from, to); });
}

}  // namespace krepl
