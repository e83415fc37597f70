#include "sweep/pieces.hpp"

#include <algorithm>
#include <array>

namespace krepl::sweep {
namespace {

/// A curve as the boundary runs: counter-clockwise on circles.
struct Run {
  const Vertex *start, *end;
};

Run run_of(const Outline& boundary, const Curve& c) {
  const Vertex &left = boundary.vertices[c.left], &right = boundary.vertices[c.right];
  return c.rightward ? Run{&left, &right} : Run{&right, &left};
}

/// The pieces of one element.
class Element {
 public:
  Element(Index element, Predicates& predicates, std::vector<zone::Piece>& out)
      : element_(element), predicates_(predicates), out_(out) {}

  void add(const Run& run) {
    if (run.start->is_extreme()) {
      after_[side_of(*run.start)] = run;
    } else {
      runs_.push_back(run);
    }
  }

  void finish(bool rightward) {
    const Geometry& g = predicates_.geometry();
    if (g.is_side(element_)) {
      std::sort(runs_.begin(), runs_.end(), [&](const Run& a, const Run& b) {
        return predicates_.compare(*a.start, *b.start) == (rightward ? -1 : 1);
      });
    } else {
      if (runs_.empty()) return out_.push_back({element_, element_, element_});  // all around
      for (Run& run : runs_) run.end = end_of(run);
      if (sort_around()) return;
    }
    for (const Run& run : runs_) out_.push_back({element_, run.start->from, run.end->to});
  }

 private:
  static int side_of(const Vertex& v) { return v.to == Vertex::leftmost ? 0 : 1; }

  const Vertex* end_of(const Run& run) const {
    const Vertex* end = run.end;
    for (int extremes = 0; end->is_extreme() && extremes < 2; ++extremes) {
      const Run& next = after_[side_of(*end)];
      if (next.start == nullptr) break;
      end = next.end;
    }
    return end;
  }

  /// Counter-clockwise from where the circle's visible sector starts. A piece about an isolated vertex is cut there:
  /// then all is written, and the answer is true.
  bool sort_around() {
    const Geometry& g = predicates_.geometry();
    const Index before = g.instance().sector(g.vertex_of(element_)).before;
    if (before == none) return false;  // wrong, and it will not link
    const bool isolated = before == element_;
    Place first{isolated ? predicates_.on_circle(element_, Vertex::start) : predicates_.touching(before, element_),
                false};
    if (!isolated) first.upper = !predicates_.runs_rightward(before);
    const auto is_before = [&](const Place& a, const Place& b) {
      const bool a_wraps = is_before_on_halves(a, first), b_wraps = is_before_on_halves(b, first);
      return a_wraps != b_wraps ? b_wraps : is_before_on_halves(a, b);
    };
    std::sort(runs_.begin(), runs_.end(),
              [&](const Run& a, const Run& b) { return is_before(start_of(a), start_of(b)); });
    const Run& last = runs_.back();
    if (!isolated || !is_before({*last.end, last.end->from_upper}, start_of(last))) return false;
    out_.push_back({element_, element_, last.end->to});
    for (const Run& run : runs_) out_.push_back({element_, run.start->from, &run == &last ? element_ : run.end->to});
    return true;
  }

  struct Place {
    Vertex vertex;
    bool upper;
  };
  static Place start_of(const Run& run) { return {*run.start, run.start->to_upper}; }
  /// Counter-clockwise from the leftmost point.
  bool is_before_on_halves(const Place& a, const Place& b) {
    return a.upper != b.upper ? b.upper : predicates_.compare(a.vertex, b.vertex) == (a.upper ? 1 : -1);
  }

  Index element_;
  Predicates& predicates_;
  std::vector<zone::Piece>& out_;
  std::vector<Run> runs_;
  std::array<Run, 2> after_{};  // that start at the leftmost point, at the rightmost one
};

}  // namespace

std::vector<zone::Piece> pieces_of(const Outline& boundary, Predicates& predicates) {
  std::vector<const Curve*> curves;
  curves.reserve(boundary.curves.size());
  for (const Curve& c : boundary.curves) curves.push_back(&c);
  std::stable_sort(curves.begin(), curves.end(),
                   [](const Curve* a, const Curve* b) { return a->element < b->element; });
  std::vector<zone::Piece> pieces;
  pieces.reserve(curves.size());
  for (std::size_t i = 0, j = 0; i < curves.size(); i = j) {
    Element element(curves[i]->element, predicates, pieces);
    for (; j < curves.size() && curves[j]->element == curves[i]->element; ++j)
      element.add(run_of(boundary, *curves[j]));
    element.finish(curves[i]->rightward);
  }
  return pieces;
}

}  // namespace krepl::sweep
