#include "cut_case.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "support/solid_distance.hpp"

namespace krepl::test {

namespace {

std::string text_of(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

std::string at(Point3 p) { return " at " + text_of(p.x) + ", " + text_of(p.y) + ", " + text_of(p.z); }

/// The ring as a polygon, fine enough to tell the inside but very near the boundary.
std::vector<Point3> fine_ring(std::span<const CutPiece> ring, double error) {
  std::vector<Point3> points{ring[0].start};
  for (const CutPiece& piece : ring) piece.append_points(error, points);
  return points;
}

bool is_around(const std::vector<Point3>& ring, Point p) {
  bool inside = false;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const Point3 a = ring[i], b = ring[i + 1];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) inside = !inside;
  }
  return inside;
}

double distance(const std::vector<Point3>& ring, Point p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const Point3 a = ring[i], b = ring[i + 1];
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const double t = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0;
    nearest = std::min(nearest, std::hypot(a.x + t * dx - p.x, a.y + t * dy - p.y));
  }
  return nearest;
}

}  // namespace

double uniform(Random& random, double low, double high) {
  return low + (high - low) * std::generate_canonical<double, 53>(random);
}

bool CutCase::passes(Point3 p, double within) const {
  double low = height({p.x, p.y}), high = low;
  for (int directions = 4; directions <= 256; directions *= 4) {
    for (double near = within; near > within * 0x1p-14; near /= 4) {
      for (int i = 0; i < directions; ++i) {
        if (low <= p.z + within && high >= p.z - within) return true;
        const double angle = 2 * std::numbers::pi * i / directions;
        const double h = height({p.x + near * std::cos(angle), p.y + near * std::sin(angle)});
        low = std::min(low, h), high = std::max(high, h);
      }
    }
  }
  // The bottom of a cleft between two walls that are tangent: it is there, but no place beside it is as low.
  return std::abs(double(solid_distance(triangles, p)) - surface->radius()) <= 1e-12 * scale();
}

bool CutCase::is_sound() const {
  for (Surface::Index e = 0; e < surface->subdivision().edge_count(); ++e) {
    if (surface->edge(e).kind == Surface::EdgeKind::rim) continue;
    for (const Point3 p : surface->curve(e, 5)) {
      if (!passes(p, 1e-9 * scale())) return false;
    }
  }
  return true;
}

bool CutCase::is_at_tangent_walls(Point3 p, double within) const {
  for (Surface::Index v = 0; v < surface->subdivision().vertex_count; ++v) {
    const Point3 q = surface->vertex(v);
    if (std::hypot(q.x - p.x, q.y - p.y) <= 0x1p-20 * scale() && !passes({q.x, q.y, p.z}, within)) return true;
  }
  return false;
}

std::optional<CutCase> make_case(std::shared_ptr<const Terrain> terrain, double radius, std::string name) {
  Result<Surface> surface = compute_surface(terrain, {radius});
  Result<DropCutter> cutter = DropCutter::build(terrain, radius);
  if (!surface || !cutter) return std::nullopt;
  CutCase c{std::move(name), terrain, std::make_shared<const Surface>(std::move(*surface)), {}, {}, {}};
  c.cutter = std::move(*cutter);
  Result<SurfaceCutter> cuts = SurfaceCutter::build(c.surface);
  if (!cuts) return std::nullopt;
  c.cuts = std::move(*cuts);
  return c;
}

std::optional<CutCase> make_case(const SmallTerrain& terrain) {
  const auto built = terrain_of(terrain);
  if (!built) return std::nullopt;
  auto c = make_case(*built, terrain.radius, text(terrain));
  if (!c) return c;
  c->triangles = triangles_of(terrain);
  const Point3 origin = c->terrain->origin();
  for (auto& triangle : c->triangles) {
    for (Point3& p : triangle) p = {p.x - origin.x, p.y - origin.y, p.z - origin.z};
  }
  return c;
}

std::shared_ptr<const Terrain> grid_of(std::size_t columns, std::size_t rows,
                                       const std::function<double(std::size_t, std::size_t)>& height) {
  std::vector<double> heights;
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) heights.push_back(height(c, r));
  }
  Result<Terrain> terrain =
      Terrain::from_grid({columns, rows, {0, 0}, 1, 1, Terrain::Split::rising}, std::move(heights));
  return std::make_shared<const Terrain>(std::move(*terrain));
}

SmallTerrain random_small_terrain(Random& random, int number) {
  std::vector<std::uint8_t> bytes(std::size_t(uniform(random, 12, 60)));
  for (auto& b : bytes) b = std::uint8_t(random());
  // The surface of a steep one may take seconds.
  auto family = SmallTerrainFamily(number % int(SmallTerrainFamily::count));
  if (family == SmallTerrainFamily::steep && number % 5 != 0) family = SmallTerrainFamily::soup;
  return decode_small_terrain(family, bytes);
}

std::optional<std::string> fault_of(const CutCase& c, const Contour& contour, int grid) {
  const double tolerance = 1e-9 * c.scale();
  std::vector<std::vector<Point3>> rings;
  for (std::size_t r = 0; r < contour.ring_count(); ++r) {
    const auto ring = contour.ring(r);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const CutPiece& piece = ring[i];
      if (!(piece.end == ring[(i + 1) % ring.size()].start)) return "a ring is open" + at(piece.end);
      for (const double s : {0.0, 0.01, 0.25, 0.5, 0.77, 0.99}) {
        const Point3 p = piece.at(s);
        if (!c.passes(p, tolerance) && !(piece.wall && c.is_at_tangent_walls(p, tolerance)))
          return (piece.wall ? "below a rim the surface is " : "the surface is ") + text_of(c.height({p.x, p.y})) +
                 at(p);
      }
    }
    rings.push_back(fine_ring(ring, 1e-6 * c.scale()));
  }
  for (std::size_t r = 0; r < rings.size(); ++r) {
    std::size_t depth = 0;
    for (std::size_t parent = contour.ring_parent[r]; parent != Contour::none; parent = contour.ring_parent[parent])
      ++depth;
    if (contour.ring_is_hole[r] != (depth % 2 == 1))
      return "a ring of depth " + std::to_string(depth) + " is the wrong way round" + at(rings[r][0]);
  }
  const Point3 low = c.terrain->lowest(), high = c.terrain->highest();
  const double radius = c.surface->radius();
  for (int i = 0; i < grid; ++i) {
    for (int j = 0; j < grid; ++j) {
      const Point p{low.x - radius + (high.x - low.x + 2 * radius) * (i + 0.483) / grid,
                    low.y - radius + (high.y - low.y + 2 * radius) * (j + 0.517) / grid};
      bool inside = false, near = false;
      for (const auto& ring : rings) inside ^= is_around(ring, p);
      const double h = c.height(p);
      if (inside == (h >= contour.level) || std::abs(h - contour.level) <= tolerance) continue;
      for (const auto& ring : rings) near |= distance(ring, p) <= 4e-6 * c.scale();
      if (!near) return "the surface is " + text_of(h) + ", " + (inside ? "inside" : "outside") + at({p.x, p.y, 0});
    }
  }
  return std::nullopt;
}

std::optional<std::string> fault_of(const CutCase& c, const Section& section, int places) {
  const double tolerance = 1e-9 * c.scale(), dx = section.to.x - section.from.x, dy = section.to.y - section.from.y;
  const double length = std::hypot(dx, dy);
  const auto along = [&](Point3 p) { return ((p.x - section.from.x) * dx + (p.y - section.from.y) * dy) / length; };
  std::vector<std::pair<double, double>> covered;
  double last = -tolerance;
  for (std::size_t k = 0; k < section.chain_count(); ++k) {
    const auto chain = section.chain(k);
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const CutPiece& piece = chain[i];
      if (i > 0 && !(chain[i - 1].end == piece.start)) return "a chain does not connect" + at(piece.start);
      // Where curves are tangent vertices are known along them to the root of the surface's tolerance only.
      const double back = 0x1p-22 * c.scale();
      if (along(piece.start) < last - back || along(piece.end) < along(piece.start) - back)
        return "a piece runs backwards" + at(piece.start);
      last = along(piece.end);
      for (const double s : {0.0, 0.01, 0.3, 0.5, 0.75, 0.99, 1.0}) {
        const Point3 p = piece.at(s);
        if (!c.passes(p, tolerance)) return "the surface is " + text_of(c.height({p.x, p.y})) + at(p);
        if (std::abs((p.y - section.from.y) * dx - (p.x - section.from.x) * dy) > tolerance * length)
          return "a point is beside the line" + at(p);
      }
    }
    covered.push_back({along(chain.front().start), along(chain.back().end)});
  }
  for (int i = 0; i < places; ++i) {
    const double t = length * (i + 0.41) / places;
    const Point p{section.from.x + t / length * dx, section.from.y + t / length * dy};
    bool inside = false;
    for (const auto& [from, to] : covered) inside |= from - tolerance <= t && t <= to + tolerance;
    if (inside != std::isfinite(c.height(p)) && !c.passes({p.x, p.y, c.terrain->lowest().z - 1}, tolerance))
      return std::string(inside ? "a chain over nothing" : "no chain") + at({p.x, p.y, c.height(p)});
  }
  return std::nullopt;
}

}  // namespace krepl::test
