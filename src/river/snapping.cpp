// Free ends of lines to other lines near them: what digitising leaves between a tributary's mouth and its river.
#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"
#include "model/segment_tree.hpp"
#include "river/lines.hpp"

namespace krepl::river {
namespace {

constexpr Index none = ~Index{0};

using vectors::distance;

class Snapping {
 public:
  Snapping(Lines& lines, double reach, RiverReport& report)
      : lines_(lines),
        reach_(reach),
        report_(report),
        tree_(lines.vertices, segments()),
        moved_to_(lines.vertices.size(), none) {
    count_neighbours();
    measure();
    target_.resize(lines.vertices.size(), false);
  }

  bool run(const Context& context) {
    for (std::size_t line = 0; line < lines_.line_count(); ++line) {
      if (context.cancelled()) return false;
      const std::size_t first = lines_.begin[line], last = lines_.begin[line + 1] - 1;
      if (lines_.chain[first] == lines_.chain[last]) continue;
      for (std::size_t at : {first, last}) snap(line, at);
    }
    rewrite();
    return true;
  }

 private:
  /// A point of the inside of a segment that an end was moved to.
  struct Insertion {
    std::size_t position;  // in the chain, of the segment's first vertex
    double parameter;
    Index vertex;
  };

  std::vector<model::GridSegment> segments() {
    std::vector<model::GridSegment> result;
    for (std::size_t line = 0; line < lines_.line_count(); ++line) {
      for (std::size_t i = lines_.begin[line]; i + 1 < lines_.begin[line + 1]; ++i) {
        result.push_back({lines_.chain[i], lines_.chain[i + 1]});
        position_.push_back(i);
        line_.push_back(line);
      }
    }
    return result;
  }

  /// A vertex is a free end if all segments at it lead to one neighbour.
  void count_neighbours() {
    neighbour_.resize(lines_.vertices.size(), none);
    several_.resize(lines_.vertices.size(), false);
    const auto meet = [&](Index v, Index w) {
      if (neighbour_[v] == none)
        neighbour_[v] = w;
      else if (neighbour_[v] != w)
        several_[v] = true;
    };
    for (std::size_t position : position_) {
      const Index a = lines_.chain[position], b = lines_.chain[position + 1];
      meet(a, b);
      meet(b, a);
    }
  }

  void measure() {
    way_.resize(lines_.chain.size(), 0);
    for (std::size_t position : position_) {
      way_[position + 1] =
          way_[position] + distance(lines_.place(lines_.chain[position]), lines_.place(lines_.chain[position + 1]));
    }
  }

  Index now(Index v) const {
    while (moved_to_[v] != none) v = moved_to_[v];
    return v;
  }

  /// An end's own line counts only where the way along it is longer than the step across; else every end would do.
  bool is_own(std::size_t line, std::size_t at, std::size_t segment) const {
    if (line_[segment] != line) return false;
    const std::size_t position = position_[segment];
    return std::min(std::abs(way_[position] - way_[at]), std::abs(way_[position + 1] - way_[at])) <= 2 * reach_;
  }

  void snap(std::size_t line, std::size_t at) {
    const Index end = lines_.chain[at];
    if (several_[end] || target_[end] || moved_to_[end] != none) return;
    const Point p = lines_.place(end);
    Index vertex = none;
    double vertex_distance = reach_, line_distance = reach_, parameter = 0;
    std::size_t segment = position_.size();
    const double reach = reach_ / lines_.pitch * (1 + 1e-12), x = double(lines_.vertices[end].x),
                 y = double(lines_.vertices[end].y);
    bool joined = false;
    tree_.tree().visit_meeting({x - reach, y - reach, x + reach, y + reach}, [&](std::size_t place) {
      const std::size_t s = tree_.segment(place);
      const Index a = now(lines_.chain[position_[s]]), b = now(lines_.chain[position_[s] + 1]);
      // What is repeated in another line is not another line.
      if (is_own(line, at, s) || a == end || b == end || a == b) return;
      const Point q = lines_.place(a), r = lines_.place(b);
      for (Index v : {a, b}) {
        const double d = distance(p, lines_.place(v));
        if (d <= vertex_distance && (d < vertex_distance || vertex == none) && v != neighbour_[end])
          vertex = v, vertex_distance = d;
      }
      const double dx = r.x - q.x, dy = r.y - q.y;
      const double t = ((p.x - q.x) * dx + (p.y - q.y) * dy) / (dx * dx + dy * dy);
      if (!(t > 0 && t < 1)) return;
      const double d = std::abs((p.x - q.x) * dy - (p.y - q.y) * dx) / std::hypot(dx, dy);
      joined |= d <= lines_.pitch / 2;
      if (d < line_distance) segment = s, line_distance = d, parameter = t;
    });
    if (joined) return;  // the cutting of lines takes care of it
    if (vertex != none)
      to_vertex(end, vertex);
    else if (segment < position_.size())
      to_line(end, segment, parameter);
  }

  void to_vertex(Index end, Index vertex) {
    note_move(end, lines_.place(vertex));
    ++report_.ends_to_vertices;
    moved_to_[end] = vertex;
    target_[vertex] = true;
  }

  void to_line(Index end, std::size_t segment, double t) {
    const std::size_t position = position_[segment];
    const Point q = lines_.place(now(lines_.chain[position])), r = lines_.place(now(lines_.chain[position + 1]));
    const Point foot{q.x + t * (r.x - q.x), q.y + t * (r.y - q.y)};
    const GridPoint on_grid{std::llround(foot.x / lines_.pitch), std::llround(foot.y / lines_.pitch)};
    const auto vertex = Index(lines_.vertices.size());
    lines_.vertices.push_back(on_grid);
    neighbour_.push_back(none);
    several_.push_back(true);
    target_.push_back(true);
    moved_to_.push_back(none);
    note_move(end, lines_.place(vertex));
    ++report_.ends_to_lines;
    moved_to_[end] = vertex;
    insertions_.push_back({position, t, vertex});
  }

  void note_move(Index end, Point to) {
    report_.largest_move = std::max(report_.largest_move, distance(lines_.place(end), to));
  }

  /// New chains: moved ends under their new numbers, inserted vertices between the others. Vertices that came to lie on
  /// the same grid point are one again.
  void rewrite() {
    if (report_.ends_to_vertices + report_.ends_to_lines == 0) return;
    std::sort(insertions_.begin(), insertions_.end(), [](const Insertion& i, const Insertion& j) {
      return i.position != j.position ? i.position < j.position : i.parameter < j.parameter;
    });
    std::vector<Index> order(lines_.vertices.size());
    for (Index v = 0; v < order.size(); ++v) order[v] = v;
    std::stable_sort(order.begin(), order.end(),
                     [&](Index v, Index w) { return lines_.vertices[v] < lines_.vertices[w]; });
    std::vector<Index> number(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool again = i > 0 && lines_.vertices[order[i]] == lines_.vertices[order[i - 1]];
      number[order[i]] = again ? number[order[i - 1]] : order[i];
    }
    Lines next;
    next.pitch = lines_.pitch;
    auto insertion = insertions_.begin();
    for (std::size_t line = 0; line < lines_.line_count(); ++line) {
      const std::size_t first = next.chain.size();
      const auto add = [&](Index v) {
        v = number[now(v)];
        if (next.chain.size() == first || next.chain.back() != v) next.chain.push_back(v);
      };
      for (std::size_t i = lines_.begin[line]; i < lines_.begin[line + 1]; ++i) {
        add(lines_.chain[i]);
        for (; insertion != insertions_.end() && insertion->position == i; ++insertion) add(insertion->vertex);
      }
      if (next.chain.size() - first < 2) {
        next.chain.resize(first);
        continue;
      }
      next.begin.push_back(next.chain.size());
      next.feature.push_back(lines_.feature[line]);
    }
    next.vertices = std::move(lines_.vertices);
    lines_ = std::move(next);
  }

  Lines& lines_;
  const double reach_;
  RiverReport& report_;
  std::vector<std::size_t> position_, line_;  // per segment: of its first vertex in the chain; its line
  const model::SegmentTree tree_;
  std::vector<Index> moved_to_, neighbour_;
  std::vector<bool> several_, target_;
  std::vector<double> way_;  // per place in the chain: length of its line up to there
  std::vector<Insertion> insertions_;
};

}  // namespace

bool snap_ends(Lines& lines, double reach, RiverReport& report, const Context& context) {
  return reach <= 0 || Snapping(lines, reach, report).run(context);
}

}  // namespace krepl::river
