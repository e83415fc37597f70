#include "section/crossings.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"

namespace krepl::section {

using namespace vectors;

namespace {

struct Sample {
  double s, value;
  bool high;
};

class Search {
 public:
  Search(const EdgeCourse& course, const std::function<double(Point3)>& value, double slack)
      : course_(course), value_(value), slack_(slack) {}

  void take_samples(bool starts_high, bool ends_high) {
    const auto& points = course_.samples();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double v = value_(points[i]);
      samples_.push_back({double(i) / double(points.size() - 1), v, v >= 0});
    }
    samples_.front().high = starts_high;
    samples_.back().high = ends_high;
  }

  /// Adds samples where the function bends towards the level between others that are on one side of it.
  void look_into_bends() {
    std::vector<Sample> found;
    for (std::size_t i = 1; i + 1 < samples_.size(); ++i) {
      const Sample &a = samples_[i - 1], &b = samples_[i], &c = samples_[i + 1];
      if (a.high != b.high || b.high != c.high) continue;
      const double sign = b.high ? 1 : -1, fa = sign * a.value, fb = sign * b.value, fc = sign * c.value;
      const double bend = fa - 2 * fb + fc;
      if (!(bend > 0)) continue;
      const double place = (fa - fc) / (2 * bend);  // of the parabola's vertex, in steps from b
      const bool first = i == 1, last = i + 2 == samples_.size();
      if (place < (first ? -1 : -0.75) || place > (last ? 1 : 0.75)) continue;
      const double lowest = fb - bend * place * place / 2;
      if (lowest > fb / 2 + bend / 4) continue;
      if (const auto s = descend(a.s, c.s, sign)) found.push_back(*s);
    }
    for (const Sample& s : found) {
      const auto at =
          std::lower_bound(samples_.begin(), samples_.end(), s.s, [](const Sample& x, double y) { return x.s < y; });
      if (at == samples_.end() || at->s != s.s) samples_.insert(at, s);
    }
  }

  /// At a vertex where curves are tangent a closed form may begin a bit beside it: next to one that is on the level but
  /// for rounding, or for how far the level was moved, the crossing is the vertex.
  double snapped(double s, const Sample& a, const Sample& b) const {
    constexpr double near = 1e-5;
    if (a.s == 0 && s < near && std::abs(a.value) <= slack_) return 0;
    if (b.s == 1 && s > 1 - near && std::abs(b.value) <= slack_) return 1;
    return s;
  }

  void change_points(Index edge, Crossing::Side side, std::vector<Crossing>& out) const {
    for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
      const Sample &a = samples_[i], &b = samples_[i + 1];
      if (a.high == b.high) continue;
      const double s = snapped(root(a, b), a, b);
      out.push_back({edge, s, course_.at(s), side, b.high});
    }
  }

 private:
  /// Golden section for a place on the other side of the level.
  std::optional<Sample> descend(double from, double to, double sign) const {
    constexpr double golden = 0.6180339887498949;
    const auto f = [&](double s) { return sign * value_(course_.at(s)); };
    const auto beyond = [&](double v) { return sign > 0 ? v < 0 : v <= 0; };
    double a = from, b = to, c = b - golden * (b - a), d = a + golden * (b - a), fc = f(c), fd = f(d);
    for (int i = 0; i < 40; ++i) {
      if (beyond(fc)) return Sample{c, sign * fc, sign < 0};
      if (beyond(fd)) return Sample{d, sign * fd, sign < 0};
      if (fc < fd) {
        b = d, d = c, fd = fc;
        c = b - golden * (b - a), fc = f(c);
      } else {
        a = c, c = d, fc = fd;
        d = a + golden * (b - a), fd = f(d);
      }
    }
    return std::nullopt;
  }

  /// By the secant with a bracket, each end that stays halved in weight.
  double root(const Sample& left, const Sample& right) const {
    Sample a = left, b = right;
    if ((a.value >= 0) != a.high) return a.s;  // only rounding told the end's side
    if ((b.value >= 0) != b.high) return b.s;
    double fa = a.value, fb = b.value;
    for (int i = 0, last = 0; i < 100 && b.s - a.s > 0x1p-53; ++i) {
      double s = a.s - fa * (b.s - a.s) / (fb - fa);
      if (!(s > a.s && s < b.s) || i % 8 == 7) s = a.s + (b.s - a.s) / 2;
      if (!(s > a.s && s < b.s)) break;
      const double f = value_(course_.at(s));
      if (f == 0) return s;
      if ((f >= 0) == left.high) {
        a = {s, f, left.high};
        fa = f;
        if (last < 0) fb /= 2;
        last = -1;
      } else {
        b = {s, f, right.high};
        fb = f;
        if (last > 0) fa /= 2;
        last = 1;
      }
    }
    // The course may begin or end with a jump.
    return std::abs(a.value) <= std::abs(b.value) ? a.s : b.s;
  }

  const EdgeCourse& course_;
  const std::function<double(Point3)>& value_;
  const double slack_;
  std::vector<Sample> samples_;
};

}  // namespace

void find_crossings(const EdgeCourse& course, Index edge, Crossing::Side side, bool starts_high, bool ends_high,
                    const std::function<double(Point3)>& value, double slack, std::vector<Crossing>& out) {
  if (course.is_straight()) {
    if (starts_high == ends_high) return;
    const Point3 a = course.samples().front(), b = course.samples().back();
    const double fa = value(a), fb = value(b);
    const double t = fa != fb ? std::clamp(fa / (fa - fb), 0.0, 1.0) : 0.0;
    out.push_back({edge, t, t == 1 ? b : a + t * (b - a), side, ends_high});
    return;
  }
  Search search(course, value, slack);
  search.take_samples(starts_high, ends_high);
  search.look_into_bends();
  search.change_points(edge, side, out);
}

}  // namespace krepl::section
