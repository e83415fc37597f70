// Checks of the subdivision as a drawing in the plane.
#include <algorithm>
#include <cmath>

#include "verify/edge_map.hpp"

namespace krepl::verify {

namespace {

using Index = SurfaceCase::Index;
using Vec3 = Space<double>;

struct LoopArea {
  double area = 0;   ///< by chords, corrected for the curves
  double doubt = 0;  ///< how far that may be off
  Vec where;
};

LoopArea area_of(const SurfaceCase& surface, Index start) {
  const SubdivisionFile& file = surface.file;
  const Vec3 origin(file.vertices[file.half_edges[start].origin]);
  LoopArea loop;
  loop.where = Vec(origin.x, origin.y);
  double perimeter = 0;
  Index h = start;
  do {
    const Index e = file.half_edges[h].edge;
    const double sense = surface.forward[e] == h ? 1 : -1;
    for (std::uint64_t i = file.edges[e].first + 1; i < file.points_end(e); ++i) {
      const Vec3 a = surface.point(i - 1) - origin, b = surface.point(i) - origin;
      loop.area += sense * (a.x * b.y - a.y * b.x) / 2;
      perimeter += std::hypot(b.x - a.x, b.y - a.y);
    }
    loop.area += sense * surface.bulge[e];
    loop.doubt += std::abs(surface.bulge[e]) / 4;
    h = file.half_edges[h].next;
  } while (h != start);
  loop.doubt += perimeter * surface.tolerance;
  return loop;
}

Check check_sense(const SurfaceCase& surface, double& area) {
  Tally sum;
  std::size_t thin = 0;
  area = 0;
  for (Index l = 0; l < surface.loop_start.size(); ++l) {
    const LoopArea loop = area_of(surface, surface.loop_start[l]);
    if (surface.label(surface.file.half_edges[surface.loop_start[l]].face) != SurfaceCase::none) area += loop.area;
    const double wrong = surface.loop_outer[l] ? -loop.area : loop.area;
    thin += std::abs(loop.area) <= loop.doubt;
    // A loop that turns the wrong way is wrong by its area; the square root is a length that can be compared.
    sum.add(wrong > loop.doubt ? std::sqrt(wrong - loop.doubt) : 0, 0, loop.where);
  }
  Check check = sum.check("loops turn the right way", 0);
  if (thin > 0) check.note = std::to_string(thin) + " too thin to tell";
  return check;
}

/// How far one of the four ends would have to move so that the chords no longer cross; 0 if they do not.
double crossing_depth(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto side = [](Vec3 p, Vec3 q, Vec3 r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); };
  const double c_side = side(a, b, c), d_side = side(a, b, d), a_side = side(c, d, a), b_side = side(c, d, b);
  if (!(c_side * d_side < 0 && a_side * b_side < 0)) return 0;
  const double ab = std::hypot(b.x - a.x, b.y - a.y), cd = std::hypot(d.x - c.x, d.y - c.y);
  return std::min(std::min(std::abs(c_side), std::abs(d_side)) / ab, std::min(std::abs(a_side), std::abs(b_side)) / cd);
}

Check check_crossings(const SurfaceCase& surface, const EdgeMap& map) {
  const SubdivisionFile& file = surface.file;
  const Tally sum = tally_all(surface.context, file.edges.size(), [&](std::size_t e, Tally& t) {
    double worst = 0;
    Vec where;
    map.tree().for_each_near(map.box_of(Index(e)), [&](Index g) {
      if (g <= e) return;
      for (std::uint64_t i = file.edges[e].first + 1; i < file.points_end(e); ++i)
        for (std::uint64_t j = file.edges[g].first + 1; j < file.points_end(g); ++j) {
          const Vec3 a = surface.point(i - 1);
          const double depth = crossing_depth(a, surface.point(i), surface.point(j - 1), surface.point(j)) -
                               surface.sag[e] - surface.sag[g];
          if (depth > worst) worst = depth, where = Vec(a.x, a.y);
        }
    });
    t.add(worst, surface.tolerance, where);
  });
  return sum.check("edges do not cross", surface.tolerance);
}

/// Each component lies in the face that lists its inner loop: seen from its highest place.
Check check_places(const SurfaceCase& surface, const EdgeMap& map) {
  const SubdivisionFile& file = surface.file;
  constexpr double low = -HUGE_VAL;
  std::vector<Point3> highest(surface.components, {0, low, 0});
  std::vector<Index> face(surface.components, SurfaceCase::none);
  for (Index e = 0; e < file.edges.size(); ++e) {
    Point3& high = highest[surface.component[file.half_edges[surface.forward[e]].origin]];
    for (std::uint64_t i = file.edges[e].first; i < file.points_end(e); ++i)
      if (file.points[i].y > high.y) high = file.points[i];
  }
  for (std::size_t l = 0; l < surface.loop_start.size(); ++l) {
    const auto& half = file.half_edges[surface.loop_start[l]];
    if (!surface.loop_outer[l]) face[surface.component[half.origin]] = half.face;
  }
  const Tally sum = tally_all(surface.context, surface.components, [&](std::size_t c, Tally& t) {
    std::vector<Index> found;
    map.locate(highest[c].x, highest[c].y, found, Index(c));
    const bool right = std::find(found.begin(), found.end(), face[c]) != found.end();
    t.add(right ? 0 : 1, 0, Vec(highest[c].x, highest[c].y));
  });
  return sum.check("components in their faces", 0);
}

}  // namespace

std::vector<Check> check_embedding(const SurfaceCase& surface, double& area) {
  const EdgeMap map(surface);
  return {check_sense(surface, area), check_crossings(surface, map), check_places(surface, map)};
}

}  // namespace krepl::verify
