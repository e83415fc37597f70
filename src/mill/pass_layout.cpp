#include "mill/pass_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace krepl::mill {
namespace {

/// The direction of small whole numbers that is nearest to an angle.
void find_direction(double degrees, std::int64_t most, std::int64_t& p, std::int64_t& q) {
  const double turn = std::remainder(degrees, 360.0) * std::numbers::pi / 180;
  const double x = std::cos(turn), y = std::sin(turn);
  double best = 2;
  for (std::int64_t a = 0; a <= most; ++a) {
    // The other number for each value of the one that belongs to the longer component.
    const bool flat = std::abs(x) >= std::abs(y);
    const double longer = flat ? std::abs(x) : std::abs(y), shorter = flat ? std::abs(y) : std::abs(x);
    if (a == 0) continue;
    const std::int64_t b = std::llround(double(a) * shorter / longer);
    const double off = std::abs(double(a) * shorter - double(b) * longer) / std::hypot(double(a), double(b));
    if (off < best * (1 - 1e-9) - 1e-15) {
      best = off;
      p = flat ? a : b, q = flat ? b : a;
    }
  }
  if (x < 0) p = -p;
  if (y < 0) q = -q;
}

}  // namespace

Line PassLayout::line(const Pass& pass) const {
  const double length = std::hypot(double(p), double(q));
  return {lattice.place(pass.i0, pass.j0), {double(p) / length, double(q) / length}};
}

double PassLayout::angle() const { return std::atan2(double(q), double(p)) * 180 / std::numbers::pi; }

PassLayout lay_passes(const Terrain& part, double unit, double degrees, double step_over, double margin,
                      double tolerance) {
  PassLayout layout;
  layout.lattice = {unit, part.origin()};
  // Passes are a whole number of lattice steps apart: of a few per cent of the step-over at most.
  const std::int64_t most =
      std::clamp<std::int64_t>(std::int64_t(std::min(step_over / 32, tolerance / 4) / unit / 1.415), 1, 120);
  find_direction(degrees, most, layout.p, layout.q);
  const double length = std::hypot(double(layout.p), double(layout.q));
  layout.step = length * unit;
  const double dx = double(layout.p) / length, dy = double(layout.q) / length;
  const Point3 low = part.lowest(), high = part.highest();
  const std::int64_t ci = std::llround(((low.x + high.x) / 2 + part.origin().x) / unit);
  const std::int64_t cj = std::llround(((low.y + high.y) / 2 + part.origin().y) / unit);
  const Point centre = layout.lattice.place(ci, cj);
  double along = 0, across = 0;  // half extents
  for (const double x : {low.x, high.x})
    for (const double y : {low.y, high.y}) {
      along = std::max(along, std::abs((x - centre.x) * dx + (y - centre.y) * dy));
      across = std::max(across, std::abs((y - centre.y) * dx - (x - centre.x) * dy));
    }
  along += margin, across += margin;
  const std::int64_t last = std::int64_t(std::ceil(along / layout.step));
  const double usable = std::max(step_over - layout.step, step_over / 2);  // places of passes are rounded
  const std::int64_t count = std::max<std::int64_t>(1, std::int64_t(std::ceil(2 * across / usable)));
  std::int64_t before = 0;
  for (std::int64_t k = 0; k < count; ++k) {
    const double at = -across + (double(k) + 0.5) * (2 * across / double(count));
    const std::int64_t n = std::llround(at / layout.step);
    if (k > 0) layout.step_over = std::max(layout.step_over, double(n - before) * layout.step);
    before = n;
    layout.passes.push_back({ci - n * layout.q, cj + n * layout.p, -last, last});
  }
  return layout;
}

}  // namespace krepl::mill
