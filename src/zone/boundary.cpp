#include "zone/boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/box_tree.hpp"
#include "kernel/budget.hpp"
#include "kernel/pages.hpp"
#include "kernel/parallel.hpp"

namespace krepl::zone {
namespace {

using kernel::square_root;

/// The corners of a convex region around an element: the element is covered by a cigar that contains all of them.
struct Hull {
  std::array<Vector<double>, 4> corner;
  int corners;
  Vector<double> centre;
  double half_width;
};

Vector<double> at(Point p) { return {p.x, p.y}; }

Hull hull_of_side(const Instance& in, Index element) {
  const auto e = in.ends(element);
  const Vector<double> p = at(in.vertices()[e.from]), d = in.difference<double>(e.to, e.from);
  const double l = length(d), r = in.radius_of(element);
  const Vector<double> start{p.x + d.y / l * r, p.y - d.x / l * r};
  return {{start, {start.x + d.x, start.y + d.y}}, 2, {start.x + d.x / 2, start.y + d.y / 2}, l / 2};
}

/// The rectangle on the arc's chord that touches the arc from outside; the square around an isolated vertex's circle.
Hull hull_of_circle(const Instance& in, Index element) {
  const Index v = in.vertex_of(element);
  const Vector<double> c = at(in.vertices()[v]);
  const double r = in.radius_of(element);
  const auto sector = in.sector(v);
  if (sector.before == element) {
    return {{Vector<double>{c.x - r, c.y - r}, {c.x + r, c.y - r}, {c.x + r, c.y + r}, {c.x - r, c.y + r}}, 4, c, r};
  }
  const auto before = in.ends(sector.before), after = in.ends(sector.after);
  const Vector<double> d = in.difference<double>(before.to, before.from), f = in.difference<double>(after.to, after.from);
  const double ld = length(d), lf = length(f);
  const Vector<double> u{d.y / ld, -d.x / ld}, w{f.y / lf, -f.x / lf};
  Vector<double> middle{u.x + w.x, u.y + w.y};
  const double lm = length(middle);
  // An arc of nearly 180 degrees bulges where its first side is heading.
  middle = lm > 1e-6 ? Vector<double>{middle.x / lm, middle.y / lm} : Vector<double>{d.x / ld, d.y / ld};
  const double half_cosine = lm / 2;
  const double sagitta = r * (1 - half_cosine) * (1 + 1e-12) + r * 1e-12;
  const Vector<double> s{c.x + r * u.x, c.y + r * u.y}, t{c.x + r * w.x, c.y + r * w.y};
  const Vector<double> lift{middle.x * sagitta, middle.y * sagitta};
  const double chord = length(Vector<double>{t.x - s.x, t.y - s.y});
  return {{s, t, {t.x + lift.x, t.y + lift.y}, {s.x + lift.x, s.y + lift.y}}, 4,
          {(s.x + t.x) / 2 + lift.x / 2, (s.y + t.y) / 2 + lift.y / 2}, chord / 2 + sagitta};
}

/// Centre and half width of the stretch of an element between two parameters.
template <class Element>
Hull hull_of_stretch(const Instance& in, const Element& element, double low, double high) {
  const Point base = in.vertices()[element.base()];
  const auto place = [&](double parameter) {
    const Vector<double> v = element.point(parameter);
    return Vector<double>{base.x + v.x, base.y + v.y};
  };
  // An arc of up to half a circle reaches furthest from its chord's middle at its ends or at its own middle, and the diamond
  // angle's middle is close to that; a tenth more covers the difference.
  const Vector<double> p = place(low), q = place(high), m = place((low + high) / 2);
  const Vector<double> c{(p.x + q.x) / 2, (p.y + q.y) / 2};
  const double half =
      std::max(length(Vector<double>{p.x - c.x, p.y - c.y}), length(Vector<double>{m.x - c.x, m.y - c.y})) * 1.1;
  return {{Vector<double>{c.x - half, c.y - half}, {c.x + half, c.y + half}}, 2, c, half};
}

SiteTree::Region region_of(const SiteTree& tree, const Hull& hull, double radius) {
  Vector<double> low = hull.corner[0], high = low;
  for (int i = 1; i < hull.corners; ++i) {
    low = {std::min(low.x, hull.corner[i].x), std::min(low.y, hull.corner[i].y)};
    high = {std::max(high.x, hull.corner[i].x), std::max(high.y, hull.corner[i].y)};
  }
  return tree.region(hull.centre, hull.half_width, low, high, radius);
}

constexpr double contains_slack = 1e-6;

/// True if the site's cigar certainly contains the hull: no division, no root.
bool contains(const Instance& in, Index site, const Hull& hull) {
  const auto s = in.site(site);
  const Vector<double> a = at(in.vertices()[s.a]);
  const Vector<double> d = in.difference<double>(s.b, s.a);
  const double span = d.x * d.x + d.y * d.y;
  const double radius = in.site_radius(site), square = radius * radius * (1 - contains_slack);
  for (int i = 0; i < hull.corners; ++i) {
    const Vector<double> w{hull.corner[i].x - a.x, hull.corner[i].y - a.y};
    const double along = w.x * d.x + w.y * d.y;
    if (along <= 0) {
      if (!(w.x * w.x + w.y * w.y < square)) return false;
    } else if (along >= span) {
      const double x = w.x - d.x, y = w.y - d.y;
      if (!(x * x + y * y < square)) return false;
    } else {
      const double cross = w.x * d.y - w.y * d.x;
      if (!(cross * cross < square * span)) return false;
    }
  }
  return true;
}

/// Works through a block of elements in order; remembers which sites covered the last ones.
class Worker {
 public:
  Worker(const Instance& instance, const SiteTree& tree, const Context& context, kernel::Budget& budget)
      : in_(instance), tree_(tree), context_(context), budget_(budget) {
    // A hull's corners are off by a few units in the last place of the coordinates; where that is not far below the slack
    // that contains() leaves, nothing is covered "at once" and the error-bounded way decides.
    quick_ = instance.extent() * 0x1p-50 < instance.least_radius() * contains_slack * 0.01;
  }

  void run(Index first, Index last, std::vector<Piece>& out, ZoneCounters& counters) {
    std::uint64_t spent = 0;
    const auto spend = [&] {
      budget_.spend(counters.candidates - spent);
      spent = counters.candidates;
    };
    for (Index e = first; e < last; ++e) {
      if (e % group == 0 || e == first || e == in_.side_count()) {
        spend();
        if (context_.cancelled() || budget_.is_exceeded()) return;
        group_end_ = std::min(last, e - e % group + group);
        has_frontier_ = false;
      }
      if (in_.is_side(e)) {
        examine<SideElement>(e, hull_of_side(in_, e), out, counters);
      } else if (in_.sector(in_.vertex_of(e)).before != none) {
        examine<CircleElement>(e, hull_of_circle(in_, e), out, counters);
      }
    }
    spend();
  }

 private:
  static constexpr int remembered = 8;
  using Recent = std::array<std::array<Index, remembered>, 2>;
  static Recent no_sites() {
    Recent r;
    for (auto& list : r) list.fill(none);
    return r;
  }
  static constexpr Index group = 16;  // elements that share a frontier: consecutive ones are neighbours

  /// The search of all elements of the group starts from nodes within the least radius of them, that is within this and
  /// their own of their vertices.
  const SiteTree::Frontier& frontier(Index element) {
    if (has_frontier_) return frontier_;
    has_frontier_ = true;
    kernel::Box box;
    double widest = 0;
    const Index end = in_.is_side(element) ? std::min(group_end_, in_.side_count()) : group_end_;
    for (Index e = element; e < end; ++e) {
      widest = std::max(widest, in_.radius_of(e));
      if (in_.is_side(e)) {
        box.add(in_.vertices()[in_.ends(e).from]);
        box.add(in_.vertices()[in_.ends(e).to]);
      } else {
        box.add(in_.vertices()[in_.vertex_of(e)]);
      }
    }
    const Vector<double> low{box.min_x, box.min_y}, high{box.max_x, box.max_y};
    const double half_width = square_root((high.x - low.x) * (high.x - low.x) + (high.y - low.y) * (high.y - low.y)) / 2;
    frontier_ = tree_.frontier(tree_.region({(low.x + high.x) / 2, (low.y + high.y) / 2}, half_width, low, high,
                                            widest + in_.least_radius()));
    return frontier_;
  }

  /// One cigar rarely contains an element that is as long as it is wide.
  bool worth_containing(const Hull& hull) const { return quick_ && 2 * hull.half_width < in_.radius(); }

  bool covered_by_recent(Index element, const Hull& hull) {
    if (!worth_containing(hull)) return false;
    auto& recent = recent_[element & 1u];
    for (int i = 0; i < remembered; ++i) {
      if (recent[i] == none || !contains(in_, recent[i], hull)) continue;
      std::swap(recent[i], recent[0]);
      return true;
    }
    return false;
  }
  void remember(Index element, Index site) {
    auto& recent = recent_[element & 1u];
    std::rotate(recent.begin(), recent.end() - 1, recent.end());
    recent[0] = site;
  }

  template <template <class> class Element>
  void examine(Index e, const Hull& hull, std::vector<Piece>& out, ZoneCounters& counters) {
    ++counters.elements;
    if (covered_by_recent(e, hull)) {
      ++counters.covered_at_once;
      return;
    }
    const Element<double> element(in_, e);
    gaps_.start(e, element.end(), element.end_error(), element.start_label(), element.end_label());
    bool covered = false;
    double open = element.end();
    SiteTree::Region region = region_of(tree_, hull, in_.least_radius());
    tree_.visit_nearest(frontier(e), region, heap_, [&](Index site) {
      if (element.is_own(site)) return true;
      ++counters.candidates;
      if (worth_containing(hull) && contains(in_, site, hull)) {
        remember(e, site);
        return !(covered = true);
      }
      for (const Cover<double>& c : element.covered_by(site)) covered = covered || gaps_.subtract(c);
      if (covered) return false;
      const double left = gaps_.open_high() - gaps_.open_low();
      if (left < 0.7 * open && left <= Element<double>::longest_simple_stretch) {
        open = left;
        region = region_of(tree_, hull_of_stretch(in_, element, gaps_.open_low(), gaps_.open_high()), in_.least_radius());
      }
      return true;
    });
    ++counters.elements_in_double;
    if (covered) return;
    if (gaps_.find(in_, out) != Gaps<double>::Outcome::uncertain) return;
    --counters.elements_in_double;
    ++counters.elements_in_quadruple;
    examine_in_quadruple<Element>(e, out, counters);
  }

  /// The sites that certainly miss the element in double precision miss it in quadruple precision too.
  template <template <class> class Element>
  void examine_in_quadruple(Index e, std::vector<Piece>& out, ZoneCounters& counters) {
    const Element<quad> element(in_, e);
    precise_gaps_.start(e, element.end(), element.end_error(), element.start_label(), element.end_label());
    Index last = none;
    bool covered = false;
    for (const Cover<double>& c : gaps_.covers()) {
      if (c.site == none || c.site == last) continue;
      last = c.site;
      for (const Cover<quad>& q : element.covered_by(c.site)) covered = precise_gaps_.subtract(q) || covered;
    }
    if (covered) return;
    if (precise_gaps_.find(in_, out) == Gaps<quad>::Outcome::uncertain) {
      precise_gaps_.find_by_value(in_, out);
      ++counters.ties_by_perturbation;
    } else if (precise_gaps_.margin() < 64 * quad(in_.jitter())) {
      ++counters.ties_by_perturbation;
    }
  }

  const Instance& in_;
  const SiteTree& tree_;
  const Context& context_;
  kernel::Budget& budget_;
  bool quick_;
  Index group_end_ = 0;
  bool has_frontier_ = false;
  SiteTree::Frontier frontier_;
  Recent recent_ = no_sites();  // by the parity of the element: the two sides of a line are far apart
  std::vector<SiteTree::Entry> heap_;
  Gaps<double> gaps_;
  Gaps<quad> precise_gaps_;
};

void add(ZoneCounters& total, const ZoneCounters& part) {
  total.elements += part.elements;
  total.covered_at_once += part.covered_at_once;
  total.candidates += part.candidates;
  total.elements_in_double += part.elements_in_double;
  total.elements_in_quadruple += part.elements_in_quadruple;
  total.ties_by_perturbation += part.ties_by_perturbation;
}

}  // namespace

Result<std::vector<Piece>> uncovered_pieces(const Instance& instance, const SiteTree& tree, std::uint64_t most_candidates,
                                            const Context& context, ZoneCounters& counters) {
  constexpr std::size_t block = 1 << 13;
  const std::size_t n = instance.element_count();
  struct Part {
    std::span<const Piece> pieces;
    ZoneCounters counters;
  };
  kernel::Store<Piece> found;
  std::vector<Part> parts((n + block - 1) / block);
  kernel::Progress progress(context, n);
  kernel::Budget budget(most_candidates * n);
  const bool done = kernel::parallel_blocks(context, n, block, [&](std::size_t first, std::size_t last) {
    Part& part = parts[first / block];
    std::vector<Piece> pieces;
    Worker(instance, tree, context, budget).run(Index(first), Index(last), pieces, part.counters);
    part.pieces = found.keep(pieces);
    progress.add(last - first);
  });
  if (!done || context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  if (budget.is_exceeded()) {
    return Error{ErrorCode::computation,
                 "more than " + std::to_string(most_candidates) + " cigars come near an element in the mean", "",
                 "take the engine sweep, or allow more"};
  }
  std::vector<Piece> all;
  std::size_t total = 0;
  for (const Part& p : parts) total += p.pieces.size();
  kernel::reserve_pages(context, all, total);
  for (const Part& p : parts) {
    all.insert(all.end(), p.pieces.begin(), p.pieces.end());
    found.release(p.pieces);
    add(counters, p.counters);
  }
  return all;
}

}  // namespace krepl::zone
