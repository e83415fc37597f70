#include <vector>

#include "krepl/subdivision.hpp"

namespace krepl {
namespace {

using Index = Subdivision::Index;

std::string at(const char* what, std::size_t i) { return std::string(what) + " " + std::to_string(i); }

std::optional<std::string> check_ranges(const Subdivision& s) {
  const std::size_t h = s.origin.size();
  if (h % 2 != 0) return "an odd number of half-edges";
  if (s.next.size() != h || s.face.size() != h) return "half-edge arrays of different lengths";
  if (s.face_outer.empty() || s.face_outer[0] != Subdivision::none) return "face 0 is not the unbounded one";
  if (s.face_inner_begin.size() != s.face_count() + 1 || s.face_inner_begin.back() != s.face_inner.size()) {
    return "inner loops do not match the faces";
  }
  for (std::size_t i = 0; i < h; ++i) {
    if (s.origin[i] >= s.vertex_count) return at("the origin is out of range at half-edge", i);
    if (s.next[i] >= h) return at("the next half-edge is out of range at half-edge", i);
    if (s.face[i] >= s.face_count()) return at("the face is out of range at half-edge", i);
  }
  return std::nullopt;
}

std::optional<std::string> check_next(const Subdivision& s) {
  std::vector<bool> reached(s.next.size(), false);
  for (std::size_t i = 0; i < s.next.size(); ++i) {
    const Index n = s.next[i];
    if (reached[n]) return at("two half-edges have the same next one, half-edge", n);
    reached[n] = true;
    if (s.origin[n] != s.origin[Subdivision::twin(Index(i))]) return at("a loop is broken after half-edge", i);
    if (s.face[n] != s.face[i]) return at("the face changes along a loop after half-edge", i);
  }
  return std::nullopt;
}

/// Every loop must be listed exactly once, by the face on its left.
std::optional<std::string> check_loops(const Subdivision& s) {
  std::vector<bool> seen(s.next.size(), false);
  const auto take = [&](Index h, Index f) -> std::optional<std::string> {
    if (h >= s.next.size()) return at("a loop is out of range at face", f);
    if (s.face[h] != f) return at("a loop of another face is listed at face", f);
    if (seen[h]) return at("a loop is listed twice at face", f);
    for (Index i = h; !seen[i]; i = s.next[i]) seen[i] = true;
    return std::nullopt;
  };
  for (Index f = 0; f < s.face_count(); ++f) {
    if (f != 0) {
      if (auto wrong = take(s.face_outer[f], f)) return wrong;
    }
    for (const Index h : s.inner_loops(f)) {
      if (auto wrong = take(h, f)) return wrong;
    }
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) return at("no face lists the loop of half-edge", i);
  }
  return std::nullopt;
}

/// V - E + F = 1 + C with C the number of connected components of the graph.
std::optional<std::string> check_euler(const Subdivision& s) {
  std::vector<Index> parent(s.vertex_count);
  for (Index v = 0; v < parent.size(); ++v) parent[v] = v;
  const auto find = [&](Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> used(s.vertex_count, false);
  for (Index h = 0; h < s.origin.size(); h += 2) {
    const Index a = s.origin[h], b = s.origin[h + 1];
    used[a] = used[b] = true;
    parent[find(a)] = find(b);
  }
  std::size_t components = 0;
  for (Index v = 0; v < parent.size(); ++v) {
    if (!used[v]) return at("no edge meets vertex", v);
    components += find(v) == v;
  }
  if (s.vertex_count + s.face_count() != 1 + components + s.edge_count()) {
    return "Euler's formula fails: V " + std::to_string(s.vertex_count) + ", E " + std::to_string(s.edge_count()) +
           ", F " + std::to_string(s.face_count()) + ", components " + std::to_string(components);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> Subdivision::validate() const {
  if (auto wrong = check_ranges(*this)) return wrong;
  if (auto wrong = check_next(*this)) return wrong;
  if (auto wrong = check_loops(*this)) return wrong;
  return check_euler(*this);
}

}  // namespace krepl
