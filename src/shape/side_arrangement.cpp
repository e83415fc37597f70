#include "shape/side_arrangement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/odd_ones.hpp"
#include "kernel/orientation.hpp"
#include "model/noding.hpp"

namespace krepl::shape {
namespace {

using model::GridPoint;

/// Fine enough that a middle of two grid points is a double too.
class Grid {
 public:
  explicit Grid(double extent) : scale_(extent > 0 ? std::ldexp(1.0, 49 - std::ilogb(extent)) : 1) {}
  GridPoint at(Point p) const { return {std::llround(p.x * scale_), std::llround(p.y * scale_)}; }
  Point place(GridPoint g) const { return {double(g.x) / scale_, double(g.y) / scale_}; }

 private:
  double scale_;  // a power of two
};

kernel::Box box_of(const SideArrangement& a, const SideArrangement::Fragment& f) {
  kernel::Box box;
  box.add(a.snapped[f.from]);
  box.add(a.snapped[f.to]);
  return box;
}

std::vector<kernel::Box> boxes_of(const SideArrangement& a) {
  std::vector<kernel::Box> boxes;
  boxes.reserve(a.fragments.size());
  for (const auto& f : a.fragments) boxes.push_back(box_of(a, f));
  return boxes;
}

}  // namespace

void append_sides(const Network& network, Index part, std::vector<RingSide>& out) {
  const auto chain = network.part(part);
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Index a = chain[i], b = chain[(i + 1) % chain.size()];
    if (a != b) out.push_back({a, b, part, network.part_feature(part)});
  }
}

std::optional<SideArrangement> arrange(const Network& network, std::span<const RingSide> sides,
                                       const Context& context) {
  const Grid grid(network.extent());
  struct Vertex {
    GridPoint at;
    Index vertex;
  };
  std::vector<Vertex> vertices;
  for (const RingSide& s : sides)
    for (const Index v : {s.from, s.to}) vertices.push_back({grid.at(network.vertices()[v]), v});
  std::sort(vertices.begin(), vertices.end(),
            [](const Vertex& p, const Vertex& q) { return p.at != q.at ? p.at < q.at : p.vertex < q.vertex; });
  SideArrangement result;
  std::vector<GridPoint> points;
  for (const Vertex& v : vertices) {
    if (!points.empty() && points.back() == v.at) continue;
    points.push_back(v.at);
    result.original.push_back(v.vertex);
  }
  const auto number = [&](Index vertex) {
    const GridPoint at = grid.at(network.vertices()[vertex]);
    return Index(std::lower_bound(points.begin(), points.end(), at) - points.begin());
  };
  std::vector<model::GridSegment> segments;
  std::vector<Index> side_of;
  for (Index s = 0; s < sides.size(); ++s) {
    const model::GridSegment segment{number(sides[s].from), number(sides[s].to)};
    if (segment.a == segment.b) continue;
    segments.push_back(segment);
    side_of.push_back(s);
  }
  const auto noding = model::node_segments(points, segments, context);
  if (!noding) return std::nullopt;
  result.original.resize(noding->vertices.size(), none);
  for (const GridPoint g : noding->vertices) result.snapped.push_back({double(g.x), double(g.y)});
  for (std::size_t i = 0; i < noding->vertices.size(); ++i)
    result.place.push_back(result.original[i] == none ? grid.place(noding->vertices[i])
                                                      : network.vertices()[result.original[i]]);
  for (const auto& f : noding->fragments) result.fragments.push_back({f.from, f.to, side_of[f.segment]});
  return result;
}

Coinciding group_coinciding(const SideArrangement& a) {
  Coinciding result;
  result.order.resize(a.fragments.size());
  std::iota(result.order.begin(), result.order.end(), Index{0});
  const auto ends = [&](Index i) {
    const auto& f = a.fragments[i];
    return std::pair{std::min(f.from, f.to), std::max(f.from, f.to)};
  };
  std::sort(result.order.begin(), result.order.end(),
            [&](Index i, Index j) { return ends(i) != ends(j) ? ends(i) < ends(j) : i < j; });
  for (Index i = 0; i < result.order.size(); ++i)
    if (i == 0 || ends(result.order[i - 1]) != ends(result.order[i])) result.groups.push_back(i);
  result.groups.push_back(Index(result.order.size()));
  return result;
}

RayToTheLeft::RayToTheLeft(const SideArrangement& arrangement, std::span<const RingSide> sides)
    : arrangement_(arrangement), sides_(sides), tree_(boxes_of(arrangement)) {}

std::vector<std::int64_t> RayToTheLeft::holding(Index fragment) const {
  const auto& a = arrangement_;
  const auto own = std::minmax(a.fragments[fragment].from, a.fragments[fragment].to);
  const Point p = a.snapped[own.first], q = a.snapped[own.second];
  const Point middle{p.x + (q.x - p.x) / 2, p.y + (q.y - p.y) / 2};
  std::vector<std::int64_t> hits;
  tree_.visit_left_of(
      middle, [] { return -std::numeric_limits<double>::infinity(); },
      [&](std::size_t i) {
        const auto& f = a.fragments[i];
        if (std::minmax(f.from, f.to) == own) return;
        const bool up = a.snapped[f.from].y < a.snapped[f.to].y;
        const Point low = a.snapped[up ? f.from : f.to], high = a.snapped[up ? f.to : f.from];
        if (!(low.y <= middle.y && middle.y < high.y)) return;
        if (kernel::orientation(low, high, middle) < 0) hits.push_back(sides_[f.side].feature);
      });
  kernel::keep_odd_ones(hits);
  return hits;
}

}  // namespace krepl::shape
