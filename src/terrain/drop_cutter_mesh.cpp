#include "terrain/drop_cutter_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"

namespace krepl::drop {
namespace {

using Kind = Terrain::FeatureKind;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Boxes of more than 8^5 triangles have no plane: it would lie far above most of them.
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
  std::size_t count = t_.triangles().size();
  do {
    count = (count + arity - 1) / arity;
    levels_.emplace_back(count);
    build_level(levels_.size() - 1, context);
  } while (count > 1 && !context.cancelled());
  choose_owners();
}

std::array<Point3, 3> MeshTree::corners(std::size_t triangle) const {
  const auto& v = t_.triangles()[triangle].vertex;
  return {t_.vertices()[v[0]], t_.vertices()[v[1]], t_.vertices()[v[2]]};
}

void MeshTree::build_level(std::size_t level, const Context& context) {
  std::vector<Node>& nodes = levels_[level];
  std::size_t size = 1;  // triangles of a child
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

/// Each edge and vertex is looked at with the first of its triangles only.
void MeshTree::choose_owners() {
  std::vector<bool> edge_has(t_.edges().size()), vertex_has(t_.vertices().size());
  owned_.resize(t_.triangles().size());
  for (std::size_t t = 0; t < owned_.size(); ++t) {
    const auto& triangle = t_.triangles()[t];
    for (unsigned i = 0; i < 3; ++i) {
      if (!edge_has[triangle.edge[i]]) owned_[t] |= std::uint8_t(1u << i), edge_has[triangle.edge[i]] = true;
      if (!vertex_has[triangle.vertex[i]]) owned_[t] |= std::uint8_t(8u << i), vertex_has[triangle.vertex[i]] = true;
    }
  }
}

Search MeshTree::search(Point place, double radius) const {
  return Search(scale_, place, radius, 0x1p-21 * (std::abs(place.x) + std::abs(place.y) + 2 * scale_.extent));
}

void MeshTree::run(Search& search, Index first) const {
  if (first != Terrain::none) {
    touch_triangle(search, first);
    search.skip = first;
  }
  visit(search, levels_.size() - 1, 0);
}

void MeshTree::visit(Search& search, std::size_t level, std::size_t index) const {
  const Node& node = levels_[level][index];
  const float x = float(search.ball.place.x * scale_.inverse_unit), y = float(search.ball.place.y * scale_.inverse_unit);
  const float blur = search.blur;
  float bounds[arity];
  unsigned worth = 0;
  for (std::size_t k = 0; k < arity; k += 4) {
    FourParts p;
    p.x0 = Float4::load(node.x0 + k) - Float4(x + blur), p.x1 = Float4::load(node.x1 + k) - Float4(x - blur);
    p.y0 = Float4::load(node.y0 + k) - Float4(y + blur), p.y1 = Float4::load(node.y1 + k) - Float4(y - blur);
    p.top = Float4::load(node.top + k), p.level = Float4::load(node.level + k);
    p.slope_x = Float4::load(node.slope_x + k), p.slope_y = Float4::load(node.slope_y + k);
    const Float4 b = bound(search.bounds, p);
    b.store(bounds + k);
    worth |= bits(b >= Float4(search.threshold())) << k;
  }
  Candidates<arity> found;
  for (; worth != 0; worth &= worth - 1) {
    const unsigned child = unsigned(__builtin_ctz(worth));
    found.add(bounds[child], Index(index * arity + child));
  }
  for (const auto& entry : found) {
    if (entry.bound < search.threshold()) return;
    if (level == 0) touch_triangle(search, entry.column);
    else visit(search, level - 1, entry.column);
  }
}

void MeshTree::touch_triangle(Search& search, Index t) const {
  if (t == search.skip) return;
  const auto& triangle = t_.triangles()[t];
  const std::array<Point3, 3> p = corners(t);
  const auto offer = [&](double height, Index feature, Kind kind) {
    if (search.wants(height, feature, kind)) search.take(height, feature, kind, t);
  };
  FaceTouch face;  // of a vertical triangle: all sides are worth a look
  if (!triangle.vertical) {
    face = touch_face(p[0], p[1], p[2], search.ball);
    offer(face.height, feature_of_triangle(t), Kind::face);
  }
  const unsigned sides = face.beyond & owned_[t];
  for (unsigned i = 0; i < 3; ++i) {
    if ((sides & (1u << i)) == 0) continue;
    // From the lower vertex number to the higher, as Terrain::corners() has it.
    const unsigned j = (i + 1) % 3;
    const bool ascending = triangle.vertex[i] < triangle.vertex[j];
    offer(touch_edge(p[ascending ? i : j], p[ascending ? j : i], search.ball).height, feature_of_edge(triangle.edge[i]), Kind::edge);
  }
  if (face.beyond == 0) return;
  for (unsigned i = 0; i < 3; ++i) {
    if (owned_[t] & (8u << i)) offer(touch_vertex(p[i], search.ball).height, feature_of_vertex(triangle.vertex[i]), Kind::vertex);
  }
}

}  // namespace krepl::drop
