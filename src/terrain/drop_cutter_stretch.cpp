#include "terrain/drop_cutter_stretch.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/drop_cutter_hierarchy.hpp"
#include "terrain/drop_cutter_part.hpp"

namespace krepl {

class DropCutterAccess {
 public:
  template <class Work>
  static auto with_tools(const DropCutter& cutter, const Work& work) {
    return cutter.with_tools(work);
  }
  static const auto& hierarchy(const DropCutter& cutter) { return *cutter.hierarchy_; }
  using Trace = DropCutter::Hierarchy::Trace;
};

namespace drop {

/// How high a tool rests at least over all of a stretch.
struct LowerBound {
  double slope_x = 0, slope_y = 0;
  double height = nothing;  // after the slope is taken off
  bool known = false;       // of other tools than balls: whether it is that of a triangle
};

namespace {

/// A ball about p touches p over every place within R of it, which bounds the height from below.
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

/// A tool touches one triangle over both ends of a stretch, so it does between them, as high as the chord or higher. What
/// it rests on in the middle tells the slope.
LowerBound below(const Part& part, ProfileTool tool, Point from, Point to, Point centre, double floor) {
  LowerBound bound;
  bound.height = floor;
  const auto over = [&](Point place) {
    tool.place = place;
    return touch_part(part, tool);
  };
  const PartTouch first = over(from), last = over(to);
  if (first.height == nothing || last.height == nothing) return bound;
  const PartTouch middle = over(centre);
  if (middle.height != nothing && std::max(std::abs(middle.slope.x), std::abs(middle.slope.y)) <= double(steepest) / 2)
    bound.slope_x = float(middle.slope.x), bound.slope_y = float(middle.slope.y);
  const auto rise = [&](Point p) { return bound.slope_x * (p.x - centre.x) + bound.slope_y * (p.y - centre.y); };
  const double by_floor = floor - std::max(std::abs(rise(from)), std::abs(rise(to)));
  bound.height = std::max(std::min(first.height - rise(from), last.height - rise(to)), by_floor);
  bound.known = true;
  return bound;
}

}  // namespace

double StretchSearch::cell() const { return DropCutterAccess::hierarchy(cutter_).cell(); }

/// What the tool touches over the middle, and failing that, over an end: on its way over the rim of a wall it tells nothing.
template <class Tree>
LowerBound StretchSearch::lower_bound(const Tree& tree, const Ball& ball, Point from, Point to, double half_x, double half_y,
                                      double floor) {
  const auto& hierarchy = DropCutterAccess::hierarchy(cutter_);
  DropCutterAccess::Trace trace{last_place_, last_, last_triangle_};
  const DropCutter::Contact contact = hierarchy.touch(tree, ball, trace);
  last_place_ = trace.place, last_ = trace.contact, last_triangle_ = trace.triangle;
  touches_ = contact.touches();
  LowerBound bound = below(contact, ball.place, half_x, half_y, ball.radius, floor);
  if (bound.slope_x != 0 || bound.slope_y != 0) return bound;
  for (const Point end : {from, to}) {
    DropCutterAccess::Trace beside = trace;
    const LowerBound other =
        below(hierarchy.touch(tree, ball_over(end, ball.radius), beside), ball.place, half_x, half_y, ball.radius, floor);
    if (other.height > bound.height) bound = other;
  }
  return bound;
}

template <class Tree>
LowerBound StretchSearch::lower_bound(const Tree& tree, const ProfileTool& tool, Point from, Point to, double, double,
                                      double floor) {
  const auto& hierarchy = DropCutterAccess::hierarchy(cutter_);
  DropCutterAccess::Trace trace{last_place_, last_, last_triangle_};
  const DropCutter::Contact contact = hierarchy.touch(tree, tool, trace);
  last_place_ = trace.place, last_ = trace.contact, last_triangle_ = trace.triangle;
  touches_ = contact.touches();
  LowerBound bound;
  bound.height = floor;
  if (touches_) bound = below(tree.part(trace.triangle), tool, from, to, tool.place, floor);
  if (bound.known) return bound;
  for (const Point end : {from, to}) {
    DropCutterAccess::Trace beside = trace;
    ProfileTool there = tool;
    there.place = end;
    if (!hierarchy.touch(tree, there, beside).touches()) continue;
    const LowerBound other = below(tree.part(beside.triangle), tool, from, to, tool.place, floor);
    if (other.known && (!bound.known || other.height > bound.height)) bound = other;
  }
  return bound;
}

bool StretchSearch::list(Point from, Point to, double floor, std::vector<Part>& parts) {
  return list(from, to, floor, 0, parts);
}

bool StretchSearch::list(Point from, Point to, double floor, double more, std::vector<Part>& parts) {
  const Point centre{from.x / 2 + to.x / 2, from.y / 2 + to.y / 2};
  // Half sides, with room for the rounding of places.
  const double half_x = std::abs(to.x - centre.x) + 0x1p-50 * (std::abs(from.x) + std::abs(to.x));
  const double half_y = std::abs(to.y - centre.y) + 0x1p-50 * (std::abs(from.y) + std::abs(to.y));
  parts.clear();
  base_ = {};
  return DropCutterAccess::with_tools(cutter_, [&](const auto& tree, auto tool) {
    tool.place = centre;
    const LowerBound bound = lower_bound(tree, tool, from, to, half_x, half_y, floor);
    const double unit = tree.inverse_unit();
    auto survey = tree.survey(tool, {up(half_x * unit), up(half_y * unit), float(bound.slope_x), float(bound.slope_y)});
    const double raised = bound.known ? more : 0;
    if (bound.height != nothing) survey.raise(bound.height + raised);
    if (raised > 0) base_ = {true, centre, bound.height + raised, {bound.slope_x, bound.slope_y}};
    Shortlist shortlist;
    tree.list(survey, shortlist);
    if (shortlist.overflowed()) return false;
    for (std::size_t i = 0; i < shortlist.size(); ++i) parts.push_back(tree.part(shortlist.number(i)));
    return true;
  });
}

void StretchSearch::list_rectangle(Point low, Point high, double floor, std::vector<Part>& parts) {
  const Point centre{low.x / 2 + high.x / 2, low.y / 2 + high.y / 2};
  const double half_x = high.x - centre.x + 0x1p-50 * (std::abs(low.x) + std::abs(high.x));
  const double half_y = high.y - centre.y + 0x1p-50 * (std::abs(low.y) + std::abs(high.y));
  parts.clear();
  numbers_.clear();
  DropCutterAccess::with_tools(cutter_, [&](const auto& tree, auto tool) {
    tool.place = centre;
    const double unit = tree.inverse_unit();
    auto survey = tree.survey(tool, {up(half_x * unit), up(half_y * unit), 0.f, 0.f});
    survey.raise(floor);
    tree.list(survey, numbers_);
    for (const Index number : numbers_.numbers()) parts.push_back(tree.part(number));
  });
}

bool StretchSearch::find_touched(Point place, Part& part) {
  const auto& hierarchy = DropCutterAccess::hierarchy(cutter_);
  return DropCutterAccess::with_tools(cutter_, [&](const auto& tree, auto tool) {
    tool.place = place;
    DropCutterAccess::Trace trace{last_place_, last_, last_triangle_};
    const bool touches = hierarchy.touch(tree, tool, trace).touches();
    last_place_ = trace.place, last_ = trace.contact, last_triangle_ = trace.triangle;
    if (touches) part = tree.part(trace.triangle);
    return touches;
  });
}

void StretchSearch::list_all(Point from, Point to, std::vector<Part>& parts) {
  const double margin = cutter_.radius() * (1 + 0x1p-40);
  window_.fill(cutter_.terrain(), {std::min(from.x, to.x) - margin, std::min(from.y, to.y) - margin},
               {std::max(from.x, to.x) + margin, std::max(from.y, to.y) + margin});
  parts.clear();
  base_ = {};
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
