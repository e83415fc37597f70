#include "terrain/drop_cutter_stretch.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/drop_cutter_hierarchy.hpp"

namespace krepl {

class DropCutterAccess {
 public:
  static const auto& hierarchy(const DropCutter& cutter) { return *cutter.hierarchy_; }
  using Trace = DropCutter::Hierarchy::Trace;
};

namespace drop {
namespace {

/// A ball about p touches p over every place within R of it, which bounds the height from below.
struct LowerBound {
  double slope_x = 0, slope_y = 0;
  double height = nothing;  // over the whole rectangle, after the slope is taken off
};

LowerBound below(const DropCutter::Contact& contact, Point centre, double half_x, double half_y, double radius,
                 double floor) {
  LowerBound bound;
  bound.height = floor;
  if (!contact.touches()) return bound;
  const double ex = contact.point.x - centre.x, ey = contact.point.y - centre.y, squared = radius * radius;
  const auto sphere = [&](double x, double y) { return squared - (ex - x) * (ex - x) - (ey - y) * (ey - y); };
  // A sphere is concave: it lies above the least of its corners, also after a plane is taken off.
  const double least =
      std::min({sphere(half_x, half_y), sphere(-half_x, half_y), sphere(half_x, -half_y), sphere(-half_x, -half_y)});
  if (!(least > 0)) return bound;
  if (least >= 0.25 * squared) {  // steeper planes are more than the search in single precision can take
    const double rho = std::sqrt(sphere(0, 0));
    bound.slope_x = float(ex / rho), bound.slope_y = float(ey / rho);
  }
  const auto relative = [&](double x, double y) {
    return contact.point.z + std::sqrt(sphere(x, y)) - bound.slope_x * x - bound.slope_y * y;
  };
  const double by_sphere = std::min(
      {relative(half_x, half_y), relative(-half_x, half_y), relative(half_x, -half_y), relative(-half_x, -half_y)});
  const double by_floor = floor - std::abs(bound.slope_x) * half_x - std::abs(bound.slope_y) * half_y;
  bound.height = std::max(by_sphere, by_floor);
  return bound;
}

}  // namespace

double StretchSearch::cell() const { return DropCutterAccess::hierarchy(cutter_).cell(); }

bool StretchSearch::list(Point from, Point to, double floor, std::vector<Part>& parts) {
  const auto& hierarchy = DropCutterAccess::hierarchy(cutter_);
  const Point centre{from.x / 2 + to.x / 2, from.y / 2 + to.y / 2};
  // Half sides, with room for the rounding of places.
  const double half_x = std::abs(to.x - centre.x) + 0x1p-50 * (std::abs(from.x) + std::abs(to.x));
  const double half_y = std::abs(to.y - centre.y) + 0x1p-50 * (std::abs(from.y) + std::abs(to.y));
  const double radius = cutter_.radius();
  parts.clear();
  return hierarchy.with_tree([&](const auto& tree) {
    DropCutterAccess::Trace trace{last_place_, last_, last_triangle_};
    const DropCutter::Contact contact = hierarchy.touch(tree, centre, radius, trace);
    last_place_ = trace.place, last_ = trace.contact, last_triangle_ = trace.triangle;
    touches_ = contact.touches();
    LowerBound bound = below(contact, centre, half_x, half_y, radius, floor);
    if (bound.slope_x == 0 && bound.slope_y == 0) {
      // On its way over the rim of a wall a ball tells nothing: one of the ends may lie on the ground beside it.
      for (const Point end : {from, to}) {
        DropCutterAccess::Trace beside = trace;
        const LowerBound other =
            below(hierarchy.touch(tree, end, radius, beside), centre, half_x, half_y, radius, floor);
        if (other.height > bound.height) bound = other;
      }
    }
    const double unit = tree.inverse_unit();
    Survey survey =
        tree.survey(centre, radius, {up(half_x * unit), up(half_y * unit), float(bound.slope_x), float(bound.slope_y)});
    if (bound.height != nothing) survey.raise(bound.height);
    Shortlist shortlist;
    tree.list(survey, shortlist);
    if (shortlist.overflowed()) return false;
    for (std::size_t i = 0; i < shortlist.size(); ++i) parts.push_back(tree.part(shortlist.number(i)));
    return true;
  });
}

void StretchSearch::list_all(Point from, Point to, std::vector<Part>& parts) {
  const double margin = cutter_.radius() * (1 + 0x1p-40);
  window_.fill(cutter_.terrain(), {std::min(from.x, to.x) - margin, std::min(from.y, to.y) - margin},
               {std::max(from.x, to.x) + margin, std::max(from.y, to.y) + margin});
  parts.clear();
  for (const TerrainWindow::Face& face : window_.faces()) {
    if (!face.core) continue;
    Part part;
    for (unsigned i = 0; i < 3; ++i) {
      part.corner[i] = window_.vertices()[face.vertex[i]].at;
      part.vertex[i] = window_.vertices()[face.vertex[i]].feature;
      part.edge[i] = window_.edges()[face.edge[i]].feature;
    }
    part.face = face.feature, part.vertical = face.vertical;
    parts.push_back(part);
  }
}

}  // namespace drop
}  // namespace krepl
