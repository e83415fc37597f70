#include "terrain/envelope.hpp"

#include <algorithm>

namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

Range operator*(Range a, Range b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  return {std::min({p, q, r, s}), std::max({p, q, r, s})};
}

Envelope::Envelope(const PatchSet& patches, double scale, SurfaceCounters& counters)
    : patches_(patches),
      tolerance_(0x1p-40 * scale),
      smallest_cell_(0x1p-36 * scale),
      smallest_stretch_(0x1p-50 * scale),
      noise_(0x1p-49 * scale),
      rim_width_(2 * tolerance_),
      least_up_(std::sqrt(2 * patches.radius() * tolerance_)),
      far_(patches.radius() >= scale),
      counters_(counters) {}

Index Envelope::winner(Point p, std::span<const Index> candidates) const {
  // What rounding alone tells apart counts as equal: of coplanar triangles one over the other, both would show here and there.
  Index best = none;
  double highest = below_everything;
  counters_.height_evaluations += candidates.size();
  const auto comes_first = [&](Index c, Index d) {
    const Patch &f = patches_[c], &g = patches_[d];
    return f.kind != g.kind ? f.kind > g.kind : f.feature < g.feature;  // face, edge, vertex
  };
  for (const Index c : candidates) {
    if (!patches_.contains(c, p)) continue;
    const double h = patches_.extended_height(c, p);
    if (best == none || h > highest + noise_) {
      best = c;
      highest = h;
    } else if (h >= highest - noise_) {
      if (comes_first(c, best)) best = c;
      highest = std::max(highest, h);
    }
  }
  return best;
}

double Envelope::clamped_height(Index i, Point p) const {
  const double h = patches_.extended_height(i, p);
  return h > below_everything ? h : rim_height(i, p);
}

Gradient Envelope::rim_gradient(Index i) const {
  const Patch& f = patches_[i];
  return f.kind == FeatureKind::edge ? Gradient{f.m * f.gx, f.m * f.gy} : Gradient{0, 0};
}

double Envelope::axis_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  return f.z + f.m * ((p.x - f.at.x) * f.gx + (p.y - f.at.y) * f.gy);
}

double Envelope::rim_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::face)
    return patches_.extended_height(i, p);  // nearly vertical, the cylinder beside it too thin to show
  if (f.kind == FeatureKind::vertex) return f.z;
  return f.z + f.m * std::clamp((p.x - f.at.x) * f.gx + (p.y - f.at.y) * f.gy, 0.0, f.length);
}

const Bound* Envelope::rim_at(Index i, Point p) const {
  for (const Bound& b : patches_.bounds(i)) {
    if (!b.rim) continue;
    const double value = std::fabs(b.value(p, patches_.square_radius()));
    if (value <= rim_width_ * (b.type == Bound::Type::disc ? 2 * patches_.radius() : 1)) return &b;
  }
  return nullptr;
}

double Envelope::border_height(Index i, Point p) const {
  return rim_at(i, p) != nullptr ? rim_height(i, p) : clamped_height(i, p);
}

/// Gradient of a function that vanishes along the curve between two labels.
Gradient Envelope::gradient_across(Index a, Index b, Meeting how, Point p) const {
  if (how == Meeting::seam) {
    if (const Bound* side = patches_.seam(a, b)) return bound_gradient(*side, p);
  }
  if (how == Meeting::valley) {
    const Gradient g = patches_.gradient(a, p), h = patches_.gradient(b, p);
    return {g.x - h.x, g.y - h.y};
  }
  for (const Index l : {a, b}) {
    if (l == none) continue;
    if (const Bound* rim = rim_at(l, p)) return bound_gradient(*rim, p);
  }
  return {0, 0};
}

Meeting Envelope::meeting(Index a, Index b, Point p) const {
  if (a == none || b == none) return Meeting::rim;
  if (patches_.seam(a, b) != nullptr) return Meeting::seam;
  const bool a_ends = rim_at(a, p) != nullptr, b_ends = rim_at(b, p) != nullptr;
  if (!a_ends && !b_ends) return Meeting::valley;
  const double difference = border_height(a, p) - border_height(b, p);
  // Just before its end a patch falls steeply: where the other one is higher than its rim, it has met that one before.
  if (a_ends != b_ends && (a_ends ? difference < 0 : difference > 0)) return Meeting::valley;
  const Gradient g = a_ends ? rim_gradient(a) : patches_.gradient(a, p), h = b_ends ? rim_gradient(b) : patches_.gradient(b, p);
  return std::fabs(difference) <= 64 * tolerance_ * (1 + std::hypot(g.x - h.x, g.y - h.y)) ? Meeting::valley : Meeting::rim;
}

GradientRange Envelope::sphere_gradient(Point at, const Box& box, double factor) const {
  const Range dx{box.low.x - at.x, box.high.x - at.x}, dy{box.low.y - at.y, box.high.y - at.y};
  const double near_x = dx.low > 0    ? dx.low
                        : dx.high < 0 ? -dx.high
                                      : 0,
               far_x = std::max(std::fabs(dx.low), std::fabs(dx.high));
  const double near_y = dy.low > 0    ? dy.low
                        : dy.high < 0 ? -dy.high
                                      : 0,
               far_y = std::max(std::fabs(dy.low), std::fabs(dy.high));
  const double square = patches_.square_radius(), least = 1e-12 * square;
  const double most = square - (near_x * near_x + near_y * near_y), fewest = square - (far_x * far_x + far_y * far_y);
  const Range inverse{1 / std::sqrt(std::max(least, most)), 1 / std::sqrt(std::max(least, fewest))};
  const Range f{-factor, -factor};
  return {dx * inverse * f, dy * inverse * f};
}

GradientRange Envelope::gradient_range(Index i, const Box& box) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::face) return {{f.gx, f.gx}, {f.gy, f.gy}};
  if (f.kind == FeatureKind::vertex) return sphere_gradient(f.at, box, 1);
  const Point mid = box.middle();
  const double aside = (mid.y - f.at.y) * f.gx - (mid.x - f.at.x) * f.gy;
  const double spread = std::fabs(f.gx) * box.half_y() + std::fabs(f.gy) * box.half_x();
  const double square = patches_.square_radius(), least = 1e-12 * square;
  const auto across = [&](double beta) { return -f.q * beta / std::sqrt(std::max(least, square - beta * beta)); };
  const Range a{across(aside + spread), across(aside - spread)};
  const Range along{f.m * f.gx, f.m * f.gx}, along_y{f.m * f.gy, f.m * f.gy};
  return {along + a * Range{-f.gy, -f.gy}, along_y + a * Range{f.gx, f.gx}};
}

Range Envelope::derivative_range(Index i, const Box& box, Gradient d) const {
  const Patch& f = patches_[i];
  if (f.kind != FeatureKind::edge) {
    const GradientRange g = gradient_range(i, box);
    return g.x * Range{d.x, d.x} + g.y * Range{d.y, d.y};
  }
  const Point mid = box.middle();
  const double aside = (mid.y - f.at.y) * f.gx - (mid.x - f.at.x) * f.gy;
  const double spread = std::fabs(f.gx) * box.half_y() + std::fabs(f.gy) * box.half_x();
  const double square = patches_.square_radius(), least = 1e-12 * square;
  const auto across = [&](double beta) { return -f.q * beta / std::sqrt(std::max(least, square - beta * beta)); };
  const double along = f.m * (f.gx * d.x + f.gy * d.y), aslant = d.y * f.gx - d.x * f.gy;
  return Range{across(aside + spread), across(aside - spread)} * Range{aslant, aslant} + Range{along, along};
}

Gradient Envelope::bound_gradient(const Bound& b, Point p) const {
  const double dx = p.x - b.at.x, dy = p.y - b.at.y;
  if (b.type == Bound::Type::line) return {b.nx, b.ny};
  if (b.type == Bound::Type::disc) return {2 * dx, 2 * dy};
  const double square = patches_.square_radius();
  const double up = std::sqrt(std::max(1e-12 * square, square - (dx * dx + dy * dy)));
  return {b.nx - b.c * dx / up, b.ny - b.c * dy / up};
}

GradientRange Envelope::bound_gradient_range(const Bound& b, const Box& box) const {
  if (b.type == Bound::Type::line) return {{b.nx, b.nx}, {b.ny, b.ny}};
  if (b.type == Bound::Type::disc) {
    return {{2 * (box.low.x - b.at.x), 2 * (box.high.x - b.at.x)}, {2 * (box.low.y - b.at.y), 2 * (box.high.y - b.at.y)}};
  }
  const GradientRange s = sphere_gradient(b.at, box, b.c);
  return {s.x + Range{b.nx, b.nx}, s.y + Range{b.ny, b.ny}};
}

}  // namespace krepl::terrain
