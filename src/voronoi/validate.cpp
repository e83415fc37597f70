#include <cmath>

#include "voronoi/diagram.hpp"

namespace krepl::voronoi {
namespace {

class Check {
 public:
  Check(const Diagram& d, double horizon) : d_(d), horizon_(horizon) {}

  std::optional<std::string> run() {
    for (Index f = 0; f < d_.face_count(); ++f) {
      for (Index i = d_.begin[f]; i < d_.begin[f + 1]; ++i) {
        if (auto wrong = link(f, i)) return wrong;
      }
    }
    return std::nullopt;
  }

 private:
  std::string at(Index f, Index i, const std::string& what) const {
    const Point p = d_.place[d_.vertex[i]];
    return what + " at link " + std::to_string(i) + " of face " + std::to_string(f) + ", near x " +
           std::to_string(p.x) + ", y " + std::to_string(p.y) + " relative to the origin";
  }

  std::optional<std::string> link(Index f, Index i) const {
    const Index t = d_.twin[i], other = d_.label[i];
    if (d_.vertex[i] >= d_.place.size()) return at(f, i, "a link without a vertex");
    if (other == none) {
      if (t != none) return at(f, i, "a twin where there is no neighbour");
      if (!(d_.minimum[i] > horizon_ / 2)) return at(f, i, "a horizon that is too near");
      return std::nullopt;
    }
    if (other == f) return at(f, i, "a face that neighbours itself");
    if (t == none || d_.twin[t] != i || d_.label[t] != f) return at(f, i, "twins that are not mutual");
    if (t < d_.begin[other] || t >= d_.begin[other + 1]) return at(f, i, "a twin of another face");
    if (!(d_.minimum[i] <= d_.clearance[d_.vertex[i]]) || d_.minimum[i] != d_.minimum[t])
      return at(f, i, "a wrong minimum");
    // The link starts where the one before it ends, and there its twin ends.
    if (i > d_.begin[f] && d_.vertex[i - 1] != d_.vertex[t]) return at(f, i, "a border that is not closed");
    return std::nullopt;
  }

  const Diagram& d_;
  double horizon_;
};

}  // namespace

std::optional<std::string> validate(const Diagram& diagram, double horizon) { return Check(diagram, horizon).run(); }

}  // namespace krepl::voronoi
