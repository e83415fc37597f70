#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/pages.hpp"
#include "voronoi/glue.hpp"

namespace krepl::voronoi {
namespace {

struct Place {
  Vector<quad> centre;
  quad radius;
};

/// What a site adds to Newton's iteration: the direction from it to the centre, and by how much the distance exceeds
/// the radius.
struct Contact {
  Vector<quad> away;
  quad excess;
};

Contact contact(const Sites& sites, Index element, const Place& at) {
  const Instance& in = sites.instance();
  if (in.is_side(element)) {
    const Vector<quad> n = sites.normal<quad>(element), v = at.centre - in.moved(in.ends(element).from);
    return {n, dot(n, v) - at.radius};
  }
  const Vector<quad> v = at.centre - in.moved(in.vertex_of(element));
  const quad l = length(v);
  return {{v.x / l, v.y / l}, l - at.radius};
}

/// The circle that touches three sites, by Newton's iteration from a place that is nearly right. Returns false if it
/// does not settle.
bool settle(const Sites& sites, const std::array<Index, 3>& touched, Place& place) {
  Place p = place;
  for (int i = 0; i < 12; ++i) {
    const Contact a = contact(sites, touched[0], p), b = contact(sites, touched[1], p),
                  c = contact(sites, touched[2], p);
    const Vector<quad> u = b.away - a.away, v = c.away - a.away;
    const quad f = a.excess - b.excess, g = a.excess - c.excess, det = cross(u, v);
    if (det == 0) return false;
    const Vector<quad> step{(f * v.y - g * u.y) / det, (u.x * g - v.x * f) / det};
    const quad change = dot(a.away, step) + a.excess;
    p.centre = p.centre + step;
    p.radius += change;
    if (!(kernel::absolute(step.x) + kernel::absolute(step.y) + kernel::absolute(change) > quad(0x1p-70) * p.radius)) {
      if (!(kernel::absolute(p.radius - place.radius) < place.radius / 8)) return false;  // went elsewhere
      place = p;
      return true;
    }
  }
  return false;
}

class Placing {
 public:
  Placing(const Sites& sites, const Borders& borders, const Context& context, Diagram& d)
      : sites_(sites), in_(sites.instance()), borders_(borders), d_(d) {
    kernel::resize_pages(context, face_, d.link_count());
    kernel::resize_pages(context, old_, d.link_count());
    kernel::reserve_large(d.place, d.link_count() / 2);  // there are hardly more vertices
    kernel::reserve_large(d.clearance, d.link_count() / 2);
    for (Index e = 0; e < d.face_count(); ++e) {
      for (Index i = d.begin[e]; i < d.begin[e + 1]; ++i) face_[i] = e, old_[i] = borders.first[e] + (i - d.begin[e]);
    }
    tolerance_ = 0x1p-50 * in_.extent();
  }

  void run() {
    for (Index i = 0; i < d_.link_count(); ++i) {
      if (d_.vertex[i] == none) place(i);
    }
    for (Index i = 0; i < d_.link_count(); ++i) set_minimum(i);
  }

 private:
  const Link& link(Index i) const { return borders_.links[old_[i]]; }
  bool is_closed(Index face) const { return !in_.is_side(face) && in_.sector(in_.vertex_of(face)).before == face; }
  Index next(Index i) const {
    const Index f = face_[i];
    if (i + 1 < d_.begin[f + 1]) return i + 1;
    return is_closed(f) && d_.begin[f + 1] - d_.begin[f] > 1 ? d_.begin[f] : none;
  }
  Index before(Index i) const {
    const Index f = face_[i];
    if (i > d_.begin[f]) return i - 1;
    return is_closed(f) && d_.begin[f + 1] - d_.begin[f] > 1 ? d_.begin[f + 1] - 1 : none;
  }

  void place(Index i) {
    orbit_.clear();
    Index j = i;
    do {  // around the vertex, clockwise
      orbit_.push_back(j);
      const Index n = next(j);
      j = n == none ? none : d_.twin[n];
    } while (j != none && j != i);
    if (j == none) {  // it comes to an end, at the site itself or at the horizon: the other way round as well
      for (j = i; j != none && d_.twin[j] != none;) {
        j = before(d_.twin[j]);
        if (j != none) orbit_.push_back(j);
      }
    }
    const Index v = Index(d_.place.size());
    for (const Index k : orbit_) d_.vertex[k] = v;
    evaluate();
  }

  void evaluate() {
    const bool at_horizon = std::any_of(orbit_.begin(), orbit_.end(), [&](Index k) { return link(k).label == none; });
    // The bisector of two places next to each other leads away from them, and how far is told best by what sees the horizon.
    const Link& best =
        link(!at_horizon ? orbit_[0] : *std::max_element(orbit_.begin(), orbit_.end(), [&](Index a, Index b) {
          return link(a).clearance < link(b).clearance;
        }));
    double least = best.clearance, most = least, spread = 0;
    for (const Index k : orbit_) {
      const Link& l = link(k);
      least = std::min(least, l.clearance), most = std::max(most, l.clearance);
      spread = std::max(spread, std::abs(l.end.x - best.end.x) + std::abs(l.end.y - best.end.y));
    }
    Point end = best.end;
    double clearance = least == 0 ? 0 : best.clearance;
    const double tolerance = std::max(tolerance_, 0x1p-50 * clearance);
    if (clearance > 0 && !at_horizon && orbit_.size() > 2 && (most - least > tolerance || spread > tolerance)) {
      ++d_.counters.vertices_in_quadruple;
      Place p{{best.end.x, best.end.y}, best.clearance};
      if (settle(sites_, {face_[orbit_[0]], face_[orbit_[1]], face_[orbit_[2]]}, p)) {
        end = {double(p.centre.x), double(p.centre.y)};
        clearance = double(p.radius);
      }
    }
    d_.place.push_back(end);
    d_.clearance.push_back(clearance);
  }

  /// Both views of a link have the same minimum, and none above its ends.
  void set_minimum(Index i) {
    const Index t = d_.twin[i];
    if (t != none && t < i) {
      d_.minimum[i] = d_.minimum[t];
      return;
    }
    d_.minimum[i] = std::min(link(i).minimum, d_.clearance[d_.vertex[i]]);
    if (t != none) d_.minimum[i] = std::min(d_.minimum[i], d_.clearance[d_.vertex[t]]);
  }

  const Sites& sites_;
  const Instance& in_;
  const Borders& borders_;
  Diagram& d_;
  std::vector<Index> face_, old_, orbit_;
  double tolerance_;
};

}  // namespace

void place_vertices(const Sites& sites, const Borders& borders, const Context& context, Diagram& diagram) {
  Placing(sites, borders, context, diagram).run();
}

}  // namespace krepl::voronoi
