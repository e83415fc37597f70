#include "voronoi/reach.hpp"

#include <cmath>
#include <limits>

namespace krepl::voronoi {

void Reach::start(Vector<double> base) {
  base_ = base;
  open_ = of_side_ = false;
  below_ = slack_;
  disks_.clear();
  base_strips_.clear();
  strips_.clear();
  sectors_.clear();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  low_ = {infinity, infinity}, high_ = {-infinity, -infinity};
}

void Reach::widen(Vector<double> c, double half) {
  low_ = {std::min(low_.x, c.x - half), std::min(low_.y, c.y - half)};
  high_ = {std::max(high_.x, c.x + half), std::max(high_.y, c.y + half)};
}

void Reach::widen(Vector<double> p, Vector<double> q, Vector<double> up) {
  for (const Vector<double> corner : {p, q, p + up, q + up}) widen(corner, slack_);
}

void Reach::add_disk(Vector<double> centre, double radius) {
  const double r = radius + (wider - 1) * std::min(radius, most_) + slack_;
  disks_.push_back({centre, r * r});
  below_ = std::max(below_, r - radius);
  widen(centre, r);
}

void Reach::add_strip(Vector<double> p, Vector<double> q, Vector<double> n, double height) {
  const Vector<double> d = q - p;
  const double along = n.x * d.y - n.y * d.x;
  strips_.push_back({p, n, std::min(along, 0.0) - slack_, std::max(along, 0.0) + slack_, height * wider + slack_});
  widen(p, q, height * n);
}

void Reach::close() {
  if (is_empty()) low_ = high_ = {0, 0};
  window_ = SiteBoxes::SearchWindow({{base_.x + (low_.x + high_.x) / 2, base_.y + (low_.y + high_.y) / 2},
                               {(high_.x - low_.x) / 2 * wider + slack_, (high_.y - low_.y) / 2 * wider + slack_}});
}

template <class Real>
void Reach::update(const SideCell<Real>& cell, const SideCell<double>& frame, Vector<double> base,
                   const KnownEmpty& known) {
  start(base);
  const Vector<double> outwards = frame.plane({0, 1});
  of_side_ = true;
  outwards_ = outwards;
  double before = 0;
  Vector<double> start_touch{};  // on the base
  for (std::size_t i = 0; i < cell.arcs().size(); ++i) {
    const auto& arc = cell.arcs()[i];
    const double begin = double(arc.begin), end = double(arc.end);
    const double first = double(arc.curve.height(arc.begin)), last = double(arc.curve.height(arc.end));
    const double height = std::max(first, last), joint = std::max(before, first);
    open_ = open_ || arc.curve.label == none;
    if (i == 0) start_touch = frame.plane({begin, 0});
    const Vector<double> end_touch = frame.plane({end, 0});
    if (!known.joints[i]) add_disk(start_touch + joint * outwards, joint);
    if (!known.arcs[i]) {
      const double high = arc.curve.is_line ? height : std::min(height, double(arc.curve.at.y));
      base_strips_.push_back({begin - slack_, end + slack_, high * wider + slack_});
      widen(start_touch, end_touch, high * outwards);
      if (arc.curve.label != none && arc.curve.is_line) {
        const Vector<double> n = frame.plane({double(arc.curve.normal.x), double(arc.curve.normal.y)});
        add_strip(start_touch + first * (outwards - n), end_touch + last * (outwards - n), n, height);
      }
    }
    before = last;
    start_touch = end_touch;
  }
  if (!known.joints.back()) add_disk(start_touch + before * outwards, before);
  close();
}

template <class Real>
void Reach::update(const VertexCell<Real>& cell, const VertexCell<double>& frame, Vector<double> base,
                   const KnownEmpty& known) {
  start(base);
  const auto rounded = [](Vector<Real> u) { return Vector<double>{double(u.x), double(u.y)}; };
  double before = 0;
  Vector<double> u{};
  std::size_t number = 0;
  for (int i = 0; i < cell.chart_count(); ++i) {
    const auto& chart = cell.chart(i);
    const Vector<double> middle = frame.chart(i).middle;
    for (const auto& arc : chart.envelope.arcs()) {
      const double first = double(arc.curve.height(arc.begin)), last = double(arc.curve.height(arc.end));
      const Vector<double> b = rounded(chart.direction(arc.begin)), e = rounded(chart.direction(arc.end));
      const double joint = std::max(before, first);
      if (!known.joints[number]) add_disk(joint * b, joint);
      if (arc.curve.label == none) {
        sectors_.push_back({b, e});
        open_ = true;
        widen({0, 0}, 2 * first);
      } else if (arc.curve.is_line && !known.arcs[number]) {
        const Vector<double> v{double(arc.curve.normal.x), double(arc.curve.normal.y)};
        const Vector<double> n{v.x * middle.x - v.y * middle.y, v.x * middle.y + v.y * middle.x};
        add_strip(first * (b - n), last * (e - n), n, std::min(double(arc.curve.distance), std::max(first, last)));
      }
      before = last;
      u = e;
      ++number;
    }
  }
  if (!known.joints.back()) add_disk(before * u, before);
  close();
}

template void Reach::update(const SideCell<double>&, const SideCell<double>&, Vector<double>, const KnownEmpty&);
template void Reach::update(const SideCell<wide>&, const SideCell<double>&, Vector<double>, const KnownEmpty&);
template void Reach::update(const VertexCell<wide>&, const VertexCell<double>&, Vector<double>, const KnownEmpty&);
template void Reach::update(const SideCell<Twofold>&, const SideCell<double>&, Vector<double>, const KnownEmpty&);
template void Reach::update(const VertexCell<Twofold>&, const VertexCell<double>&, Vector<double>, const KnownEmpty&);
template void Reach::update(const SideCell<quad>&, const SideCell<double>&, Vector<double>, const KnownEmpty&);
template void Reach::update(const VertexCell<double>&, const VertexCell<double>&, Vector<double>, const KnownEmpty&);
template void Reach::update(const VertexCell<quad>&, const VertexCell<double>&, Vector<double>, const KnownEmpty&);

}  // namespace krepl::voronoi
