#include "sweep/plane_sweep.hpp"

#include <algorithm>
#include <boost/intrusive/set.hpp>
#include <optional>
#include <string>

namespace krepl::sweep {
namespace {

/// A curve while the sweep line cuts it.
struct Node : boost::intrusive::set_base_hook<boost::intrusive::link_mode<boost::intrusive::normal_link>> {
  Index curve = none;
  Index left = none;         ///< the vertex from which on nothing has changed
  int below = 0;             ///< how often the place below is covered
  bool cut = false;          ///< by the sweep line
  double low = 0, high = 0;  ///< its range of y, with errors
  friend bool operator<(const Node& a, const Node& b) { return a.curve < b.curve; }
};
/// From below to above; the order is given by where nodes are put, never by comparing them.
using Status = boost::intrusive::multiset<Node>;

struct End {
  Index vertex, curve;
  bool starts;
};
struct Crossing {
  Index vertex, below, above;
};

class Sweep {
 public:
  Sweep(Outline outline, std::uint64_t most, Predicates& predicates, const Context& context)
      : vertices_(std::move(outline.vertices)),
        curves_(std::move(outline.curves)),
        nodes_(curves_.size()),
        most_(most),
        predicates_(predicates),
        context_(context) {}
  ~Sweep() { status_.clear(); }

  Result<std::optional<Outline>> run() {
    prepare();
    std::size_t next = 0, steps = 0;
    while (next < ends_.size() || !crossings_.empty()) {
      if (++steps % 4096 == 0 && context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
      if (found_ > most_) return std::optional<Outline>();
      const bool end_is_next =
          crossings_.empty() || (next < ends_.size() && compare(ends_[next].vertex, crossings_.front().vertex) <= 0);
      bool sound;
      Index at;
      if (end_is_next) {
        std::size_t last = next + 1;
        while (last < ends_.size() && vertices_[ends_[last].vertex].is_same(vertices_[ends_[next].vertex])) ++last;
        at = ends_[next].vertex;
        sound = pass_ends(next, last);
        next = last;
      } else {
        const Crossing c = pop();
        at = c.vertex;
        sound = pass_crossing(c);
      }
      if (!sound) return contradiction(at);
    }
    predicates_.counters.crossings += found_;
    return std::optional<Outline>(collect());
  }

 private:
  int compare(Index p, Index q) { return predicates_.compare(vertices_[p], vertices_[q]); }
  bool later(const Crossing& a, const Crossing& b) { return compare(a.vertex, b.vertex) > 0; }

  void prepare() {
    predicates_.counters.curves += curves_.size();
    ends_.reserve(2 * curves_.size());
    const Geometry& g = predicates_.geometry();
    const double r = g.radius<double>(), slack = 4 * g.coarse() + r * 1e-12;
    for (Index i = 0; i < curves_.size(); ++i) {
      const Curve& c = curves_[i];
      ends_.push_back({c.left, i, true});
      ends_.push_back({c.right, i, false});
      const Vertex &p = vertices_[c.left], &q = vertices_[c.right];
      Node& n = nodes_[i];
      n.curve = i;
      n.low = std::min(p.y - p.error, q.y - q.error) - slack;
      n.high = std::max(p.y + p.error, q.y + q.error) + slack;
      if (g.is_side(c.element)) continue;
      const Vector<double> centre = g.position<double>(g.vertex_of(c.element));
      const bool over_centre = p.x - p.error - slack < centre.x && q.x + q.error + slack > centre.x;
      if (over_centre && c.upper) n.high = centre.y + r + slack;
      if (over_centre && !c.upper) n.low = centre.y - r - slack;
    }
    std::sort(ends_.begin(), ends_.end(), [&](const End& a, const End& b) {
      const int order = compare(a.vertex, b.vertex);
      return order != 0 ? order < 0 : a.curve < b.curve;
    });
  }

  Crossing pop() {
    std::pop_heap(crossings_.begin(), crossings_.end(),
                  [&](const Crossing& a, const Crossing& b) { return later(a, b); });
    const Crossing c = crossings_.back();
    crossings_.pop_back();
    return c;
  }

  int above(const Node& n) const { return n.below + curves_[n.curve].rise(); }

  /// What ends at the vertex makes room for what starts there; where nothing ends, a search finds the place.
  bool pass_ends(std::size_t first, std::size_t last) {
    const Index at = ends_[first].vertex;
    ending_.clear();
    starting_.clear();
    for (std::size_t i = first; i < last; ++i) (ends_[i].starts ? starting_ : ending_).push_back(ends_[i].curve);
    Status::iterator place;
    if (!ending_.empty()) {
      if (!close(at, place)) return false;
    } else {
      place = status_.lower_bound(
          vertices_[at], [&](const Node& n, const Vertex& v) { return predicates_.locate(v, curves_[n.curve]) > 0; });
    }
    return open(at, place);
  }

  /// Takes out the curves that end; false if they are not neighbours.
  bool close(Index at, Status::iterator& place) {
    for (const Index c : ending_) {
      if (!nodes_[c].cut || !emit(nodes_[c], at)) return false;
      nodes_[c].cut = false;
    }
    place = status_.end();
    for (const Index c : ending_) {
      const auto here = status_.iterator_to(nodes_[c]);
      if (here != status_.begin() && !std::prev(here)->cut) continue;
      if (place != status_.end()) return false;
      place = here;
    }
    for (std::size_t i = 0; i < ending_.size(); ++i) {
      if (place == status_.end() || place->cut) return false;
      place = status_.erase(place);
    }
    return true;
  }

  /// Puts in the curves that start, from below to above.
  bool open(Index at, Status::iterator place) {
    if (starting_.size() > 2) return false;
    if (starting_.size() == 2 && !is_below(starting_[0], starting_[1], vertices_[at]))
      std::swap(starting_[0], starting_[1]);
    int cover = place == status_.begin() ? 0 : above(*std::prev(place));
    for (const Index c : starting_) {
      Node& n = nodes_[c];
      n.left = at;
      n.below = cover;
      n.cut = true;
      cover = above(n);
      status_.insert_before(place, n);
    }
    if (cover < 0 || cover != (place == status_.end() ? 0 : place->below)) return false;
    Status::iterator i = place;
    for (std::size_t pairs = 0; pairs <= starting_.size(); ++pairs, --i) {
      if (i == status_.begin()) break;
      if (i != status_.end()) find_crossing(*std::prev(i), *i, at);
    }
    return true;
  }

  /// Of two curves that start at the same vertex: the names of its elements tell.
  bool is_below(Index c, Index d, const Vertex& v) const {
    const Curve &p = curves_[c], &q = curves_[d];
    if (v.is_extreme()) return !p.upper;
    const Curve &from = p.element == v.from ? p : q, &to = p.element == v.from ? q : p;
    const bool is_side = predicates_.geometry().is_side(from.element),
               is_other = predicates_.geometry().is_side(to.element);
    bool from_is_above;
    if (is_side != is_other && !predicates_.geometry().may_cross(v.from, v.to)) {
      // They touch, and the circle is where the side's segment is.
      const Curve& side = is_side ? from : to;
      from_is_above = side.rightward == !is_side;
    } else {
      from_is_above = from.rightward == to.rightward;  // `from` runs into the inside of `to`
    }
    return from_is_above == (&to == &p);
  }

  /// The next event is the crossing of two neighbours: they change places.
  bool pass_crossing(const Crossing& c) {
    Node &lower = nodes_[c.below], &upper = nodes_[c.above];
    if (!lower.cut || !upper.cut) return true;
    const auto place = status_.iterator_to(lower);
    if (std::next(place) == status_.end() || &*std::next(place) != &upper) return true;  // seen before
    ++found_;
    if (!emit(lower, c.vertex) || !emit(upper, c.vertex)) return false;
    status_.erase(status_.iterator_to(upper));
    status_.insert_before(place, upper);
    upper.below = lower.below;
    lower.below = above(upper);
    lower.left = upper.left = c.vertex;
    if (upper.below < 0 || lower.below < 0) return false;
    const auto first = status_.iterator_to(upper);
    if (first != status_.begin()) find_crossing(*std::prev(first), upper, c.vertex);
    find_crossing(upper, lower, c.vertex);
    if (std::next(place) != status_.end()) find_crossing(lower, *std::next(place), c.vertex);
    return true;
  }

  /// Writes the stretch of a curve up to here, if it is boundary; false if its inside is covered less than its outside.
  bool emit(Node& n, Index right) {
    const bool inside_below = n.below != 0, inside_above = above(n) != 0;
    if (inside_below == inside_above) return true;
    Curve c = curves_[n.curve];
    if (c.multiplicity < 1 || c.rightward != inside_above) return false;
    c.multiplicity = 1;
    c.left = n.left;
    c.right = right;
    boundary_.push_back(c);
    return true;
  }

  /// The one crossing at which the lower curve may come out above the upper one, if it is still ahead.
  void find_crossing(const Node& lower, const Node& upper, Index at) {
    if (lower.high < upper.low) return;
    const Curve &a = curves_[lower.curve], &b = curves_[upper.curve];
    // There the lower one is the steeper one, so the sense of both tells which of them runs into the other's inside.
    const bool a_is_from = a.rightward == b.rightward;
    const Index from = a_is_from ? a.element : b.element, to = a_is_from ? b.element : a.element;
    const auto is_end = [&](Index v) { return vertices_[v].from == from && vertices_[v].to == to; };
    if (is_end(a.right) || is_end(b.right) || !predicates_.crosses(from, to)) return;
    const Vertex v = predicates_.vertex(from, to);
    const Geometry& g = predicates_.geometry();
    if (!g.is_side(from) && v.from_upper != (a_is_from ? a : b).upper) return;
    if (!g.is_side(to) && v.to_upper != (a_is_from ? b : a).upper) return;
    if (predicates_.compare(v, vertices_[at]) <= 0) return;
    if (predicates_.compare(v, vertices_[a.right]) >= 0 || predicates_.compare(v, vertices_[b.right]) >= 0) return;
    vertices_.push_back(v);
    crossings_.push_back({Index(vertices_.size() - 1), lower.curve, upper.curve});
    std::push_heap(crossings_.begin(), crossings_.end(),
                   [&](const Crossing& c, const Crossing& d) { return later(c, d); });
  }

  Outline collect() {
    Outline out;
    out.curves = std::move(boundary_);
    std::vector<Index> place(vertices_.size(), none);
    const auto keep = [&](Index& v) {
      if (place[v] == none) {
        place[v] = Index(out.vertices.size());
        out.vertices.push_back(vertices_[v]);
      }
      v = place[v];
    };
    for (Curve& c : out.curves) keep(c.left), keep(c.right);
    return out;
  }

  Error contradiction(Index at) const {
    const Vertex& v = vertices_[at];
    const double x = (20 * v.x - 21 * v.y) * 32 / 841,
                 y = (21 * v.x + 20 * v.y) * 32 / 841;  // out of the sweep's frame
    return {ErrorCode::computation, "the sweep could not be certified",
            "near x " + std::to_string(x) + ", y " + std::to_string(y) + " relative to the data's origin",
            "please report this input; --engine intervals needs no sweep"};
  }

  std::vector<Vertex> vertices_;
  std::vector<Curve> curves_;
  std::vector<Node> nodes_;
  Status status_;
  std::vector<End> ends_;
  std::vector<Crossing> crossings_;  // a heap
  std::vector<Index> ending_, starting_;
  std::vector<Curve> boundary_;
  std::uint64_t found_ = 0;
  std::uint64_t most_;
  Predicates& predicates_;
  const Context& context_;
};

}  // namespace

Result<std::optional<Outline>> sweep(Outline outline, std::uint64_t most, Predicates& predicates,
                                     const Context& context) {
  return Sweep(std::move(outline), most, predicates, context).run();
}

}  // namespace krepl::sweep
