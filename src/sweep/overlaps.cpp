#include "sweep/overlaps.hpp"

#include <algorithm>

namespace krepl::sweep {
namespace {

/// Replaces the arcs of one half of a circle.
class Splitter {
 public:
  Splitter(const std::vector<Vertex>& vertices, Predicates& predicates)
      : vertices_(vertices), predicates_(predicates) {}

  void split(std::span<const Curve> arcs, std::vector<Curve>& out) {
    ends_.clear();
    for (const Curve& c : arcs) {
      ends_.push_back({c.left, c.multiplicity});
      ends_.push_back({c.right, -c.multiplicity});
    }
    std::sort(ends_.begin(), ends_.end(), [&](const End& a, const End& b) {
      return predicates_.compare(vertices_[a.vertex], vertices_[b.vertex]) < 0;
    });
    int multiplicity = 0;
    for (std::size_t i = 0, j = 0; i < ends_.size(); i = j) {
      while (j < ends_.size() && vertices_[ends_[j].vertex].is_same(vertices_[ends_[i].vertex]))
        multiplicity += ends_[j++].change;
      if (multiplicity == 0 || j == ends_.size()) continue;
      Curve c = arcs.front();
      c.left = ends_[i].vertex, c.right = ends_[j].vertex, c.multiplicity = multiplicity;
      out.push_back(c);
    }
  }

 private:
  struct End {
    Index vertex;
    int change;
  };
  const std::vector<Vertex>& vertices_;
  Predicates& predicates_;
  std::vector<End> ends_;
};

}  // namespace

Outline overlay(std::span<const Outline> outlines, Predicates& predicates) {
  struct Arc {
    Curve curve;
    Index outline;
  };
  Outline all;
  std::vector<Arc> arcs;
  std::size_t vertices = 0, curves = 0;
  for (const Outline& o : outlines) vertices += o.vertices.size(), curves += o.curves.size();
  all.vertices.reserve(vertices);
  all.curves.reserve(curves);
  for (Index i = 0; i < outlines.size(); ++i) {
    const Index shift = Index(all.vertices.size());
    all.vertices.insert(all.vertices.end(), outlines[i].vertices.begin(), outlines[i].vertices.end());
    for (Curve c : outlines[i].curves) {
      c.left += shift, c.right += shift;
      if (predicates.geometry().is_side(c.element)) {
        all.curves.push_back(c);
      } else {
        arcs.push_back({c, i});
      }
    }
  }
  const auto is_before = [](const Arc& a, const Arc& b) {
    return a.curve.element != b.curve.element ? a.curve.element < b.curve.element : a.curve.upper < b.curve.upper;
  };
  std::stable_sort(arcs.begin(), arcs.end(), is_before);
  Splitter splitter(all.vertices, predicates);
  std::vector<Curve> same;
  for (std::size_t i = 0, j = 0; i < arcs.size(); i = j) {
    bool shared = false;
    same.clear();
    for (; j < arcs.size() && !is_before(arcs[i], arcs[j]); ++j) {
      same.push_back(arcs[j].curve);
      shared = shared || arcs[j].outline != arcs[i].outline;
    }
    if (shared) {
      splitter.split(same, all.curves);
    } else {
      all.curves.insert(all.curves.end(), same.begin(), same.end());
    }
  }
  return all;
}

}  // namespace krepl::sweep
