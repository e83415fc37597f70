#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vectors.hpp"
#include "krepl/section.hpp"

namespace krepl {

using namespace vectors;

namespace {

/// From the point at one angle to that at another; no digits are lost where the axes are long and the angles close.
Point3 way(const CutPiece& piece, double from, double to) {
  const double half = std::sin((to - from) / 2), middle = (to + from) / 2;
  return (-2 * std::sin(middle) * half) * piece.axis[0] + (2 * std::cos(middle) * half) * piece.axis[1];
}

Point3 mix(Point3 a, Point3 b, double s) {
  return {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z)};
}

}  // namespace

Point3 CutPiece::at(double s) const {
  if (s <= 0) return start;
  if (s >= 1) return end;
  if (kind == Kind::line) return mix(start, end, s);
  // The ends are known better than angles on a long axis tell: what is missing at the end is spread over the piece.
  const Point3 missing = end - start - way(*this, from, to);
  return start + way(*this, from, from + s * (to - from)) + s * missing;
}

Point3 CutPiece::tangent(double s) const {
  if (kind == Kind::line) return end - start;
  const double t = from + s * (to - from);
  return (to - from) * ((-std::sin(t)) * axis[0] + std::cos(t) * axis[1]);
}

void CutPiece::append_points(double max_error, std::vector<Point3>& points) const {
  if (kind != Kind::line) {
    // A chord over an angle t is off by no more than t^2 / 8 times the length of the second derivative, the vector to
    // the centre.
    const double sweep = std::abs(to - from);
    const auto largest = [&](bool cosine) {  // of |cos| or |sin| between the ends
      const double shift = cosine ? 0 : std::numbers::pi / 2;
      const double a = (std::min(from, to) - shift) / std::numbers::pi,
                   b = (std::max(from, to) - shift) / std::numbers::pi;
      if (std::floor(b) >= std::ceil(a)) return 1.0;
      return std::max(std::abs(std::cos(from - shift)), std::abs(std::cos(to - shift)));
    };
    const double bend = largest(true) * length(axis[0]) + largest(false) * length(axis[1]);
    const double radius = kind == Kind::circle ? length(axis[0]) : bend;
    const double step = std::min(std::sqrt(8 * max_error / std::max(radius, max_error)), 2.0);
    const double chords = std::min(std::ceil(sweep / step), 1e6);
    for (double i = 1; i < chords; ++i) points.push_back(at(i / chords));
  }
  points.push_back(end);
}

CutPiece CutPiece::part(double s, double t) const {
  CutPiece result = *this;
  result.start = at(s);
  result.end = at(t);
  if (kind == Kind::line) return result;
  result.from = from + s * (to - from);
  result.to = from + t * (to - from);
  return result;
}

}  // namespace krepl
