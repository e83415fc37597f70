#include "terrain/drop_cutter_settle.hpp"

#include <cmath>

namespace krepl::drop {
namespace {

using Kind = Terrain::FeatureKind;
using Contact = DropCutter::Contact;

double length(Point3 d) { return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z); }
Point3 minus(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double distance(Point3 a, Point3 b) { return length(minus(a, b)); }

/// a + s (b - a), from the nearer end.
Point3 between(Point3 a, Point3 b, double s) {
  if (s > 0.5) return between(b, a, 1 - s);
  return {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z)};
}

unsigned place_of(const std::array<Index, 3>& features, Index feature) {
  return features[0] == feature ? 0 : features[1] == feature ? 1 : 2;
}

template <class Search>
void settle_edge(const Search& search, const Part& part, double tolerance, Contact& contact) {
  const unsigned i = place_of(part.edge, contact.feature), next = i == 2 ? 0 : i + 1;
  const unsigned a = part.vertex[i] < part.vertex[next] ? i : next, b = a ^ i ^ next;
  const double along = touch_edge(part.corner[a], part.corner[b], search.tool).along;
  contact.point = between(part.corner[a], part.corner[b], along);
  const unsigned nearer = along > 0.5 ? b : a;
  if (distance(contact.point, part.corner[nearer]) > tolerance) return;
  contact.point = part.corner[nearer], contact.feature = part.vertex[nearer];
}

template <class Search>
void settle_face(const Search& search, const Part& part, double tolerance, Contact& contact) {
  const auto& p = part.corner;
  const FaceTouch touch = touch_face(p[0], p[1], p[2], search.tool);
  const Point3 d1 = minus(p[1], p[0]), d2 = minus(p[2], p[0]);
  contact.point = {p[0].x + touch.v * d1.x + touch.w * d2.x, p[0].y + touch.v * d1.y + touch.w * d2.y,
                   p[0].z + touch.v * d1.z + touch.w * d2.z};
  const std::array<double, 3> weight{1 - touch.v - touch.w, touch.v, touch.w};
  const double lightest = std::min({weight[0], weight[1], weight[2]});
  if (lightest * (length(d1) + length(d2)) > tolerance) return;  // no height over a side is longer than two other sides
  for (unsigned i = 0; i < 3; ++i) {
    if (distance(contact.point, p[i]) > tolerance) continue;
    contact.point = p[i], contact.feature = part.vertex[i];
    return;
  }
  const double area = length({d1.y * d2.z - d1.z * d2.y, d1.z * d2.x - d1.x * d2.z, d1.x * d2.y - d1.y * d2.x});
  for (unsigned i = 0; i < 3; ++i) {
    const unsigned j = (i + 1) % 3, k = (i + 2) % 3;
    // The distance from side i is the weight of the opposite corner times its height over the side.
    if (weight[k] * area > tolerance * distance(p[i], p[j])) continue;
    contact.feature = part.edge[i];
    return;
  }
}

}  // namespace

template <class Search>
Contact settle(const Search& search, const Part& part, double extent) {
  const double tolerance = 0x1p-46 * std::max(extent, search.tool.radius);
  Contact contact{search.height(), {}, search.feature()};
  if (search.kind() == Kind::face) settle_face(search, part, tolerance, contact);
  else if (search.kind() == Kind::edge) settle_edge(search, part, tolerance, contact);
  else contact.point = part.corner[place_of(part.vertex, contact.feature)];
  return contact;
}

template Contact settle(const Search&, const Part&, double);
template Contact settle(const ProfileSearch&, const Part&, double);

}  // namespace krepl::drop
