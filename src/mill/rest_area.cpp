#include "mill/rest_area.hpp"

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "mill/on_surface.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

constexpr int most_rounds = 12;
constexpr double least_gain = 0.75;  // of a round: what remains of the distance too far

/// Whether a free place of the larger ball is within `radius` of x; looked for from c on.
bool is_reached(const DropCutter& larger, const OnSurface& surface, Point3 x, Point3 c, double radius) {
  double excess = 1e300;
  for (int k = 0; k < most_rounds; ++k) {
    const DropCutter::Contact contact = larger.at({c.x, c.y});
    if (!contact.touches() || contact.height <= c.z) return true;
    if (distance({c.x, c.y, contact.height}, x) <= radius) return true;
    c = surface.put(c);
    const double away = distance(c, x);
    if (away <= radius) return true;
    if (away - radius > least_gain * excess) return false;
    excess = away - radius;
    c = x + (radius / away) * (c - x);
  }
  return false;
}

}  // namespace

bool find_rest(const SurfaceGrid& grid, const DropCutter& cutter, const RestOf& o, const Context& context,
               std::vector<char>& rest) {
  rest.assign(grid.size(), 0);
  const Result<DropCutter> larger = cutter.with_radius(o.radius + o.allowance);
  if (!larger) return false;
  const double slack = o.threshold / 8;
  const OnSurface surface(*larger, slack, slack);
  return kernel::parallel_blocks(context, grid.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      const auto place = SurfaceGrid::Index(v);
      if (!grid.touches(place)) continue;
      const Point3 n = grid.normal(place), q = grid.centre(place) - cutter.radius() * n;
      const Point3 x = q + (o.allowance + o.threshold) * n;
      rest[v] = !is_reached(*larger, surface, x, q + (o.allowance + o.radius) * n, o.radius - slack / 8);
    }
  });
}

}  // namespace krepl::mill
