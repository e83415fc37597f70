#include "mill/on_surface.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

constexpr int most_steps = 24;   // of a distance; a handful suffices
constexpr int most_pushes = 12;  // of a place in a valley, from one side to the other
constexpr int deepest = 12;

}  // namespace

/// What a ball over p touches bounds the distance of p. A ball a bit smaller than that either rests at p or below: then
/// nothing is nearer; or it rests higher, on something that is nearer.
OnSurface::Nearest OnSurface::nearest(Point3 p) const {
  constexpr double a_bit = 1e-9;
  double radius = cutter_.radius();
  Nearest best{0, {}, false};
  for (int k = 0; k < most_steps; ++k) {
    const Result<DropCutter> ball = cutter_.with_radius(radius);
    if (!ball) return best;
    const DropCutter::Contact contact = ball->at({p.x, p.y});
    if (!contact.touches()) {
      if (best.found || radius > 4 * cutter_.radius()) return best;
      radius *= 2;
      continue;
    }
    if (best.found && contact.height <= p.z) return best;
    // All below what is touched is solid.
    const Point3 touched{contact.point.x, contact.point.y, std::min(contact.point.z, p.z)};
    const double away = distance(p, touched);
    if (!best.found || away < best.distance) best = {away, touched, true};
    radius = (1 - a_bit) * best.distance;
    if (radius <= 1e-3 * cutter_.radius()) return best;
  }
  return best;
}

Point3 OnSurface::put(Point3 p) const {
  const double radius = cutter_.radius();
  Point3 at = p;
  for (int k = 0; k < most_pushes; ++k) {
    const Nearest n = nearest(at);
    if (!n.found || n.distance < radius / 4) break;
    if (std::abs(n.distance - radius) <= flatten_ / 8) return at;
    at = n.place + (radius / n.distance) * (at - n.place);
    if (n.distance > radius) return at;
    if (distance(at, p) > radius) break;
  }
  const DropCutter::Contact contact = cutter_.at({p.x, p.y});
  return contact.touches() ? Point3{p.x, p.y, contact.height} : p;
}

void OnSurface::append(Point3 a, Point3 b, int depth, std::vector<SpaceLine>& lines) const {
  const double far = distance(a, b);
  if (far > shortest_) {
    const Point3 middle = 0.5 * (a + b), c = put(middle);
    // Of long pieces also a quarter from both ends.
    const auto is_off = [&](Point3 p) { return distance(put(p), p) > flatten_; };
    if (distance(c, middle) > flatten_ ||
        (far > 4 * shortest_ && (is_off(0.75 * a + 0.25 * b) || is_off(0.25 * a + 0.75 * b)))) {
      if (depth < deepest && std::max(distance(a, c), distance(c, b)) < far) {
        append(a, c, depth + 1, lines);
        append(c, b, depth + 1, lines);
      } else {
        lines.push_back({b});
      }
      return;
    }
  }
  lines.back().push_back(b);
}

std::vector<SpaceLine> OnSurface::put(const SpaceLine& line) const {
  std::vector<SpaceLine> out{{put(line.front())}};
  const bool is_closed = line.size() > 2 && line.front() == line.back();
  const Point3 first = out.front().front();
  for (std::size_t k = 1; k < line.size(); ++k) {
    const bool is_last = k + 1 == line.size();
    const Point3 p = is_last && is_closed ? first : put(line[k]), before = out.back().back();
    if (!is_last && distance(p, before) < shortest_ / 2) continue;
    append(before, p, 0, out);
  }
  std::erase_if(out, [](const SpaceLine& l) { return l.size() < 2; });
  return out;
}

}  // namespace krepl::mill
