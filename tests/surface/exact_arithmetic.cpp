#include "exact_arithmetic.hpp"

#include <algorithm>

namespace krepl::test {

namespace {

Real largest(const Polynomial& p) {
  Real most = 0;
  for (const Real& c : p) most = std::max<Real>(most, abs(c));
  return most;
}

/// Narrows a bracket in extended precision, where that is sure enough to be seen in full precision.
void narrow(const Polynomial& p, bool rising, Real& low, Real& high) {
  std::vector<long double> q;
  for (const Real& c : p) q.push_back(static_cast<long double>(c));
  long double a = static_cast<long double>(low), b = static_cast<long double>(high);
  for (int i = 0; i < 80; ++i) {
    const long double t = (a + b) / 2;
    long double f = 0;
    for (std::size_t k = q.size(); k-- > 0;) f = f * t + q[k];
    ((f < 0) == rising ? a : b) = t;
  }
  const Real t = a, off = 1e-12 * (1 + abs(t)), less = t - off, more = t + off;
  if (less > low && (value(p, less) < 0) == rising) low = less;
  if (more < high && (value(p, more) < 0) != rising) high = more;
}

/// The root between two places with values of opposite signs: Newton's method, halving where that leads outside.
Real bracketed(const Polynomial& p, const Polynomial& derivative, Real low, Real high) {
  const bool rising = value(p, low) < 0;
  narrow(p, rising, low, high);
  Real t = (low + high) / 2;
  for (int i = 0; i < 300; ++i) {
    const Real f = value(p, t), slope = value(derivative, t);
    if (f == 0) break;
    ((f < 0) == rising ? low : high) = t;
    Real next = slope != 0 ? t - f / slope : low;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (abs(next - t) <= 1e-57 * (1 + abs(t))) break;
    t = next;
  }
  return t;
}

}  // namespace

Polynomial operator+(const Polynomial& p, const Polynomial& q) {
  Polynomial sum(std::max(p.size(), q.size()), Real(0));
  for (std::size_t i = 0; i < p.size(); ++i) sum[i] += p[i];
  for (std::size_t i = 0; i < q.size(); ++i) sum[i] += q[i];
  return sum;
}

Polynomial operator*(const Polynomial& p, const Polynomial& q) {
  if (p.empty() || q.empty()) return {};
  Polynomial product(p.size() + q.size() - 1, Real(0));
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) product[i + j] += p[i] * q[j];
  }
  return product;
}

Polynomial operator*(const Real& s, const Polynomial& p) {
  Polynomial q = p;
  for (Real& c : q) c *= s;
  return q;
}

Real value(const Polynomial& p, const Real& t) {
  Real sum = 0;
  for (std::size_t i = p.size(); i-- > 0;) sum = sum * t + p[i];
  return sum;
}

bool is_zero(const Polynomial& p, const Real& slack) { return largest(p) <= slack; }

std::vector<Real> real_roots(Polynomial p) {
  const Real most = largest(p);
  while (!p.empty() && abs(p.back()) <= 1e-50 * most) p.pop_back();
  if (p.size() < 2) return {};
  if (p.size() == 2) return {-p[0] / p[1]};
  Polynomial derivative;
  for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(Real(i) * p[i]);
  // No root lies beyond Cauchy's bound; between two zeros of the derivative there is at most one.
  const Real bound = 1 + most / abs(p.back());
  std::vector<Real> places{-bound};
  for (const Real& t : real_roots(derivative)) {
    if (abs(t) < bound) places.push_back(t);
  }
  places.push_back(bound);
  std::vector<Real> roots;
  const auto flat = [&](const Real& t) {
    Real size = 0, power = 1;
    for (const Real& c : p) size += abs(c) * power, power *= abs(t);
    return abs(value(p, t)) <= 1e-40 * size;
  };
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    if (i > 0 && flat(places[i])) {
      roots.push_back(places[i]);
      continue;
    }
    if (i + 2 < places.size() && flat(places[i + 1])) continue;
    if ((value(p, places[i]) < 0) != (value(p, places[i + 1]) < 0)) {
      roots.push_back(bracketed(p, derivative, places[i], places[i + 1]));
    }
  }
  return roots;
}

}  // namespace krepl::test
