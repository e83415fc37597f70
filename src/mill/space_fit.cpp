#include "mill/space_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"

namespace krepl::mill {

using namespace vectors;

SpaceLattice::Place SpaceLattice::round(Point3 p) const {
  return {std::llround((p.x - zero.x) / unit), std::llround((p.y - zero.y) / unit),
          std::llround((p.z - zero.z) / unit)};
}

std::vector<SpaceLattice::Place> fit_lines(const std::vector<Point3>& polyline, const SpaceLattice& lattice,
                                           double within) {
  std::vector<SpaceLattice::Place> places{lattice.round(polyline.front())};
  const std::size_t last = polyline.size() - 1;
  for (std::size_t at = 0; at < last;) {
    const Point3 from = lattice.place(places.back());
    const auto fits = [&](std::size_t end) {
      const Point3 way = lattice.place(lattice.round(polyline[end])) - from;
      const double far = length(way);
      if (far == 0) return false;
      for (std::size_t i = at; i <= end; ++i) {
        if (length(cross(polyline[i] - from, way)) > within * far) return false;
        if (i > at && dot(polyline[i] - polyline[i - 1], way) < 0) return false;
      }
      return true;
    };
    std::size_t good = at + 1, step = 1;
    while (good < last && fits(std::min(last, good + step))) good = std::min(last, good + step), step *= 2;
    for (std::size_t bad = std::min(last + 1, good + step); bad - good > 1;) {
      const std::size_t middle = good + (bad - good) / 2;
      (fits(middle) ? good : bad) = middle;
    }
    at = good;
    const SpaceLattice::Place end = lattice.round(polyline[at]);
    if (end != places.back()) places.push_back(end);
  }
  return places;
}

}  // namespace krepl::mill
