#include "voronoi/faces.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::voronoi {
namespace {

constexpr Index neighbours = 8;  // along the Hilbert curve, on each side: where the search starts

Point sum(Point base, Vector<double> offset) { return {base.x + offset.x, base.y + offset.y}; }

template <class Real>
Vector<double> rounded(Vector<Real> v) {
  return {double(v.x), double(v.y)};
}

/// The least distance along an arc of a side's border: a parabola has its lowest point under the other site.
template <class Real>
Real lowest(const SideCurve<Real>& curve, Real begin, Real end) {
  if (!curve.is_line && begin < curve.at.x && curve.at.x < end) return curve.at.y / 2;
  return std::min(curve.height(begin), curve.height(end));
}
template <class Real>
Real lowest(const VertexCurve<Real>& curve, Real begin, Real end) {
  const Real along = curve.w.x, across = curve.w.y;
  if (along > 0 && begin * along < across && across < end * along) {
    return curve.is_line ? curve.distance / 2 : length(curve.at) / 2;
  }
  return std::min(curve.height(begin), curve.height(end));
}

}  // namespace

template <class Cell>
void FaceBuilder::gather(Cell& cell, Index around, Vector<double> base, Vector<double> from) {
  const Index sites = sites_.instance().site_count();
  candidates_.clear();
  reach_.update(cell, cell, base);
  const auto take = [&](Index site) {
    candidates_.push_back(site);
    ++counters.candidates;
    const bool changed = cell.add_site(site);
    if (changed) reach_.update(cell, cell, base);
    return changed;
  };
  // Hints first, then what lies near along the Hilbert curve, if it may still matter.
  seeds_.push_back(around);
  for (Index k = 1; k <= neighbours; ++k) {
    if (around + k < sites) seeds_.push_back(around + k);
    if (around >= k) seeds_.push_back(around - k);
  }
  for (std::size_t i = 0; i < seeds_.size(); ++i) {
    const auto here = seeds_.begin() + std::ptrdiff_t(i);
    if (std::find(seeds_.begin(), here, *here) == here && reach_.meets(site_box(*here))) take(*here);
  }
  const std::size_t seeds = candidates_.size();
  const auto window = [&]() -> const SiteBoxes::Box& { return reach_.window(); };
  const auto meets = [&](const SiteBoxes::Box& box) { return reach_.meets(box); };
  const auto visit = [&](Index site) {
    const auto end = candidates_.begin() + std::ptrdiff_t(seeds);
    return std::find(candidates_.begin(), end, site) == end && take(site);
  };
  // A face that reaches far would otherwise be cut by all that lies near before it is cut by what faces it.
  const auto& half = reach_.window().half;
  if (reach_.is_open() || std::max(half.x, half.y) > 8 * cell.size()) {
    boxes_.search_nearest(from, memory_, window, meets, visit);
  } else {
    boxes_.search_near(from, memory_, window, meets, visit);
  }
}

SiteBoxes::Box FaceBuilder::site_box(Index site) const {
  const auto s = sites_.instance().site(site);
  const Point a = sites_.instance().vertices()[s.a], b = sites_.instance().vertices()[s.b];
  return {{(a.x + b.x) / 2, (a.y + b.y) / 2}, {std::abs(a.x - b.x) / 2, std::abs(a.y - b.y) / 2}};
}

Index FaceBuilder::site_of(Index label) const {
  return sites_.is_side(label) ? label >> 1 : sites_.owner(sites_.instance().vertex_of(label));
}

/// The next side that looks the same way probably has the same neighbours.
void FaceBuilder::remember(Index element) {
  constexpr std::size_t most = 12;
  Recent& r = recent_[1];
  std::swap(recent_[0], r);
  r.normal = sites_.normal<double>(element);
  r.sites.clear();
  for (const auto& arc : side_.arcs()) {
    const Index label = arc.curve.label;
    if (label == none || r.sites.size() >= most) continue;
    const Index site = site_of(label);
    if (std::find(r.sites.begin(), r.sites.end(), site) == r.sites.end()) r.sites.push_back(site);
  }
}

bool FaceBuilder::find_candidates(Index element, std::span<const Index> hints) {
  const Instance& in = sites_.instance();
  seeds_.clear();
  for (const Index label : hints) seeds_.push_back(site_of(label));
  if (in.is_side(element)) {
    side_.start(element);
    const Vector<double> n = sites_.normal<double>(element);
    const Recent& r = recent_[dot(n, recent_[0].normal) > dot(n, recent_[1].normal) ? 0 : 1];
    seeds_.insert(seeds_.end(), r.sites.begin(), r.sites.end());
    const auto e = in.ends(element);
    const Point p = in.vertices()[e.from], q = in.vertices()[e.to];
    gather(side_, element >> 1, {p.x, p.y}, {(p.x + q.x) / 2, (p.y + q.y) / 2});
    remember(element);
    return true;
  }
  const Index v = in.vertex_of(element);
  const Point p = in.vertices()[v];
  if (!vertex_.start(v)) {
    candidates_.clear();
    reach_.update(vertex_, vertex_, {p.x, p.y});
    return false;
  }
  gather(vertex_, sites_.owner(v), {p.x, p.y}, {p.x, p.y});
  return true;
}

bool FaceBuilder::build(Index element, std::span<const Index> hints, std::vector<Link>& out) {
  if (!find_candidates(element, hints)) return false;
  if (sites_.is_side(element)) return write(side_, out) && !side_.is_uncertain();
  return write(vertex_, out) && !vertex_.is_uncertain();
}

/// The candidates that still come near, then, as double precision may have taken a site for nearer than it is, all
/// others that come near the face in quadruple precision.
template <class Cell, class Precise>
void FaceBuilder::gather_precisely(const Cell& cell, Precise& precise, Vector<double> base) {
  near_.clear();
  for (const Index site : candidates_) {
    if (!reach_.meets(site_box(site))) continue;
    near_.push_back(site);
    precise.add_site(site);
  }
  std::sort(near_.begin(), near_.end());
  reach_.update(precise, cell, base);
  boxes_.search_nearest(
      base, memory_, [&]() -> const SiteBoxes::Box& { return reach_.window(); },
      [&](const SiteBoxes::Box& box) { return reach_.meets(box); },
      [&](Index site) {
        if (!std::binary_search(near_.begin(), near_.end(), site) && precise.add_site(site))
          reach_.update(precise, cell, base);
      });
}

template <class Real>
void FaceBuilder::build_with(SideCell<Real>& side, VertexCell<Real>& vertex, Index element, std::vector<Link>& out) {
  find_candidates(element, {});
  const Instance& in = sites_.instance();
  const Point base = in.vertices()[in.is_side(element) ? in.ends(element).from : in.vertex_of(element)];
  if (in.is_side(element)) {
    side.start(element);
    gather_precisely(side_, side, {base.x, base.y});
    write(side, out);
  } else {
    vertex.start(in.vertex_of(element));
    gather_precisely(vertex_, vertex, {base.x, base.y});
    write(vertex, out);
  }
}

void FaceBuilder::build_precisely(Index element, Precision precision, std::vector<Link>& out) {
  if (precision == Precision::twofold) return build_with(twofold_side_, twofold_vertex_, element, out);
  if (precision == Precision::quadruple) return build_with(precise_side_, precise_vertex_, element, out);
  SideCell<wide> side(sites_);
  VertexCell<wide> vertex(sites_);
  build_with(side, vertex, element, out);
}

template <class Real>
bool FaceBuilder::write(const SideCell<Real>& cell, std::vector<Link>& out) const {
  const Instance& in = sites_.instance();
  const auto ends = cell.ends();
  const Point base = in.vertices()[ends.from];
  const auto& arcs = cell.arcs();
  const auto place = [&](Real x, double height) { return sum(base, rounded(cell.plane({x, Real(height)}))); };
  const bool starts = in.sector(ends.from).after == cell.element(), stops = in.sector(ends.to).before == cell.element();
  const double left = double(arcs.front().curve.height(0));
  const Index first = starts ? in.circle(ends.from) : cell.corner(0),
              last = stops ? in.circle(ends.to) : cell.corner(1);
  if (first == none || last == none) return false;
  if (first != arcs.front().curve.label) out.push_back({first, left, 0, place(0, left)});
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const auto& a = arcs[i];
    const double height = double(a.curve.height(a.end));
    out.push_back({a.curve.label, height, double(lowest(a.curve, a.begin, a.end)), place(a.end, height)});
    if (i + 1 == arcs.size()) continue;
    // A segment that crosses the base at a narrow angle: its far side's stretch may be too short to be seen.
    const auto& b = arcs[i + 1];
    const bool falls = height == 0, rises = b.curve.height(b.begin) == 0;
    if (falls && (a.curve.label ^ 1u) != b.curve.label) {
      const double top = double(b.curve.height(b.begin));
      out.push_back({a.curve.label ^ 1u, top, 0, place(b.begin, top)});
    } else if (rises && (b.curve.label ^ 1u) != a.curve.label) {
      out.push_back({b.curve.label ^ 1u, 0, 0, place(b.begin, 0)});
    }
  }
  if (last != arcs.back().curve.label) out.push_back({last, 0, 0, {}});
  out.back().clearance = 0, out.back().end = in.vertices()[ends.to];
  return true;
}

template <class Real>
bool FaceBuilder::write(const VertexCell<Real>& cell, std::vector<Link>& out) const {
  const Instance& in = sites_.instance();
  const Point base = in.vertices()[cell.vertex()];
  const auto place = [&](Vector<double> u, double height) { return sum(base, height * u); };
  if (!cell.is_isolated()) {
    const auto& chart = cell.chart(0);
    const auto& arc = chart.envelope.arcs().front();
    const double height = double(arc.curve.height(arc.begin));
    out.push_back({cell.sector().before, height, 0, place(rounded(chart.direction(arc.begin)), height)});
  }
  const std::size_t first = out.size();
  for (int k = 0; k < cell.chart_count(); ++k) {
    const auto& chart = cell.chart(k);
    const auto& arcs = chart.envelope.arcs();
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const double height = double(arcs[i].curve.height(arcs[i].end));
      const Link link{arcs[i].curve.label, height, double(lowest(arcs[i].curve, arcs[i].begin, arcs[i].end)),
                      place(rounded(chart.direction(arcs[i].end)), height)};
      if (i == 0 && k > 0 && out.back().label == link.label) {  // goes on from the chart before
        const double minimum = std::min(out.back().minimum, link.minimum);
        out.back() = link;
        out.back().minimum = minimum;
      } else {
        out.push_back(link);
      }
    }
  }
  if (!cell.is_isolated()) {
    out.push_back({cell.sector().after, 0, 0, base});
  } else if (out.size() - first > 1 && out.back().label == out[first].label) {  // a closed border has no start
    out[first].minimum = std::min(out[first].minimum, out.back().minimum);
    out.pop_back();
  }
  if (out.size() - first == 1 && out[first].label == none && cell.is_isolated()) out.pop_back();  // alone in the plane
  return true;
}

}  // namespace krepl::voronoi
