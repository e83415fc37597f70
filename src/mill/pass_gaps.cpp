#include "mill/pass_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace krepl::mill {

PassGaps::PassGaps(const PassLayout& layout, double together, double close)
    : layout_(layout), together_(together / layout.step), close_(close / layout.step) {
  const PassLayout::Pass& first = layout.passes.front();
  const std::int64_t squared = layout.p * layout.p + layout.q * layout.q;
  for (const PassLayout::Pass& pass : layout.passes)
    across_.push_back(((pass.j0 - first.j0) * layout.p - (pass.i0 - first.i0) * layout.q) / squared);
  extra_.resize(across_.size() + 1);
  turned_ = layout;
  turned_.passes.clear();
  turned_.p = -layout.q, turned_.q = layout.p;
}

PassGaps::Place PassGaps::place_of(Point3 p) const {
  const Line line = layout_.line(layout_.passes.front());
  const double dx = p.x - line.origin.x, dy = p.y - line.origin.y;
  return {(dx * line.direction.x + dy * line.direction.y) / layout_.step,
          (dy * line.direction.x - dx * line.direction.y) / layout_.step, p};
}

std::size_t PassGaps::gap_of(double across) const {
  const auto less = [](double a, std::int64_t b) { return a < double(b); };
  return std::size_t(std::upper_bound(across_.begin(), across_.end(), across, less) - across_.begin());
}

/// On which line between two others a pass serves places best.
std::int64_t PassGaps::choose(const std::vector<Place>& run, std::int64_t low, std::int64_t high,
                              const DropCutter& cutter) const {
  const std::int64_t middle = low + (high - low) / 2;
  const auto by_across = [](const Place& a, const Place& b) { return a.across < b.across; };
  const auto [least, most] = std::minmax_element(run.begin(), run.end(), by_across);
  if (most->across - least->across > 2 * close_ || double(high - low) < 4 * close_) return middle;
  const Point3 lowest =
      std::min_element(run.begin(), run.end(), [](const Place& a, const Place& b) { return a.at.z < b.at.z; })->at;
  const Line line = layout_.line(layout_.passes.front());
  const double off = close_ * layout_.step;
  const auto height = [&](double side) {
    return cutter.at({lowest.x - side * off * line.direction.y, lowest.y + side * off * line.direction.x}).height;
  };
  const double left = height(1), right = height(-1);
  const std::int64_t beside = left < right ? std::int64_t(std::ceil(most->across + close_ / 2))
                                           : std::int64_t(std::floor(least->across - close_ / 2));
  return beside > low && beside < high ? beside : middle;
}

std::vector<PassGaps::Extra> PassGaps::serve(const std::vector<Point3>& places, const DropCutter& cutter) {
  const PassLayout::Pass& base = layout_.passes.front();
  std::map<std::tuple<std::size_t, std::int64_t, std::int64_t>, std::vector<Place>> between;  // by gap and neighbours
  for (const Point3 p : places) {
    const Place place = place_of(p);
    const std::size_t gap = gap_of(place.across);
    const std::int64_t width = across_.size() > 1 ? across_[1] - across_[0] : std::int64_t(2 * together_);
    std::int64_t low = gap > 0 ? across_[gap - 1] : across_.front() - width;
    std::int64_t high = gap < across_.size() ? across_[gap] : across_.back() + width;
    for (const Stretch& s : extra_[gap]) {
      if (double(s.first) > place.along || double(s.last) < place.along) continue;
      if (double(s.across) <= place.across)
        low = std::max(low, s.across);
      else
        high = std::min(high, s.across);
    }
    between[{gap, low, high}].push_back(place);
  }
  std::vector<Extra> found;
  for (auto& [key, list] : between) {
    const auto [gap, low, high] = key;
    if (high - low < 2) continue;
    std::sort(list.begin(), list.end(), [](const Place& a, const Place& b) {
      return std::tie(a.along, a.across, a.at.z) < std::tie(b.along, b.across, b.at.z);
    });
    for (std::size_t k = 0; k < list.size();) {
      std::size_t end = k + 1;
      while (end < list.size() && list[end].along - list[end - 1].along <= 2 * together_) ++end;
      const std::vector<Place> run(list.begin() + std::ptrdiff_t(k), list.begin() + std::ptrdiff_t(end));
      const std::int64_t n = choose(run, low, high, cutter);
      const std::int64_t first = std::max(base.first, std::int64_t(std::floor(run.front().along - together_)));
      const std::int64_t last = std::min(base.last, std::int64_t(std::ceil(run.back().along + together_)));
      if (first < last) {
        found.push_back({gap, {base.i0 - n * layout_.q, base.j0 + n * layout_.p, first, last}, false});
        extra_[gap].push_back({n, first, last});
      }
      k = end;
    }
  }
  return found;
}

std::vector<PassGaps::Extra> PassGaps::serve_across(const std::vector<Point3>& places) const {
  const PassLayout::Pass& base = layout_.passes.front();
  std::map<std::int64_t, std::vector<Place>> strips;  // half as wide as what is served together
  for (const Point3 p : places) {
    const Place place = place_of(p);
    strips[std::int64_t(std::floor(2 * place.along / together_))].push_back(place);
  }
  std::vector<Extra> found;
  for (auto& [number, strip] : strips) {
    std::sort(strip.begin(), strip.end(),
              [](const Place& a, const Place& b) { return std::tie(a.across, a.along) < std::tie(b.across, b.along); });
    for (std::size_t k = 0; k < strip.size();) {
      std::size_t end = k + 1;
      while (end < strip.size() && strip[end].across - strip[end - 1].across <= 2 * together_) ++end;
      double least = strip[k].along, most = least;
      for (std::size_t n = k; n < end; ++n)
        least = std::min(least, strip[n].along), most = std::max(most, strip[n].along);
      const auto along = std::int64_t(std::llround((least + most) / 2)),
                 middle = std::int64_t(std::llround(strip[k].across));
      const auto before = std::int64_t(std::ceil(together_)),
                 beyond = std::int64_t(std::ceil(strip[end - 1].across - strip[k].across + together_));
      found.push_back({gap_of(strip[k].across),
                       {base.i0 + along * layout_.p - middle * layout_.q,
                        base.j0 + along * layout_.q + middle * layout_.p, -before, beyond},
                       true});
      k = end;
    }
  }
  return found;
}

PassGaps::Extra PassGaps::at(Point3 p) const {
  const Place place = place_of(p);
  const auto along = std::int64_t(std::llround(place.along)), across = std::int64_t(std::llround(place.across));
  const PassLayout::Pass& base = layout_.passes.front();
  return {gap_of(place.across), {base.i0 - across * layout_.q, base.j0 + across * layout_.p, along, along}, false};
}

}  // namespace krepl::mill
