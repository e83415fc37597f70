#pragma once

#include <vector>

#include "sweep/predicates.hpp"

namespace krepl::sweep {

/// The network taken apart into paths that come through no vertex twice: what the thesis calls sub-rivers, cut where
/// lines meet. Path p is the sides step[begin[p]] .. step[begin[p + 1]), each on the right of its segment as the path
/// runs; an isolated vertex is the circle about it.
struct Paths {
  std::vector<Index> begin{0}, step;
  Index count() const { return Index(begin.size() - 1); }
};

/// Paths of at most `longest` segments; neighbours in the plane have nearby numbers. O(n).
Paths take_apart(const Instance& instance, Index longest);

/// The boundary of the path's cigars, laid over each other so that a place is covered once for each connected part of
/// the path within R of it, or less, but at least once if there is any: sides, and the arcs of vertices, those on the
/// inner side of a bend with multiplicity -1. Neighbouring sides that cross at a bend are cut there (the thesis's
/// clean-up).
Outline outline_of_path(const Paths& paths, Index path, Predicates& predicates);

}  // namespace krepl::sweep
