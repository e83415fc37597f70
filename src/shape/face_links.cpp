#include "shape/face_links.hpp"

#include <algorithm>
#include <cmath>

#include "zone/crossing.hpp"

namespace krepl::shape {

using namespace vectors;
using voronoi::Diagram;
using zone::Index;
using zone::none;

namespace {

/// The bisector of a vertex and another site from one place to another, straight or a parabola with the vertex as its focus.
class Course {
 public:
  Course(Point start, Point end) : start_(start), end_(end) {}
  /// `foot`: a place of the directrix, `direction` along it.
  Course(Point start, Point end, Point focus, Point foot, Point direction) : start_(start), end_(end), focus_(focus) {
    along_ = (1 / length(direction)) * direction;
    down_ = {-along_.y, along_.x};
    height_ = dot(foot - focus, down_);
    if (height_ < 0) down_ = -1.0 * down_, height_ = -height_;
    from_ = dot(start - focus, along_), to_ = dot(end - focus, along_);
    parabola_ = height_ > 0;
  }

  /// How far along, 0 to 1, a place of the curve is.
  double along(Point place) const {
    const double t = parabola_ ? (dot(place - focus_, along_) - from_) / (to_ - from_)
                               : dot(place - start_, end_ - start_) / dot(end_ - start_, end_ - start_);
    return t >= 0 && t <= 1 ? t : t > 1 ? 1.0 : 0.0;  // 0 also where the curve has no length
  }
  Point at(double t) const { return parabola_ ? on_parabola(from_ + t * (to_ - from_)) : start_ + t * (end_ - start_); }

  /// Appends how far along the curve crosses a border of the region about `vertex`, its focus.
  void crossings(const BendRegion::Border& border, Point vertex, std::vector<double>& out) const {
    if (!parabola_) {
      const double first = dot(border.normal, start_ - vertex) - border.distance;
      const double last = dot(border.normal, end_ - vertex) - border.distance;
      if ((first > 0) != (last > 0)) out.push_back(first / (first - last));
      return;
    }
    // normal * (x along + y down) = distance with y = (height^2 - x^2) / (2 height)
    const double nx = dot(border.normal, along_), ny = dot(border.normal, down_);
    const double a = -ny / (2 * height_), c = ny * height_ / 2 - border.distance;
    const double discriminant = nx * nx - 4 * a * c;
    if (!(discriminant >= 0)) return;
    const double q = -(nx + std::copysign(std::sqrt(discriminant), nx)) / 2;
    for (const double x : {q / a, c / q}) {
      const double t = (x - from_) / (to_ - from_);
      if (t > 0 && t < 1) out.push_back(t);
    }
  }

 private:
  Point on_parabola(double x) const {
    return focus_ + x * along_ + ((height_ - x) * (height_ + x) / (2 * height_)) * down_;
  }

  Point start_, end_, focus_{}, along_{}, down_{};
  double height_ = 0, from_ = 0, to_ = 0;
  bool parabola_ = false;
};

}  // namespace

FaceLinks::FaceLinks(const Diagram& diagram, const zone::Instance& instance, const std::vector<bool>& wanted,
                     const ShapeOptions& options)
    : diagram_(diagram), in_(instance), wanted_(wanted), begin_(diagram.link_count() + 1, 0) {
  if (options.join != Join::round) {
    region_of_.assign(diagram.face_count(), none);
    for (Index f = in_.side_count(); f < diagram.face_count(); ++f) {
      if (!wanted_[f]) continue;
      const auto region = BendRegion::at(in_, in_.vertex_of(f), options);
      if (!region) continue;
      region_of_[f] = Index(regions_.size());
      regions_.push_back(*region);
    }
  }
  for (Index f = 0; f < diagram.face_count(); ++f) add_face(f);
}

bool FaceLinks::is_perpendicular(Index face, Index link) const {
  const Index other = diagram_.label[link];
  if (other >= voronoi::site_itself || in_.is_side(face) == in_.is_side(other)) return false;
  const Index side = in_.is_side(face) ? face : other, vertex = in_.vertex_of(in_.is_side(face) ? other : face);
  return in_.ends(side).from == vertex || in_.ends(side).to == vertex;
}

void FaceLinks::add_face(Index f) {
  Point at = in_.vertices()[in_.is_side(f) ? in_.ends(f).from : in_.vertex_of(f)];
  for (Index i = diagram_.begin[f]; i < diagram_.begin[f + 1]; ++i) {
    begin_[i] = Index(pieces_.size());
    const Point end = diagram_.place[diagram_.vertex[i]];
    if (wanted_[f]) add_link(f, i, at, end);
    begin_[i + 1] = Index(pieces_.size());
    at = end;
  }
}

/// Where regions of bends meet perpendiculars they reach as far as the radius.
bool FaceLinks::ends_outside(Index face, Index link) const {
  const Index vertex = diagram_.vertex[link];
  const BendRegion* bend = region(face);
  if (bend == nullptr || is_perpendicular(face, link) ||
      (link + 1 < diagram_.begin[face + 1] && is_perpendicular(face, link + 1)))
    return diagram_.clearance[vertex] > in_.radius();
  return bend->excess(diagram_.place[vertex]) > 0;
}

bool FaceLinks::starts_outside(Index face, Index link) const {
  return link != diagram_.begin[face] && ends_outside(face, link - 1);
}

void FaceLinks::add_link(Index face, Index link, Point start, Point end) {
  const Index other = diagram_.label[link], twin = diagram_.twin[link];
  const bool both = other < voronoi::site_itself && wanted_[other] && twin != none;
  if (both && twin < link) {  // seen from there already
    for (Index i = begin_[twin + 1]; i-- > begin_[twin];) {
      const Piece p = pieces_[i];
      pieces_.push_back({p.end, p.start, p.held_beyond, p.held});
    }
    return;
  }
  std::vector<Toggle> toggles;
  add_toggles(face, link, start, end, false, toggles);
  bool held = !starts_outside(face, link), held_beyond = both && !ends_outside(other, twin);
  // Both hold the same places of it.
  const bool alike =
      is_perpendicular(face, link) || (region(face) == nullptr && (!both || region(other) == nullptr));
  if (both && !alike) add_toggles(face, link, start, end, true, toggles);
  std::stable_sort(toggles.begin(), toggles.end(), [](const Toggle& a, const Toggle& b) { return a.along < b.along; });
  Point at = start;
  for (const Toggle& t : toggles) {
    pieces_.push_back({at, t.at, held, both && (alike ? held : held_beyond)});
    (t.beyond ? held_beyond : held) ^= true;
    at = t.at;
  }
  pieces_.push_back({at, end, held, both && (alike ? held : held_beyond)});
}

/// Where the link, as it runs around `face`, leaves or enters what the zone holds of that face, or of the one beyond.
void FaceLinks::add_toggles(Index face, Index link, Point start, Point end, bool beyond, std::vector<Toggle>& out) const {
  const Index label = diagram_.label[link];
  const Index own = beyond ? label : face, other = beyond ? face : label;
  const bool from_outside = beyond ? ends_outside(own, diagram_.twin[link]) : starts_outside(own, link);
  const bool to_outside = beyond ? starts_outside(own, diagram_.twin[link]) : ends_outside(own, link);
  const BendRegion* bend = region(own);
  std::optional<Course> course;
  if (label < voronoi::site_itself) {
    const Index side = in_.is_side(face) ? face : label, circle = in_.is_side(face) ? label : face;
    if (in_.is_side(side) && !in_.is_side(circle) && !is_perpendicular(face, link)) {
      const auto ends = in_.ends(side);
      const Point a = in_.vertices()[ends.from], b = in_.vertices()[ends.to];
      course.emplace(start, end, in_.vertices()[in_.vertex_of(circle)], a, b - a);
    }
  }
  if (!course) course.emplace(start, end);
  if (bend == nullptr || is_perpendicular(face, link) || label >= voronoi::site_itself) {
    if (diagram_.minimum[link] > in_.radius()) return;
    if (from_outside) {
      const Point at = zone::crossing(in_, beyond ? other : own, beyond ? own : other);
      out.push_back({course->along(at), at, beyond});
    }
    if (to_outside) {
      const Point at = zone::crossing(in_, beyond ? own : other, beyond ? other : own);
      out.push_back({from_outside ? std::max(course->along(at), out.back().along) : course->along(at), at, beyond});
    }
    return;
  }
  std::vector<double> cuts;
  for (const auto& border : bend->borders()) course->crossings(border, bend->vertex(), cuts);
  std::sort(cuts.begin(), cuts.end());
  // In between, the middle tells; at the ends, the diagram's vertex, for all its links alike.
  bool outside = from_outside;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const bool last = i + 1 == cuts.size();
    const double middle = (cuts[i] + (last ? 1 : cuts[i + 1])) / 2;
    const bool next = last ? to_outside : bend->excess(course->at(middle)) > 0;
    if (next == outside) continue;
    out.push_back({cuts[i], course->at(cuts[i]), beyond});
    outside = next;
  }
  if (outside != to_outside) {  // touches a border within rounding
    const bool first = std::abs(bend->excess(start)) < std::abs(bend->excess(end));
    out.push_back({first ? 0.0 : 1.0, first ? start : end, beyond});
  }
}

}  // namespace krepl::shape
