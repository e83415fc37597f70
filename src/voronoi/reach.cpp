#include "voronoi/reach.hpp"

#include <cmath>

namespace krepl::voronoi {

void Reach::widen(Vector<double> c, Vector<double> h) {
  low_ = {std::min(low_.x, c.x - h.x), std::min(low_.y, c.y - h.y)};
  high_ = {std::max(high_.x, c.x + h.x), std::max(high_.y, c.y + h.y)};
}

void Reach::close_window() {
  window_ = {{(low_.x + high_.x) / 2, (low_.y + high_.y) / 2},
             {(high_.x - low_.x) / 2 * wider + 2 * slack_, (high_.y - low_.y) / 2 * wider + 2 * slack_}};
}

template <class Real>
void Reach::update(const SideCell<Real>& cell, const SideCell<double>& frame, Vector<double> base) {
  stretches_.clear();
  low_ = high_ = base;
  double highest = 0;
  const Vector<double> u = frame.plane({1, 0});
  for (const auto& arc : cell.arcs()) {
    const double height = double(std::max(arc.curve.height(arc.begin), arc.curve.height(arc.end))) * wider;
    const double begin = double(arc.begin), end = double(arc.end);
    stretches_.push_back({begin, end, height, {}, {}});
    highest = std::max(highest, height);
    // The largest disks at both ends and what is between them.
    const double half = (end - begin) / 2;
    widen(base + frame.plane({(begin + end) / 2, height}), {height + half * std::abs(u.x), height + half * std::abs(u.y)});
  }
  whole_ = {0, double(cell.length()), highest, {}, {}};
  close_window();
}

template <class Real>
void Reach::update(const VertexCell<Real>& cell, const VertexCell<double>&, Vector<double> base) {
  const auto unit = [](Vector<Real> u) { return Vector<double>{double(u.x), double(u.y)}; };
  stretches_.clear();
  low_ = high_ = base;
  double highest = 0;
  for (int i = 0; i < cell.chart_count(); ++i) {
    const auto& chart = cell.chart(i);
    for (const auto& arc : chart.envelope.arcs()) {
      const double height = double(std::max(arc.curve.height(arc.begin), arc.curve.height(arc.end))) * wider;
      const Stretch s{double(arc.begin), double(arc.end), height, unit(chart.direction(arc.begin)), unit(chart.direction(arc.end))};
      stretches_.push_back(s);
      highest = std::max(highest, height);
      // The disks at both ends, and how far the sector between them may bulge.
      const double bulge = height * (2 - dot(s.first, s.last));
      for (const Vector<double> u : {s.first, s.last}) widen(base + height * u, {bulge, bulge});
    }
  }
  whole_ = {0, 0, highest, stretches_.front().first, stretches_.back().last};
  close_window();
}

/// Of all points at height y and distance dx from the stretch, the lowest bisector is (dx^2 + y^2) / 2y high; over the box the
/// least is at y = dx.
bool Reach::side_meets(const Stretch& s, Vector<double> low, Vector<double> high) {
  const double dx = std::max(std::max(s.begin - high.x, low.x - s.end), 0.0);
  const double y = std::min(std::max(low.y, dx), high.y);
  return y <= 0 || dx * dx + y * y <= 2 * y * s.height;
}

bool Reach::meets(const SideCell<double>& cell, const SiteBoxes::Box& box, Vector<double> base) const {
  const Vector<double> c = cell.rotate(box.centre - base), u = cell.plane({1, 0});
  const Vector<double> half{std::abs(u.x) * box.half.x + std::abs(u.y) * box.half.y + slack_,
                            std::abs(u.y) * box.half.x + std::abs(u.x) * box.half.y + slack_};
  const Vector<double> low{c.x - half.x, std::max(c.y - half.y, 0.0)}, high = c + half;
  if (!(high.y > 0) || !side_meets(whole_, low, high)) return false;
  if (stretches_.size() == 1) return true;
  for (const Stretch& s : stretches_) {
    if (side_meets(s, low, high)) return true;
  }
  return false;
}

/// All disks touch the vertex and none is larger than the height: they lie in the two at the ends and in the sector of twice
/// that radius.
bool Reach::vertex_meets(const Stretch& s, Vector<double> c, Vector<double> h) {
  const auto highest = [&](Vector<double> d) { return dot(d, c) + std::abs(d.x) * h.x + std::abs(d.y) * h.y; };
  for (const Vector<double> u : {s.first, s.last}) {
    const double dx = std::max(std::abs(c.x - s.height * u.x) - h.x, 0.0);
    const double dy = std::max(std::abs(c.y - s.height * u.y) - h.y, 0.0);
    if (dx * dx + dy * dy <= s.height * s.height * wider) return true;
  }
  const double dx = std::max(std::abs(c.x) - h.x, 0.0), dy = std::max(std::abs(c.y) - h.y, 0.0);
  if (dx * dx + dy * dy > 4 * s.height * s.height) return false;
  return highest({-s.first.y, s.first.x}) >= 0 && highest({s.last.y, -s.last.x}) >= 0;
}

bool Reach::meets(const VertexCell<double>& cell, const SiteBoxes::Box& box, Vector<double> base) const {
  const Vector<double> c = box.centre - base, half{box.half.x + slack_, box.half.y + slack_};
  if (!cell.is_isolated() && !vertex_meets(whole_, c, half)) return false;
  if (stretches_.size() == 1) return true;
  for (const Stretch& s : stretches_) {
    if (vertex_meets(s, c, half)) return true;
  }
  return false;
}

template void Reach::update(const SideCell<double>&, const SideCell<double>&, Vector<double>);
template void Reach::update(const SideCell<quad>&, const SideCell<double>&, Vector<double>);
template void Reach::update(const VertexCell<double>&, const VertexCell<double>&, Vector<double>);
template void Reach::update(const VertexCell<quad>&, const VertexCell<double>&, Vector<double>);

}  // namespace krepl::voronoi
