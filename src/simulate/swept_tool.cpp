#include "simulate/swept_tool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl::simulate {
namespace {

/// A ball is the bull nose that is nothing but corner; heights are then those of its tip.
Cutter with_tip(const Cutter& cutter) {
  return cutter.kind() == Cutter::Kind::ball ? *Cutter::bull_nose(cutter.diameter(), cutter.radius()) : cutter;
}

}  // namespace

SweptTool::SweptTool(const Cutter& cutter) : tool_(with_tip(cutter)) {}

double SweptTool::lowest(const Piece& piece, Point place) const {
  drop::ProfileTool tool = tool_;
  tool.place = place;
  const Point3 a{piece.from.x, piece.from.y, -piece.from.z}, b{piece.to.x, piece.to.y, -piece.to.z};
  const drop::EdgeTouch touch = drop::touch_edge(a, b, tool);
  double height = touch.height;
  if (touch.ends & 1) height = std::max(height, drop::touch_vertex(a, tool).height);
  if (touch.ends & 2) height = std::max(height, drop::touch_vertex(b, tool).height);
  return -height;
}

/// The distance to the boundary of a convex body is the least of those to its tangent planes: below, at the shank,
/// along the flank, and at the corner the one in the point's direction.
double SweptTool::depth_at(Point3 tip, Point3 point) const {
  const drop::Profile<double>& p = tool_.profile;
  const double r = std::hypot(point.x - tip.x, point.y - tip.y), z = point.z - tip.z;
  double depth = std::min(z, tool_.radius - r);
  if (p.flank) depth = std::min(depth, (z - p.end_height - p.slope * (r - p.end)) * p.cosine);
  const double out = r - p.flat, up = z - p.corner;
  if (p.corner > 0 && out > 0 && up < 0 && out * p.cosine <= -up * p.sine)
    depth = std::min(depth, p.corner - std::hypot(out, up));
  return depth;
}

double SweptTool::depth(const Piece& piece, Point3 point) const {
  const auto at = [&](double t) {
    const Point3 a = piece.from, b = piece.to;
    return depth_at({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)}, point);
  };
  constexpr double golden = 0.61803398874989485;
  double low = 0, high = 1, a = 1 - golden, b = golden, at_a = at(a), at_b = at(b);
  double best = std::max({at(0), at(1), at_a, at_b});
  for (int step = 0; step < 70; ++step) {
    if (at_a < at_b) {
      low = a, a = b, at_a = at_b, b = low + golden * (high - low), at_b = at(b);
      best = std::max(best, at_b);
    } else {
      high = b, b = a, at_b = at_a, a = high - golden * (high - low), at_a = at(a);
      best = std::max(best, at_a);
    }
  }
  return best;
}

}  // namespace krepl::simulate
