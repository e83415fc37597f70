#include "mill/ball_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "mill/part_domain.hpp"

namespace krepl::mill {

using drop::Part;

bool BallBodies::list(const Line& line, double from, double to, double floor, bool all) {
  line_ = line;
  if (search_.list(line.at(from), line.at(to), floor, parts_)) return true;
  if (!all) return false;
  search_.list_all(line.at(from), line.at(to), parts_);
  return true;
}

Interval BallBodies::domain(std::size_t body) const { return domain_of(parts_[body], radius_, line_); }

/// The same steps as in the drop cutter's search, for one triangle.
Touch BallBodies::at(std::size_t body, double t) const {
  const Part& p = parts_[body];
  const Point place = line_.at(t);
  const drop::Ball ball = drop::ball_over(place, radius_);
  const Point d = line_.direction;
  drop::FaceTouch face;
  if (!p.vertical) face = drop::touch_face(p.corner[0], p.corner[1], p.corner[2], ball);
  Point3 touched{}, edge_run{};
  double height = drop::nothing;
  if (face.beyond == 0) {
    height = face.height;
    const Point3 a = p.corner[0], b = p.corner[1], c = p.corner[2];
    touched = {a.x + face.v * (b.x - a.x) + face.w * (c.x - a.x), a.y + face.v * (b.y - a.y) + face.w * (c.y - a.y),
               a.z + face.v * (b.z - a.z) + face.w * (c.z - a.z)};
  } else {
    unsigned corners = 0;
    for (unsigned i = 0; i < 3; ++i) {
      if ((face.beyond & (1u << i)) == 0) continue;
      const unsigned next = i == 2 ? 0 : i + 1;
      const unsigned a = p.vertex[i] < p.vertex[next] ? i : next, b = a ^ i ^ next;
      const drop::EdgeTouch edge = drop::touch_edge(p.corner[a], p.corner[b], ball);
      if (edge.height > height) {
        height = edge.height;
        const Point3 q = p.corner[a], r = p.corner[b];
        edge_run = {r.x - q.x, r.y - q.y, r.z - q.z};
        touched = {q.x + edge.along * edge_run.x, q.y + edge.along * edge_run.y, q.z + edge.along * edge_run.z};
      }
      if (edge.ends & 1) corners |= 1u << a;
      if (edge.ends & 2) corners |= 1u << b;
    }
    for (unsigned i = 0; i < 3; ++i) {
      if ((corners & (1u << i)) == 0) continue;
      const double h = drop::touch_vertex(p.corner[i], ball).height;
      if (h > height) height = h, touched = p.corner[i], edge_run = {};
    }
  }
  // The normal points from the touched point to the centre, and does not tell the slope where it is level: on the way along a wall, just
  // out of reach but for rounding.
  const double across = (place.x - touched.x) * d.x + (place.y - touched.y) * d.y, up = height - touched.z;
  if (up > 0) return {height, -across / up};
  const double square = edge_run.x * edge_run.x + edge_run.y * edge_run.y;
  return {height, square > 0 ? edge_run.z * (edge_run.x * d.x + edge_run.y * d.y) / square : 0};
}

double BallBodies::top_of_narrow(std::size_t body, double width) const {
  const Part& p = parts_[body];
  // The distance in the plane changes no faster than the place: it is R at both ends, so at least R - width / 2
  // between.
  const double reach = std::max(0.0, radius_ - width / 2);
  return std::max({p.corner[0].z, p.corner[1].z, p.corner[2].z}) + std::sqrt(squared_ - reach * reach);
}

double BallBodies::stretch() const { return 0.5 * std::sqrt(radius_ * std::min(search_.cell(), 4 * radius_)); }

}  // namespace krepl::mill
