#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <span>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::test {

/// 60 digits: double roots still have 30.
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>, boost::multiprecision::et_off>;

struct Vec {
  Real x, y, z;
  Vec() = default;
  Vec(Real x_, Real y_, Real z_) : x(std::move(x_)), y(std::move(y_)), z(std::move(z_)) {}
  explicit Vec(Point3 p) : x(p.x), y(p.y), z(p.z) {}
};
inline Vec operator+(const Vec& v, const Vec& w) { return {v.x + w.x, v.y + w.y, v.z + w.z}; }
inline Vec operator-(const Vec& v, const Vec& w) { return {v.x - w.x, v.y - w.y, v.z - w.z}; }
inline Vec operator*(const Real& s, const Vec& v) { return {s * v.x, s * v.y, s * v.z}; }
inline Real dot(const Vec& v, const Vec& w) { return v.x * w.x + v.y * w.y + v.z * w.z; }
inline Vec cross(const Vec& v, const Vec& w) {
  return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
}
inline Real length(const Vec& v) { return sqrt(dot(v, v)); }
inline Vec unit(const Vec& v) { return (1 / length(v)) * v; }

/// A polynomial by its coefficients, the constant first.
using Polynomial = std::vector<Real>;

Polynomial operator+(const Polynomial& p, const Polynomial& q);
Polynomial operator*(const Polynomial& p, const Polynomial& q);
Polynomial operator*(const Real& s, const Polynomial& p);
Real value(const Polynomial& p, const Real& t);
bool is_zero(const Polynomial& p, const Real& slack);

/// All real roots, each once, those of even multiplicity too: where |p| is below 1e-40 of its terms.
/// The zero polynomial has none.
std::vector<Real> real_roots(Polynomial p);

}  // namespace krepl::test
