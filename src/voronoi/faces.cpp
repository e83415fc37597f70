#include "voronoi/faces.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::voronoi {
namespace {

Point sum(Point base, Vector<double> offset) { return {base.x + offset.x, base.y + offset.y}; }

template <class Real>
Vector<double> rounded(Vector<Real> v) {
  return {double(v.x), double(v.y)};
}

/// The least distance along an arc of a side's border, given those at its ends: a parabola has its lowest point under
/// the other site.
template <class Real>
double lowest(const SideCurve<Real>& curve, Real begin, Real end, double first, double last) {
  if (!curve.is_line && begin < curve.at.x && curve.at.x < end) return double(curve.at.y / 2);
  return std::min(first, last);
}
template <class Real>
Real lowest(const VertexCurve<Real>& curve, Real begin, Real end) {
  const Real along = curve.w.x, across = curve.w.y;
  if (along > 0 && begin * along < across && across < end * along) {
    return curve.is_line ? curve.distance / 2 : length(curve.at) / 2;
  }
  return std::min(curve.height(begin), curve.height(end));
}

/// The height of a side's border where arc i ends at x, and arc k begins or the reverse. Where arc i is too steep for the
/// place's rounding (the bisector of two segments that cross at a narrow angle stands nearly upright), by arc k.
template <class Arcs, class Real>
double joint_height(const Arcs& arcs, std::size_t i, std::size_t k, Real x) {
  constexpr double steep = 1024;
  const bool by_other = k < arcs.size() && arcs[i].curve.steepness(x) > steep && arcs[k].curve.steepness(x) <= steep;
  return double(arcs[by_other ? k : i].curve.height(x));
}

/// What a face tells: these among others, where all are few.
std::span<const Hint> hints_about(std::span<const Hint> hints, Index face) {
  if (hints.size() <= few_hints) return hints;
  const auto first = std::partition_point(hints.begin(), hints.end(), [&](const Hint& h) { return h.face < face; });
  const auto last = std::partition_point(first, hints.end(), [&](const Hint& h) { return h.face == face; });
  return {first, last};
}

}  // namespace

/// What was taken of a site so far. Most faces look at few sites; the side of a long segment may at thousands.
FaceBuilder::Taken& FaceBuilder::taken(Index site) {
  constexpr std::size_t few = 32;
  if (taken_.size() <= few) {
    const auto known = std::find_if(taken_.begin(), taken_.end(), [&](const Taken& t) { return t.site == site; });
    if (known != taken_.end()) return *known;
    if (taken_.size() == few) {
      taken_at_.clear();
      for (std::size_t i = 0; i < few; ++i) taken_at_.emplace(taken_[i].site, i);
    }
  } else if (const auto known = taken_at_.find(site); known != taken_at_.end()) {
    return taken_[known->second];
  }
  if (taken_.size() >= few) taken_at_.emplace(site, taken_.size());
  taken_.push_back({site, 0});
  ++counters.candidates;
  return taken_.back();
}

/// Takes parts of a site into account that were not yet; returns true if the face changed.
template <class Cell>
bool FaceBuilder::take(Cell& cell, Index site, SiteParts parts) {
  Taken& so_far = taken(site);
  parts &= ~so_far.parts;
  so_far.parts |= parts;
  return parts != 0 && cell.add_site(site, parts);
}

template <class Cell>
bool FaceBuilder::take(Cell& cell, Index label) {
  return label < site_itself && take(cell, sites_.site_of(label), sites_.part_of(label));
}

/// A link that a finished face has as well, between the same neighbours, lies along empty disks.
void FaceBuilder::find_known(std::span<const Hint> hints, Index first, Index last) {
  const std::size_t count = labels_.size();
  known_.assign(count, 0);
  for (std::size_t i = 0, end = 0; i < count; i = end) {
    const Index label = labels_[i];
    for (end = i + 1; end < count && labels_[end] == label;) ++end;  // one link in two charts
    const Index before = i > 0 ? labels_[i - 1] : first, after = end < count ? labels_[end] : last;
    for (const Hint& h : hints_about(hints, label)) {
      if (h.face != label) continue;
      const bool starts = h.before == before, stops = h.after == after;
      if (starts) known_.joints[i] = 1;
      if (stops) known_.joints[end] = 1;
      if (!starts || !stops) continue;
      std::fill(known_.arcs.begin() + std::ptrdiff_t(i), known_.arcs.begin() + std::ptrdiff_t(end), 1);
      std::fill(known_.joints.begin() + std::ptrdiff_t(i), known_.joints.begin() + std::ptrdiff_t(end) + 1, 1);
    }
  }
}

template <class Cell>
void FaceBuilder::judge(const Cell& cell, std::span<const Hint> hints, Vector<double> base) {
  labels_.clear();
  if constexpr (std::is_same_v<Cell, SideCell<double>>) {
    for (const auto& arc : cell.arcs()) labels_.push_back(arc.curve.label);
    const auto *before = cell.envelope().arc_before(), *after = cell.envelope().arc_after();
    const auto at_corner = [&](Index corner, Index label) { return corner == label ? site_itself : corner; };
    find_known(hints, before != nullptr ? before->curve.label : at_corner(cell.corner(0), labels_.front()),
               after != nullptr ? after->curve.label : at_corner(cell.corner(1), labels_.back()));
  } else {
    for (int i = 0; i < cell.chart_count(); ++i) {
      for (const auto& arc : cell.chart(i).envelope.arcs()) labels_.push_back(arc.curve.label);
    }
    if (cell.is_isolated()) find_known(hints, labels_.back(), labels_.front());
    else find_known(hints, cell.sector().before, cell.sector().after);
  }
  reach_.update(cell, cell, base, known_);
}

/// Where a side's face is open still, what follows its neighbours there along their own lines probably closes it. Puts
/// that into seeds_; false if there is nothing open.
bool FaceBuilder::find_seeds_beside_the_open() {
  seeds_.clear();
  const auto add_beside = [&](Index label) {
    if (label >= site_itself) return;
    if (!sites_.is_side(label)) {
      const auto sector = sites_.instance().sector(sites_.instance().vertex_of(label));
      if (sites_.is_side(sector.before)) seeds_.push_back(sector.before), seeds_.push_back(sector.after);
      return;
    }
    for (const int end : {0, 1}) {
      const Index corner = sites_.corner(label, end);
      seeds_.push_back(corner);
      if (sites_.is_side(corner)) continue;
      const auto sector = sites_.instance().sector(sites_.instance().vertex_of(corner));
      seeds_.push_back(end == 0 ? sector.before : sector.after);
    }
  };
  const auto& arcs = side_.arcs();
  bool open = false;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (arcs[i].curve.label != none) continue;
    open = true;
    add_beside(i > 0 ? arcs[i - 1].curve.label : side_.corner(0));
    add_beside(i + 1 < arcs.size() ? arcs[i + 1].curve.label : side_.corner(1));
  }
  return open;
}

template <class Cell>
void FaceBuilder::gather(Cell& cell, std::span<const Hint> hints, Vector<double> base) {
  taken_.clear();
  for (const Hint& h : hints) take(cell, h.face), take(cell, h.before), take(cell, h.after);
  if constexpr (std::is_same_v<Cell, SideCell<double>>) take(cell, cell.corner(0)), take(cell, cell.corner(1));
  judge(cell, hints, base);
  if (reach_.is_empty()) return;
  ++counters.searched;
  bool narrower = false;
  for (const Index label : seeds_) {
    if (reach_.meets(site_box(sites_.site_of(label)))) narrower = take(cell, label) || narrower;
  }
  if constexpr (std::is_same_v<Cell, SideCell<double>>) {
    constexpr int most_steps = 8;
    for (int i = 0; i < most_steps && find_seeds_beside_the_open(); ++i) {
      bool closer = false;
      for (const Index label : seeds_) closer = (label != cell.element() && take(cell, label)) || closer;
      if (!closer) break;
      narrower = true;
    }
  }
  if (narrower) judge(cell, hints, base);
  bool whole = gather_by_search(cell, hints, base);
  if constexpr (std::is_same_v<Cell, SideCell<double>>) {
    while (begin_next_piece(!whole, hints, base)) whole = gather_by_search(cell, hints, base);
  }
}

/// Takes all that cuts the face, or the piece of it in work. Returns false if it stops because these are many.
template <class Cell>
bool FaceBuilder::gather_by_search(Cell& cell, std::span<const Hint> hints, Vector<double> base) {
  if (reach_.is_empty()) return true;
  constexpr std::size_t many = 64;
  const auto has_many = [&] { return std::is_same_v<Cell, SideCell<double>> && labels_.size() > many; };
  if (has_many()) return false;
  bool stops = false;
  const auto window = [&]() -> const SiteBoxes::SearchWindow& { return reach_.window(); };
  const auto meets = [&](const SiteBoxes::Box& box) { return !stops && reach_.meets(box); };
  // A face only becomes smaller, so where it has many neighbours it is enough to judge it now and then: by what was
  // looked at since it changed, not by changes, or a site that closes the face would go unnoticed if it is the last.
  bool changed = false;
  std::size_t looked_at = 0;
  const auto visit = [&](Index site) {
    constexpr std::size_t share = 16;
    changed = take(cell, site, all_parts) || changed;
    if (!changed || share * ++looked_at < labels_.size()) return false;
    judge(cell, hints, base);
    changed = false;
    looked_at = 0;
    stops = has_many();
    return true;
  };
  const Vector<double> from = base + cell.middle();
  // A face that reaches far would otherwise be cut by all that lies near before it is cut by what faces it.
  const auto& half = reach_.window().half;
  if (reach_.is_open() || std::max(half.x, half.y) > 8 * cell.size()) {
    boxes_.search_nearest(from, memory_, window, meets, visit);
  } else {
    boxes_.search_near(from, memory_, window, meets, visit);
  }
  return !stops;
}

/// Of a side with many neighbours: goes on with half of the piece in work, or, when that is done, with the one that waits
/// next. Returns false if none does: the face is whole.
bool FaceBuilder::begin_next_piece(bool split, std::span<const Hint> hints, Vector<double> base) {
  auto& envelope = side_.envelope();
  const bool is_whole = !split && envelope.arc_before() == nullptr && envelope.arc_after() == nullptr;
  if (is_whole) return false;
  bool goes_on = true;
  if (split) {
    envelope.split();
  } else {
    goes_on = envelope.next_piece();
    taken_.clear();
    for (const auto& arc : side_.arcs()) {
      const Index label = arc.curve.label;
      if (label != none) taken(sites_.site_of(label)).parts |= sites_.part_of(label);
    }
  }
  judge(side_, hints, base);
  return goes_on;
}

SiteBoxes::Box FaceBuilder::site_box(Index site) const {
  const auto s = sites_.instance().site(site);
  const Point a = sites_.instance().vertices()[s.a], b = sites_.instance().vertices()[s.b];
  return {{(a.x + b.x) / 2, (a.y + b.y) / 2}, {std::abs(a.x - b.x) / 2, std::abs(a.y - b.y) / 2}};
}

/// The next side that looks the same way probably has the same neighbours.
void FaceBuilder::remember(Index element) {
  constexpr std::size_t most = 12;
  Recent& r = recent_[1];
  std::swap(recent_[0], r);
  r.normal = sites_.normal<double>(element);
  r.labels.clear();
  for (const auto& arc : side_.arcs()) {
    if (arc.curve.label != none && r.labels.size() < most) r.labels.push_back(arc.curve.label);
  }
}

bool FaceBuilder::find_candidates(Index element, std::span<const Hint> hints) {
  const Instance& in = sites_.instance();
  seeds_.clear();
  if (in.is_side(element)) {
    side_.start(element);
    const Vector<double> n = sites_.normal<double>(element);
    const Recent& r = recent_[dot(n, recent_[0].normal) > dot(n, recent_[1].normal) ? 0 : 1];
    seeds_.insert(seeds_.end(), r.labels.begin(), r.labels.end());
    const auto e = in.ends(element);
    const Point p = in.vertices()[e.from];
    gather(side_, hints, {p.x, p.y});
    remember(element);
    return true;
  }
  const Index v = in.vertex_of(element);
  const Point p = in.vertices()[v];
  if (!vertex_.start(v)) {
    taken_.clear();
    judge(vertex_, hints, {p.x, p.y});
    return false;
  }
  gather(vertex_, hints, {p.x, p.y});
  return true;
}

bool FaceBuilder::build(Index element, std::span<const Hint> hints, std::vector<Link>& out) {
  if (!find_candidates(element, hints)) return false;
  if (sites_.is_side(element)) return write(side_, out) && !side_.is_uncertain();
  return write(vertex_, out) && !vertex_.is_uncertain();
}

template <class Real>
void FaceBuilder::build_with(SideCell<Real>& side, VertexCell<Real>& vertex, Index element,
                             std::span<const Index> labels, std::vector<Link>& out) {
  const auto add_all = [&](auto& cell) {
    for (const Index label : labels) cell.add_site(sites_.site_of(label), sites_.part_of(label));
  };
  if (sites_.is_side(element)) {
    side.start(element);
    add_all(side);
    write(side, out);
  } else {
    vertex.start(sites_.instance().vertex_of(element));
    add_all(vertex);
    write(vertex, out);
  }
}

void FaceBuilder::build_among(Index element, std::span<const Index> labels, Precision precision,
                              std::vector<Link>& out) {
  if (precision == Precision::twofold) return build_with(twofold_side_, twofold_vertex_, element, labels, out);
  if (precision == Precision::quadruple) return build_with(precise_side_, precise_vertex_, element, labels, out);
  SideCell<wide> side(sites_);
  VertexCell<wide> vertex(sites_);
  build_with(side, vertex, element, labels, out);
}

/// The candidates that still come near, then, as double precision may have taken a site for nearer than it is, all
/// others that come near the face in quadruple precision.
template <class Cell, class Precise>
void FaceBuilder::gather_precisely(const Cell& cell, Precise& precise, Vector<double> base) {
  near_.clear();
  for (const Taken& t : taken_) {
    if (!reach_.meets(site_box(t.site))) continue;
    near_.push_back(t.site);
    precise.add_site(t.site, all_parts);
  }
  std::sort(near_.begin(), near_.end());
  const auto update = [&] {
    std::size_t arcs = 0;
    if constexpr (std::is_same_v<Cell, SideCell<double>>) {
      arcs = precise.arcs().size();
    } else {
      for (int i = 0; i < precise.chart_count(); ++i) arcs += precise.chart(i).envelope.arcs().size();
    }
    known_.assign(arcs, 0);
    reach_.update(precise, cell, base, known_);
  };
  update();
  boxes_.search_nearest(
      base, memory_, [&]() -> const SiteBoxes::SearchWindow& { return reach_.window(); },
      [&](const SiteBoxes::Box& box) { return reach_.meets(box); },
      [&](Index site) {
        const bool changed =
            !std::binary_search(near_.begin(), near_.end(), site) && precise.add_site(site, all_parts);
        if (changed) update();
        return changed;
      });
}

template <class Real>
void FaceBuilder::search_with(SideCell<Real>& side, VertexCell<Real>& vertex, Index element, std::vector<Link>& out) {
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
  if (precision == Precision::twofold) return search_with(twofold_side_, twofold_vertex_, element, out);
  if (precision == Precision::quadruple) return search_with(precise_side_, precise_vertex_, element, out);
  SideCell<wide> side(sites_);
  VertexCell<wide> vertex(sites_);
  search_with(side, vertex, element, out);
}

/// Whether a link between two clearances is none (Sites::coincidence). Near a site everything is short, so not there.
bool FaceBuilder::is_short(double width, double first, double last) const {
  const double least = sites_.coincidence(std::max(first, last));
  return width <= least && std::abs(first - last) <= least && std::min(first, last) > 64 * least;
}

template <class Real>
bool FaceBuilder::write(const SideCell<Real>& cell, std::vector<Link>& out) {
  const Instance& in = sites_.instance();
  const auto ends = cell.ends();
  const Point base = in.vertices()[ends.from];
  const auto& arcs = cell.arcs();
  const auto place = [&](Real x, double height) { return sum(base, rounded(cell.plane({x, Real(height)}))); };
  const double left = double(arcs.front().curve.height(0));
  const Index first = cell.corner(0), last = cell.corner(1);
  // A corner whose bisector is not seen is so blunt that the bisector is a perpendicular. Where segments are folded onto
  // each other it is not; then the face is wrong.
  const auto is_blunt = [&](Index corner) {
    return !sites_.is_side(corner) || dot(sites_.normal<double>(corner), sites_.normal<double>(cell.element())) > 0;
  };
  const bool sound = (first == arcs.front().curve.label || is_blunt(first)) && (last == arcs.back().curve.label || is_blunt(last));
  Index before = site_itself;
  if (first != arcs.front().curve.label) {
    out.push_back({first, left, 0, place(0, left)});
    before = first;
  }
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const auto& a = arcs[i];
    const double height = joint_height(arcs, i, i + 1, a.end), width = double(a.end - a.begin);
    const double start = joint_height(arcs, i, i - 1, a.begin);  // of the first, i - 1 is none
    const Index label = a.curve.label, after = i + 1 < arcs.size() ? arcs[i + 1].curve.label : last;
    if (label != none && before != after && width <= sites_.coincidence(height) &&
        is_short(width, start, height))
      continue;
    out.push_back({label, height, lowest(a.curve, a.begin, a.end, start, height), place(a.end, height)});
    before = label;
    if (i + 1 == arcs.size()) continue;
    // A segment that crosses the base at a narrow angle: its far side's stretch may be too short to be seen.
    const auto& b = arcs[i + 1];
    const bool falls = height == 0, rises = b.curve.height(b.begin) == 0;
    if (falls && (label ^ 1u) != b.curve.label) {
      const double top = double(b.curve.height(b.begin));
      out.push_back({label ^ 1u, top, 0, place(b.begin, top)});
    } else if (rises && (b.curve.label ^ 1u) != label) {
      out.push_back({b.curve.label ^ 1u, 0, 0, place(b.begin, 0)});
    }
  }
  if (last != arcs.back().curve.label) out.push_back({last, 0, 0, {}});
  out.back().clearance = 0, out.back().end = in.vertices()[ends.to];
  return sound;
}

template <class Real>
bool FaceBuilder::write(const VertexCell<Real>& cell, std::vector<Link>& out) {
  const Instance& in = sites_.instance();
  const Point base = in.vertices()[cell.vertex()];
  const bool isolated = cell.is_isolated();
  const auto place = [&](Vector<double> u, double height) { return sum(base, height * u); };
  if (!isolated) {
    const auto& chart = cell.chart(0);
    const auto& arc = chart.envelope.arcs().front();
    const double height = double(arc.curve.height(arc.begin));
    out.push_back({cell.sector().before, height, 0, place(rounded(chart.direction(arc.begin)), height)});
  }
  const std::size_t first = out.size();
  short_.clear();
  for (int k = 0; k < cell.chart_count(); ++k) {
    const auto& chart = cell.chart(k);
    const auto& arcs = chart.envelope.arcs();
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const auto& a = arcs[i];
      const double height = double(a.curve.height(a.end)), width = double(a.end - a.begin) * height;
      const Link link{a.curve.label, height, double(lowest(a.curve, a.begin, a.end)),
                      place(rounded(chart.direction(a.end)), height)};
      const bool is_none = !isolated && link.label != none && width <= sites_.coincidence(height) &&
                           is_short(width, double(a.curve.height(a.begin)), height);
      if (i == 0 && k > 0 && out.back().label == link.label) {  // goes on from the chart before
        const double minimum = std::min(out.back().minimum, link.minimum);
        out.back() = link;
        out.back().minimum = minimum;
        short_.back() = short_.back() && is_none;
      } else {
        out.push_back(link);
        short_.push_back(is_none);
      }
    }
  }
  if (!isolated) {
    out.push_back({cell.sector().after, 0, 0, base});
    std::size_t kept = first;
    for (std::size_t i = first; i < out.size(); ++i) {
      const bool leave_out = i - first < short_.size() && short_[i - first] && out[kept - 1].label != out[i + 1].label;
      if (!leave_out) out[kept++] = out[i];
    }
    out.resize(kept);
  } else if (out.size() - first > 1 && out.back().label == out[first].label) {  // a closed border has no start
    out[first].minimum = std::min(out[first].minimum, out.back().minimum);
    out.pop_back();
  }
  if (out.size() - first == 1 && out[first].label == none && isolated) out.pop_back();  // alone in the plane
  return true;
}

}  // namespace krepl::voronoi
