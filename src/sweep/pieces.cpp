#include "sweep/pieces.hpp"

#include <algorithm>
#include <array>
#include <tuple>

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

/// The arcs of one circle.
class Joiner {
 public:
  Joiner(Index circle, std::vector<zone::Piece>& out) : circle_(circle), out_(out) {}

  void add(const Run& run) {
    if (run.start->is_extreme())
      after_[side_of(*run.start)] = run;
    else
      runs_.push_back(run);
  }
  void finish() {
    for (const Run& run : runs_) {
      const Vertex* end = run.end;
      for (int extremes = 0; end->is_extreme() && extremes < 2; ++extremes) {
        const Run& next = after_[side_of(*end)];
        if (next.start == nullptr) break;
        end = next.end;
      }
      out_.push_back({circle_, run.start->from, end->to});
    }
    if (runs_.empty()) out_.push_back({circle_, circle_, circle_});  // all around
  }

 private:
  static int side_of(const Vertex& v) { return v.to == Vertex::leftmost ? 0 : 1; }
  Index circle_;
  std::vector<zone::Piece>& out_;
  std::vector<Run> runs_;
  std::array<Run, 2> after_{};  // that start at the leftmost point, at the rightmost one
};

}  // namespace

std::vector<zone::Piece> pieces_of(const Outline& boundary, const Geometry& geometry) {
  std::vector<zone::Piece> pieces;
  pieces.reserve(boundary.curves.size());
  std::vector<const Curve*> arcs;
  for (const Curve& c : boundary.curves) {
    if (geometry.is_side(c.element)) {
      const Run run = run_of(boundary, c);
      pieces.push_back({c.element, run.start->from, run.end->to});
    } else {
      arcs.push_back(&c);
    }
  }
  std::stable_sort(arcs.begin(), arcs.end(), [](const Curve* a, const Curve* b) { return a->element < b->element; });
  for (std::size_t i = 0, j = 0; i < arcs.size(); i = j) {
    Joiner joiner(arcs[i]->element, pieces);
    for (; j < arcs.size() && arcs[j]->element == arcs[i]->element; ++j) joiner.add(run_of(boundary, *arcs[j]));
    joiner.finish();
  }
  std::sort(pieces.begin(), pieces.end(), [](const zone::Piece& a, const zone::Piece& b) {
    return std::tie(a.element, a.from, a.to) < std::tie(b.element, b.from, b.to);
  });
  return pieces;
}

}  // namespace krepl::sweep
