#include "sweep/paths.hpp"

#include <algorithm>
#include <numeric>

namespace krepl::sweep {
namespace {

/// Sides by the vertex that their segment starts at.
struct Fans {
  explicit Fans(const Instance& in) : begin(in.vertices().size() + 1, 0), side(in.side_count()) {
    for (Index e = 0; e < in.side_count(); ++e) ++begin[in.ends(e).from + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Index> place(begin.begin(), begin.end() - 1);
    for (Index e = 0; e < in.side_count(); ++e) side[place[in.ends(e).from]++] = e;
  }
  Index degree(Index vertex) const { return begin[vertex + 1] - begin[vertex]; }
  std::vector<Index> begin, side;
};

class Walker {
 public:
  Walker(const Instance& in, Index longest)
      : in_(in), fans_(in), longest_(longest), used_(in.side_count() / 2, false) {}

  Paths walk() {
    // Lines first, from the ends of them; what is left are circles without an end.
    for (Index v = 0; v < in_.vertices().size(); ++v) {
      if (fans_.degree(v) == 2) continue;
      for (Index i = fans_.begin[v]; i < fans_.begin[v + 1]; ++i) follow(fans_.side[i]);
    }
    for (Index s = 0; s < used_.size(); ++s) follow(2 * s);
    for (Index i = Index(used_.size()); i < in_.site_count(); ++i) {
      paths_.step.push_back(in_.circle(in_.site(i).a));
      close();
    }
    return std::move(paths_);
  }

 private:
  void follow(Index side) {
    if (used_[side >> 1]) return;
    Index start = in_.ends(side).from, length = 0;
    for (;;) {
      used_[side >> 1] = true;
      paths_.step.push_back(side);
      ++length;
      const Index v = in_.ends(side).to;
      if (fans_.degree(v) != 2) break;
      const Index first = fans_.side[fans_.begin[v]], second = fans_.side[fans_.begin[v] + 1];
      side = first == (side ^ 1u) ? second : first;
      if (used_[side >> 1]) break;
      if (length == longest_ || in_.ends(side).to == start) {  // a path that closes would come through a vertex twice
        close();
        start = v;
        length = 0;
      }
    }
    close();
  }
  void close() {
    if (paths_.step.size() > paths_.begin.back()) paths_.begin.push_back(Index(paths_.step.size()));
  }

  const Instance& in_;
  const Fans fans_;
  Index longest_;
  std::vector<bool> used_;
  Paths paths_;
};

/// Vertices of the network stand along a Hilbert curve.
Paths along_the_curve(const Instance& in, const Paths& paths) {
  std::vector<std::pair<Index, Index>> order(paths.count());
  for (Index p = 0; p < paths.count(); ++p) {
    const Index middle = paths.step[(paths.begin[p] + paths.begin[p + 1]) / 2];
    order[p] = {in.is_side(middle) ? in.ends(middle).from : in.vertex_of(middle), p};
  }
  std::sort(order.begin(), order.end());
  Paths sorted;
  sorted.step.reserve(paths.step.size());
  for (const auto& [vertex, p] : order) {
    sorted.step.insert(sorted.step.end(), paths.step.begin() + paths.begin[p], paths.step.begin() + paths.begin[p + 1]);
    sorted.begin.push_back(Index(sorted.step.size()));
  }
  return sorted;
}

class Tracer {
 public:
  explicit Tracer(Predicates& predicates) : predicates_(predicates), geometry_(predicates.geometry()) {}

  Outline circle(Index element) {
    const Index left = add(predicates_.on_circle(element, Vertex::leftmost));
    const Index right = add(predicates_.on_circle(element, Vertex::rightmost));
    outline_.curves.push_back({element, left, right, false, true, 1});
    outline_.curves.push_back({element, left, right, true, false, 1});
    return std::move(outline_);
  }

  /// All around: the right sides forward, the left sides back.
  Outline around(const Index* step, Index count) {
    sides_.assign(step, step + count);
    for (Index i = count; i-- > 0;) sides_.push_back(step[i] ^ 1u);
    decide_cuts();
    const Index n = Index(sides_.size());
    std::vector<Index> start(n), end(n);
    for (Index i = 0; i < n; ++i) {
      const Index j = i + 1 < n ? i + 1 : 0;
      const Index circle = geometry_.instance().circle(geometry_.instance().ends(sides_[i]).to);
      if (cut_[i]) {
        end[i] = start[j] = add(predicates_.vertex(sides_[i], sides_[j]));
        continue;
      }
      end[i] = add(touching(sides_[i], circle, sides_[i]));
      start[j] = add(touching(circle, sides_[j], sides_[j]));
      if (is_convex(i, j)) {
        add_arc(circle, end[i], sides_[i], start[j], sides_[j], 1);
      } else {
        add_arc(circle, start[j], sides_[j], end[i], sides_[i], -1);
      }
    }
    for (Index i = 0; i < n; ++i) {
      const bool right = rightward(sides_[i]);
      outline_.curves.push_back({sides_[i], right ? start[i] : end[i], right ? end[i] : start[i], false, right, 1});
    }
    return std::move(outline_);
  }

 private:
  Index add(const Vertex& v) {
    outline_.vertices.push_back(v);
    return Index(outline_.vertices.size() - 1);
  }
  /// Of one segment only: its other side runs the other way.
  bool rightward(Index side) {
    if (known_ != side >> 1) {
      known_ = side >> 1;
      known_rightward_ = predicates_.runs_rightward(side & ~1u);
    }
    return known_rightward_ == ((side & 1u) == 0);
  }
  /// Where a side touches a circle, outwards of it: on the upper half if the side runs leftward.
  Vertex touching(Index from, Index to, Index side) {
    Vertex v = predicates_.touching(from, to);
    (from == side ? v.to_upper : v.from_upper) = !rightward(side);
    return v;
  }
  bool is_convex(Index i, Index j) const {
    if (sides_[j] == (sides_[i] ^ 1u)) return true;
    const Instance& in = geometry_.instance();
    const auto e = in.ends(sides_[i]), f = in.ends(sides_[j]);
    return in.turns_left(e.to, f.to, e.from);
  }

  /// Concave corners whose sides certainly cross, so that their ends and the arc between them can be left out: that
  /// takes away a loop that is covered twice or more. It is no matter if some are not seen.
  void decide_cuts() {
    const Index n = Index(sides_.size());
    cut_.assign(n, false);
    double taken = 0;  // of side i, at its start
    for (Index i = 0; i + 1 < n; ++i) {
      const Index e = sides_[i], f = sides_[i + 1];
      double at_end = 0;
      if (!is_convex(i, i + 1)) {
        const auto p = geometry_.line<double>(e), q = geometry_.line<double>(f);
        const double sine = -cross(p.direction, q.direction), cosine = dot(p.direction, q.direction);
        // Segments as short as the move of vertices lets turn far may cut off more than is seen.
        const double tangent = (std::max(sine, 0.0) + 2 * (p.direction_error + q.direction_error)) / (1 + cosine);
        const double t = geometry_.radius<double>() * tangent;
        constexpr double most = 0.999;
        cut_[i] = cosine > -0.9 && t + taken < most * geometry_.span(e) && t < most * geometry_.span(f);
        at_end = cut_[i] ? t : 0;
      }
      taken = at_end;
    }
  }

  /// Counter-clockwise from where one side touches it to where another one does, at most half of the circle.
  void add_arc(Index circle, Index start, Index start_side, Index end, Index end_side, int multiplicity) {
    const bool start_upper = !rightward(start_side), end_upper = !rightward(end_side);
    auto& curves = outline_.curves;
    if (start_upper && end_upper) {
      curves.push_back({circle, end, start, true, false, multiplicity});
    } else if (!start_upper && !end_upper) {
      curves.push_back({circle, start, end, false, true, multiplicity});
    } else {
      const Index extreme = add(predicates_.on_circle(circle, start_upper ? Vertex::leftmost : Vertex::rightmost));
      if (start_upper) {
        curves.push_back({circle, extreme, start, true, false, multiplicity});
        curves.push_back({circle, extreme, end, false, true, multiplicity});
      } else {
        curves.push_back({circle, start, extreme, false, true, multiplicity});
        curves.push_back({circle, end, extreme, true, false, multiplicity});
      }
    }
  }

  Predicates& predicates_;
  const Geometry& geometry_;
  std::vector<Index> sides_;
  std::vector<char> cut_;  // corner i, between sides i and i + 1
  Index known_ = none;
  bool known_rightward_ = false;
  Outline outline_;
};

}  // namespace

Paths take_apart(const Instance& instance, Index longest) {
  return along_the_curve(instance, Walker(instance, longest).walk());
}

Outline outline_of_path(const Paths& paths, Index path, Predicates& predicates) {
  const Index* step = paths.step.data() + paths.begin[path];
  Tracer tracer(predicates);
  return predicates.geometry().is_side(*step) ? tracer.around(step, paths.begin[path + 1] - paths.begin[path])
                                              : tracer.circle(*step);
}

}  // namespace krepl::sweep
