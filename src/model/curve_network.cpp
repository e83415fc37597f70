#include "krepl/curve_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kernel/orientation.hpp"
#include "model/arc_circle.hpp"

namespace krepl {
namespace {

/// True if the three places are no arc but what segments join.
bool is_straight(Point start, Point middle, Point end) {
  if (middle == start || middle == end) return true;
  return !(start == end) && kernel::orientation(start, middle, end) == 0;
}

/// Largest absolute coordinate of an arc. Where it is less than half a turn, its bulge is within its chord's box grown
/// by its height.
double extent_of(Point start, Point middle, Point end) {
  const auto largest = [](Point p) { return std::max(std::abs(p.x), std::abs(p.y)); };
  const double ends = std::max({largest(start), largest(middle), largest(end)});
  if (is_straight(start, middle, end)) return ends;
  const auto circle = model::arc_circle<kernel::quad>(start, middle, end);
  const double r = double(circle.radius), x = start.x + double(circle.to_center_x),
               y = start.y + double(circle.to_center_y);
  const double ux = middle.x - start.x, uy = middle.y - start.y, vx = end.x - middle.x, vy = end.y - middle.y;
  if (!(start == end) && ux * vx + uy * vy >= 0) {
    const double half = std::hypot(end.x - start.x, end.y - start.y) / 2;
    const double height = half * half / (r + std::sqrt(std::max(0.0, (r - half) * (r + half))));
    return std::max(ends,
                    std::min(std::max(largest(start), largest(end)) + height, r + std::max(std::abs(x), std::abs(y))));
  }
  return std::max(ends, r + std::max(std::abs(x), std::abs(y)));
}

}  // namespace

void CurveNetwork::Builder::add_part(std::span<const Point> vertices, std::span<const std::uint32_t> middles, bool ring,
                                     std::int64_t feature) {
  if (vertices.empty()) return;
  const auto first = std::uint32_t(straight_.points_.size());
  for (std::size_t k = 0; k < middles.size(); ++k) {
    const bool inside = middles[k] > 0 && std::size_t{middles[k]} + 1 < vertices.size();
    if (!inside || (k > 0 && middles[k] < middles[k - 1] + 2)) {
      faulty_.push_back(feature);
      break;
    }
    const Point* p = &vertices[middles[k] - 1];
    if (is_straight(p[0], p[1], p[2])) continue;
    middle_.push_back(first + middles[k]);
    straight_.gaps_.push_back(first + middles[k] - 1);
    straight_.gaps_.push_back(first + middles[k]);
  }
  straight_.add_part(vertices, feature, ring);
}

void CurveNetwork::Builder::add_line(std::span<const Point> vertices, std::span<const std::uint32_t> middles,
                                     std::int64_t feature) {
  add_part(vertices, middles, false, feature);
}

void CurveNetwork::Builder::add_ring(std::span<const Point> vertices, std::span<const std::uint32_t> middles,
                                     std::int64_t feature) {
  add_part(vertices, middles, true, feature);
}

void CurveNetwork::Builder::add_point(Point p, std::int64_t feature) { straight_.add_point(p, feature); }

Result<CurveNetwork> CurveNetwork::Builder::build(const Context& context) && {
  if (!faulty_.empty()) {
    return Error{ErrorCode::input, "the middles of arcs are not between two other vertices each",
                 "feature " + std::to_string(faulty_.front()), "give start, middle, end for each arc"};
  }
  auto straight = std::move(straight_).build(context);
  if (!straight) return straight.error();
  CurveNetwork net;
  net.straight_ = std::make_shared<Network>(std::move(*straight));
  net.index_arcs(middle_);
  return net;
}

void CurveNetwork::index_arcs(const std::vector<std::uint32_t>& middles) {
  const Network& s = *straight_;
  middle_begin_.assign(1, 0);
  auto next = middles.begin();
  for (std::uint32_t p = 0; p < s.part_count(); ++p) {
    for (; next != middles.end() && *next < s.part_begin_[p + 1]; ++next) middle_.push_back(*next - s.part_begin_[p]);
    middle_begin_.push_back(std::uint32_t(middle_.size()));
  }
  struct Entry {
    Arc arc;
    std::uint32_t position;
  };
  std::vector<Entry> entries;
  for (const std::uint32_t m : middles) {
    Arc arc{s.chain_[m - 1], s.chain_[m], s.chain_[m + 1]};
    // Rounding relative to the origin may have put the three in line, or into one place.
    if (arc.start == arc.end && arc.start == arc.middle) continue;
    if (arc.end < arc.start) std::swap(arc.start, arc.end);
    entries.push_back({arc, m - 1});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& e, const Entry& f) {
    const auto key = [](const Entry& g) { return std::array{g.arc.start, g.arc.end, g.arc.middle, g.position}; };
    return key(e) < key(f);
  });
  extent_ = s.extent();
  is_joint_.assign(s.vertices().size(), false);
  for (const Entry& e : entries) {
    if (!arcs_.empty() && arcs_.back() == e.arc) continue;
    arcs_.push_back(e.arc);
    arc_position_.push_back(e.position);
    is_joint_[e.arc.start] = is_joint_[e.arc.end] = true;
    extent_ =
        std::max(extent_, extent_of(s.vertices()[e.arc.start], s.vertices()[e.arc.middle], s.vertices()[e.arc.end]));
  }
  for (const auto& segment : s.segments()) is_joint_[segment.a] = is_joint_[segment.b] = true;
  for (std::uint32_t p = 0; p < s.part_count(); ++p) {  // points, and lines whose vertices are all one
    auto middle = part_middles(p).begin();
    const auto chain = s.part(p);
    for (std::uint32_t i = 0; i < chain.size(); ++i) {
      if (middle != part_middles(p).end() && *middle == i)
        ++middle;
      else
        is_joint_[chain[i]] = true;
    }
  }
}

Network::Source CurveNetwork::arc_source(std::uint32_t arc) const { return straight_->source_of(arc_position_[arc]); }

}  // namespace krepl
