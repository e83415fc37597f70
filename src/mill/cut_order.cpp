#include "mill/cut_order.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::mill {
namespace {

constexpr std::size_t most_looked_at = 4000;

double off(Point3 a, Point3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

bool is_closed(const Cut& cut) { return cut.moves.size() > 2 && cut.end() == cut.start; }

void start_near(Cut& cut, Point3 at) {
  std::size_t best = cut.moves.size() - 1;
  for (std::size_t k = 0; k < cut.moves.size(); ++k)
    if (off(cut.moves[k].end, at) < off(cut.moves[best].end, at)) best = k;
  cut.start = cut.moves[best].end;
  std::rotate(cut.moves.begin(), cut.moves.begin() + std::ptrdiff_t(best) + 1, cut.moves.end());
}

}  // namespace

void reverse(Cut& cut) {
  const Point3 end = cut.start;
  cut.start = cut.end();
  std::reverse(cut.moves.begin(), cut.moves.end());
  for (std::size_t k = 0; k < cut.moves.size(); ++k) {
    Move& m = cut.moves[k];
    m.end = k + 1 < cut.moves.size() ? cut.moves[k + 1].end : end;
    if (m.kind == MoveKind::clockwise)
      m.kind = MoveKind::counter_clockwise;
    else if (m.kind == MoveKind::counter_clockwise)
      m.kind = MoveKind::clockwise;
  }
}

void order_cuts(std::vector<Cut>& cuts) {
  if (cuts.empty()) return;
  Point3 at = cuts.front().start;
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    std::size_t best = k;
    double nearest = -1;
    for (std::size_t n = k; n < std::min(cuts.size(), k + most_looked_at); ++n) {
      const double d = std::min(off(at, cuts[n].start), off(at, cuts[n].end()));
      if (nearest < 0 || d < nearest) best = n, nearest = d;
    }
    std::swap(cuts[k], cuts[best]);
    if (is_closed(cuts[k]))
      start_near(cuts[k], at);
    else if (off(at, cuts[k].end()) < off(at, cuts[k].start))
      reverse(cuts[k]);
    at = cuts[k].end();
  }
}

}  // namespace krepl::mill
