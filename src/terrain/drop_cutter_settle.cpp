#include "terrain/drop_cutter_settle.hpp"

#include <cmath>

namespace krepl::drop {
namespace {

using Kind = Terrain::FeatureKind;
using Contact = DropCutter::Contact;

double length(Point3 d) { return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z); }
double distance(Point3 a, Point3 b) { return length({a.x - b.x, a.y - b.y, a.z - b.z}); }

/// a + s (b - a), from the nearer end.
Point3 between(Point3 a, Point3 b, double s) {
  if (s > 0.5) return between(b, a, 1 - s);
  return {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z)};
}

}  // namespace

Contact Settle::contact(const Search& search) const {
  const double tolerance = 0x1p-46 * std::max(extent_, search.ball.radius);
  Contact contact{search.height(), {}, search.feature()};
  if (search.kind() == Kind::face) settle_face(search, tolerance, contact);
  else if (search.kind() == Kind::edge) settle_edge(search, tolerance, contact);
  else contact.point = terrain_.corners(contact.feature).point[0];
  return contact;
}

void Settle::settle_edge(const Search& search, double tolerance, Contact& contact) const {
  const auto p = terrain_.corners(contact.feature).point;
  const double along = touch_edge(p[0], p[1], search.ball).along;
  contact.point = between(p[0], p[1], along);
  const bool far = along > 0.5;
  if (distance(contact.point, p[far]) > tolerance) return;
  contact.point = p[far];
  contact.feature = ends_of_edge(contact.feature)[far];
}

void Settle::settle_face(const Search& search, double tolerance, Contact& contact) const {
  const auto p = terrain_.corners(contact.feature).point;
  const FaceTouch touch = touch_face(p[0], p[1], p[2], search.ball);
  const double u = 1 - touch.v - touch.w;
  const std::array<double, 3> weight{u, touch.v, touch.w};
  contact.point = {p[0].x + touch.v * (p[1].x - p[0].x) + touch.w * (p[2].x - p[0].x),
                   p[0].y + touch.v * (p[1].y - p[0].y) + touch.w * (p[2].y - p[0].y),
                   p[0].z + touch.v * (p[1].z - p[0].z) + touch.w * (p[2].z - p[0].z)};
  const double lightest = std::min({weight[0], weight[1], weight[2]});
  const double longer = distance(p[0], p[1]) + distance(p[1], p[2]);
  if (lightest * longer > tolerance) return;  // no height over a side is longer than two other sides
  const Sides sides = sides_of_face(contact.feature);
  for (std::size_t i = 0; i < 3; ++i) {
    if (distance(contact.point, p[i]) > tolerance) continue;
    contact.point = p[i], contact.feature = sides.vertex[i];
    return;
  }
  const Point3 d1{p[1].x - p[0].x, p[1].y - p[0].y, p[1].z - p[0].z}, d2{p[2].x - p[0].x, p[2].y - p[0].y, p[2].z - p[0].z};
  const double area = length({d1.y * d2.z - d1.z * d2.y, d1.z * d2.x - d1.x * d2.z, d1.x * d2.y - d1.y * d2.x});
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    // The distance from side i is the weight of the opposite corner times its height over the side.
    if (weight[k] * area > tolerance * distance(p[i], p[j])) continue;
    contact.feature = sides.edge[i];
    return;
  }
}

/// See terrain_grid.cpp for the numbers of a grid.
Settle::Sides Settle::sides_of_face(Index face) const {
  if (terrain_.is_grid()) {
    const Index columns = Index(terrain_.grid().columns), s = face / 6, east = s + 1, north = s + columns, far = north + 1;
    const bool upper = face % 6 == 5, falling = t_.cell(s % columns, s / columns).falling;
    const auto vertex = [](Index sample) { return 6 * sample; };
    const Index diagonal = 6 * s + 3;
    if (falling && upper) return {{vertex(east), vertex(far), vertex(north)}, {6 * east + 2, 6 * north + 1, diagonal}};
    if (falling) return {{vertex(s), vertex(east), vertex(north)}, {6 * s + 1, diagonal, 6 * s + 2}};
    if (upper) return {{vertex(s), vertex(far), vertex(north)}, {diagonal, 6 * north + 1, 6 * s + 2}};
    return {{vertex(s), vertex(east), vertex(far)}, {6 * s + 1, 6 * east + 2, diagonal}};
  }
  const Index first_edge = Index(t_.vertices().size()), first_triangle = first_edge + Index(t_.edges().size());
  const auto& triangle = t_.triangles()[face - first_triangle];
  Sides sides{triangle.vertex, triangle.edge};
  for (Index& e : sides.edge) e += first_edge;
  return sides;
}

std::array<Index, 2> Settle::ends_of_edge(Index edge) const {
  if (terrain_.is_grid()) {
    const Index columns = Index(terrain_.grid().columns), s = edge / 6, k = edge % 6;
    if (k == 1) return {6 * s, 6 * (s + 1)};
    if (k == 2) return {6 * s, 6 * (s + columns)};
    if (t_.cell(s % columns, s / columns).falling) return {6 * (s + 1), 6 * (s + columns)};
    return {6 * s, 6 * (s + columns + 1)};
  }
  const auto& e = t_.edges()[edge - t_.vertices().size()];
  return {e.a, e.b};
}

}  // namespace krepl::drop
