#include "terrain/drop_cutter_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"

namespace krepl::drop {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Boxes of more than 8^6 triangles have no plane: it would lie far above most of them.
constexpr std::size_t levels_with_plane = 5;

/// Slope of the plane that fits points best, from sums over their coordinates relative to some point near them.
struct Fit {
  double n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
  void add(double dx, double dy, double dz) {
    n += 1, x += dx, y += dy, z += dz;
    xx += dx * dx, xy += dx * dy, yy += dy * dy, xz += dx * dz, yz += dy * dz;
  }
  /// Zero where there is none that a bound can use.
  std::pair<float, float> slope() const {
    const double a = xx - x * x / n, b = xy - x * y / n, c = yy - y * y / n, p = xz - x * z / n, q = yz - y * z / n;
    const double determinant = a * c - b * b;
    if (!(determinant > 0)) return {0.f, 0.f};
    const float sx = float((p * c - q * b) / determinant), sy = float((q * a - p * b) / determinant);
    if (!(std::abs(sx) <= steepest && std::abs(sy) <= steepest)) return {0.f, 0.f};
    return {sx, sy};
  }
};

}  // namespace

MeshTree::MeshTree(const Terrain& terrain, const Scale& scale, const Context& context)
    : t_(terrain), scale_(scale), first_edge_(Index(t_.vertices().size())),
      first_triangle_(Index(t_.vertices().size() + t_.edges().size())) {
  const double width = terrain.highest().x - terrain.lowest().x, height = terrain.highest().y - terrain.lowest().y;
  cell_ = std::sqrt(width / double(t_.triangles().size()) * height * 2);
  build_leaves(context);
  std::size_t count = leaves_.size();
  while (count > 1 && !context.cancelled()) {
    count = (count + arity - 1) / arity;
    levels_.emplace_back(count);
    build_level(levels_.size() - 1, context);
  }
}

std::array<Point3, 3> MeshTree::corners(std::size_t triangle) const {
  const auto& v = t_.triangles()[triangle].vertex;
  return {t_.vertices()[v[0]], t_.vertices()[v[1]], t_.vertices()[v[2]]};
}

void MeshTree::build_level(std::size_t level, const Context& context) {
  std::vector<Node>& nodes = levels_[level];
  std::size_t size = arity;  // triangles of a child
  for (std::size_t k = 0; k < level; ++k) size *= arity;
  const std::size_t portion = std::max<std::size_t>(1, 4096 / size), count = t_.triangles().size();
  kernel::parallel_blocks(context, nodes.size(), portion, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (std::size_t k = 0; k < arity; ++k) {
        const std::size_t first = std::min(count, (n * arity + k) * size);
        bound_box(level, first, std::min(count, first + size), nodes[n], k);
      }
  });
}

/// The rectangle of triangles first .. last - 1, their highest point, and a plane above their corners.
void MeshTree::bound_box(std::size_t level, std::size_t first, std::size_t last, Node& node, std::size_t k) const {
  double x0 = infinity, y0 = infinity, x1 = -infinity, y1 = -infinity, top = -infinity;
  Fit fit;
  if (first < last) {
    const Point3 near = corners(first)[0];
    for (std::size_t t = first; t < last; ++t)
      for (const Point3& p : corners(t)) {
        x0 = std::min(x0, p.x), y0 = std::min(y0, p.y), x1 = std::max(x1, p.x), y1 = std::max(y1, p.y);
        top = std::max(top, p.z);
        fit.add(p.x - near.x, p.y - near.y, p.z - near.z);
      }
  }
  const double unit = scale_.inverse_unit;
  node.x0[k] = down(x0 * unit), node.y0[k] = down(y0 * unit), node.x1[k] = up(x1 * unit), node.y1[k] = up(y1 * unit);
  node.top[k] = node.level[k] = up(top * unit);
  node.slope_x[k] = node.slope_y[k] = 0;
  if (first == last || level > levels_with_plane) return;
  const auto [sx, sy] = fit.slope();
  if (sx == 0 && sy == 0) return;
  double at_middle = -infinity;
  const double mx = (double(node.x0[k]) + node.x1[k]) / 2, my = (double(node.y0[k]) + node.y1[k]) / 2;
  for (std::size_t t = first; t < last; ++t)
    for (const Point3& p : corners(t))
      at_middle = std::max(at_middle, p.z * unit - sx * (p.x * unit - mx) - sy * (p.y * unit - my));
  const double width = double(node.x1[k]) - node.x0[k], height = double(node.y1[k]) - node.y0[k];
  node.level[k] = up(at_middle + bound_rounding(width, height, sx, sy));
  node.slope_x[k] = sx, node.slope_y[k] = sy;
}

void MeshTree::build_leaves(const Context& context) {
  const std::size_t count = t_.triangles().size();
  leaves_.resize((count + arity - 1) / arity);
  kernel::parallel_blocks(context, leaves_.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      Leaf& leaf = leaves_[n];
      const std::size_t begin = n * arity, end = std::min(begin + arity, count);
      leaf.origin = {corners(begin)[0].x, corners(begin)[0].y};
      double width = 0;
      for (std::size_t t = begin; t < end; ++t)
        for (const Point3& p : corners(t))
          width = std::max({width, std::abs(p.x - leaf.origin.x), std::abs(p.y - leaf.origin.y)});
      for (std::size_t k = 0; k < arity; ++k) {
        if (begin + k < end) put(corners(begin + k), slack_per_move * 0x1p-22 * width, leaf, k);
        else put_nothing(leaf, k);
      }
    }
  });
}

/// `slack`: what the rounding of places within the leaf may cost in height.
void MeshTree::put(const std::array<Point3, 3>& p, double slack, Leaf& leaf, std::size_t k) const {
  const double unit = scale_.inverse_unit;
  for (std::size_t i = 0; i < 3; ++i) {
    leaf.x[i][k] = float((p[i].x - leaf.origin.x) * unit), leaf.y[i][k] = float((p[i].y - leaf.origin.y) * unit);
  }
  leaf.top[k] = leaf.z[k] = float(std::max({p[0].z, p[1].z, p[2].z}) * unit);
  leaf.slope_x[k] = leaf.slope_y[k] = 0;
  const double ux = p[1].x - p[0].x, uy = p[1].y - p[0].y, uz = p[1].z - p[0].z;
  const double vx = p[2].x - p[0].x, vy = p[2].y - p[0].y, vz = p[2].z - p[0].z;
  const double area = ux * vy - uy * vx;
  const float slope_x = float((uz * vy - uy * vz) / area), slope_y = float((ux * vz - uz * vx) / area);
  if (!(std::abs(slope_x) <= steepest && std::abs(slope_y) <= steepest)) return;
  // Rounding may tilt a sliver: a plane of this slope above all corners.
  const auto at_first = [&](const Point3& q) { return q.z - slope_x * (q.x - p[0].x) - slope_y * (q.y - p[0].y); };
  leaf.z[k] = float((std::max({p[0].z, at_first(p[1]), at_first(p[2])}) + slack) * unit);
  leaf.slope_x[k] = slope_x, leaf.slope_y[k] = slope_y;
}

/// Out of every ball's reach.
void MeshTree::put_nothing(Leaf& leaf, std::size_t k) {
  for (std::size_t i = 0; i < 3; ++i) leaf.x[i][k] = leaf.y[i][k] = float_infinity;
  leaf.top[k] = leaf.z[k] = -float_infinity;
  leaf.slope_x[k] = leaf.slope_y[k] = 0;
}

/// Coordinates of boxes are those of the terrain, coordinates of triangles relative to the place; put() allows for their size.
Moved MeshTree::moved(Point place, double radius) const {
  const double farthest = std::abs(place.x) + std::abs(place.y) + 2 * scale_.extent;
  return {0x1p-23 * farthest, 0x1p-22 * std::min(radius, farthest)};
}

/// Bounds of the eight children of a node; returns which are worth a look, as bits.
template <class Query>
unsigned MeshTree::bound_children(const Query& query, const Node& node, float* bounds) const {
  const Float4 x = float(query.tool.place.x * scale_.inverse_unit), y = float(query.tool.place.y * scale_.inverse_unit);
  unsigned worth = 0;
  for (std::size_t k = 0; k < arity; k += 4) {
    const auto load = [&](const float* f) { return Float4::load(f + k); };
    const FourBlocks p{load(node.top),    load(node.level),  load(node.slope_x), load(node.slope_y),
                       load(node.x0) - x, load(node.x1) - x, load(node.y0) - y,  load(node.y1) - y};
    worth |= query.worth(p, bounds + k) << k;
  }
  return worth;
}

FourTriangles MeshTree::triangles(Point place, const Leaf& leaf, std::size_t k) const {
  const Float4 x = float((leaf.origin.x - place.x) * scale_.inverse_unit);
  const Float4 y = float((leaf.origin.y - place.y) * scale_.inverse_unit);
  const auto load = [&](const float* f) { return Float4::load(f + k); };
  return {load(leaf.top),      load(leaf.z),        load(leaf.slope_x),  load(leaf.slope_y),  load(leaf.x[0]) + x,
          load(leaf.y[0]) + y, load(leaf.x[1]) + x, load(leaf.y[1]) + y, load(leaf.x[2]) + x, load(leaf.y[2]) + y};
}

template <class Search>
void MeshTree::visit(Search& search, std::size_t level, std::size_t index) const {
  float bounds[arity];
  unsigned worth = 0;
  if (level > 0) worth = bound_children(search, levels_[level - 1][index], bounds);
  else
    for (unsigned k = 0; k < arity; k += 4)
      worth |= search.worth(triangles(search.tool.place, leaves_[index], k), bounds + k) << k;
  Candidates<arity> found;
  for (; worth != 0; worth &= worth - 1) {
    const unsigned child = unsigned(__builtin_ctz(worth));
    found.add(bounds[child], Index(index * arity + child));
  }
  for (const auto& entry : found) {
    if (entry.bound < (level == 0 ? search.threshold_of_triangles() : search.threshold_of_blocks())) return;
    if (level == 0) touch(search, entry.column);
    else visit(search, level - 1, entry.column);
  }
}

template void MeshTree::visit(Search&, std::size_t, std::size_t) const;
template void MeshTree::visit(ProfileSearch&, std::size_t, std::size_t) const;

template <class Survey, class List>
void MeshTree::list(const Survey& survey, List& shortlist) const {
  list_node(survey, levels_.size(), 0, shortlist);
  shortlist.close();
}

template <class Survey, class List>
void MeshTree::list_node(const Survey& survey, std::size_t level, std::size_t index, List& shortlist) const {
  float bounds[arity];
  if (level == 0) {
    for (unsigned k = 0; k < arity; k += 4) {
      const FourTriangles four = triangles(survey.tool.place, leaves_[index], k);
      const unsigned worth = survey.worth(four, bounds);
      shortlist.add(four, worth, bounds, [&](unsigned lane) { return Index(index * arity + k + lane); });
    }
    return;
  }
  for (unsigned worth = bound_children(survey, levels_[level - 1][index], bounds); worth != 0; worth &= worth - 1) {
    if (shortlist.overflowed()) return;
    list_node(survey, level - 1, index * arity + unsigned(__builtin_ctz(worth)), shortlist);
  }
}

template void MeshTree::list(const Survey&, Shortlist&) const;
template void MeshTree::list(const ProfileSurvey&, Shortlist&) const;
template void MeshTree::list(const Survey&, LongList&) const;
template void MeshTree::list(const ProfileSurvey&, LongList&) const;

Part MeshTree::part(Index t) const {
  const auto& triangle = t_.triangles()[t];
  Part p{corners(t), triangle.vertex, triangle.edge, first_triangle_ + t, triangle.vertical};
  for (Index& e : p.edge) e += first_edge_;
  return p;
}

}  // namespace krepl::drop
