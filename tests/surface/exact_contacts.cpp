#include "exact_contacts.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace krepl::test {

namespace {

/// Parts of trigonometric polynomials of degree k as polynomials in t = tan(angle / 2), times (1 + t^2)^k.
const Polynomial one_and_square{Real(1), Real(0), Real(1)}, cosine{Real(1), Real(0), Real(-1)}, sine{Real(0), Real(2)};

Polynomial constant(const Real& c) { return c * one_and_square; }

/// Two directions that with d make a frame, at an angle that no symmetry of the input has: then the missing t =
/// infinity is no root.
std::pair<Vec, Vec> frame(const Vec& d) {
  const Vec p = unit(cross(d, Vec(Real(3) / 7, Real(-5) / 11, Real(2) / 13)));
  return {p, cross(d, p)};
}

Vec around(const Vec& p, const Vec& q, const Real& t) {
  const Real u = 1 + t * t;
  return ((1 - t * t) / u) * p + (2 * t / u) * q;
}

std::vector<Real> quadratic(const Real& a, const Real& b, const Real& c) { return real_roots({c, b, a}); }

}  // namespace

ExactContacts::ExactContacts(const SmallTerrain& c) : radius_(c.radius), quick_(triangles_of(c), {}, c.radius) {
  const auto triangles = triangles_of(c);
  Real scale = radius_;
  for (const auto& t : triangles) {
    for (const Point3 p : t) scale = std::max<Real>(scale, std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
  }
  slack_ = 1e-25 * scale;
  number_features(triangles);
  classify_edges();
  corners();
  seams();
  triples();
}

void ExactContacts::number_features(const std::vector<SmallTerrain::Triangle>& triangles) {
  std::map<std::tuple<double, double, double>, std::size_t> vertex;
  std::map<std::vector<std::size_t>, bool> seen;
  const auto add = [&](Feature f, std::vector<Feature>& to) {
    if (!seen.emplace(f.vertices, true).second) return;
    if (f.corners.size() == 2) f.direction = unit(f.corners[1] - f.corners[0]);
    to.push_back(std::move(f));
  };
  for (const auto& t : triangles) {
    std::vector<std::pair<std::size_t, Vec>> v;
    for (const Point3 p : t)
      v.emplace_back(vertex.emplace(std::tuple(p.x, p.y, p.z), vertex.size()).first->second, Vec(p));
    std::sort(v.begin(), v.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &a = v[i], &b = v[(i + 1) % 3];
      add({{a.second}, {a.first}, {}}, features_);
      if (a.first < b.first)
        add({{a.second, b.second}, {a.first, b.first}, {}}, features_);
      else
        add({{b.second, a.second}, {b.first, a.first}, {}}, features_);
    }
    Feature face{{v[0].second, v[1].second, v[2].second}, {v[0].first, v[1].first, v[2].first}, {}};
    Vec n = unit(cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]));
    face.direction = n.z < 0 ? Real(-1) * n : n;
    add(face, abs(n.z) > 1e-40 ? features_ : vertical_);
  }
}

/// An edge between faces that are coplanar has no patch, nor has one that some face hides: then no ball touches it
/// inside.
void ExactContacts::classify_edges() {
  for (Feature& e : features_) {
    if (e.corners.size() != 2) continue;
    std::vector<Vec> sides;  // across the edge into each of its triangles
    for (const auto* list : {&features_, &vertical_}) {
      for (const Feature& f : *list) {
        if (f.corners.size() != 3 ||
            !std::includes(f.vertices.begin(), f.vertices.end(), e.vertices.begin(), e.vertices.end()))
          continue;
        Vec third;
        for (std::size_t k = 0; k < 3; ++k) {
          if (f.vertices[k] != e.vertices[0] && f.vertices[k] != e.vertices[1]) third = f.corners[k] - e.corners[0];
        }
        sides.push_back(unit(third - dot(third, e.direction) * e.direction));
      }
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t j = i + 1; j < sides.size(); ++j) {
        if (length(sides[i] + sides[j]) < 1e-40) e.flat = true;
      }
    }
    // Hidden: no upward normal across the edge has all sides below it. The normals at the ends of the stretch are those
    // of the triangles and the horizontal ones.
    Vec level = cross(e.direction, Vec(Real(0), Real(0), Real(1)));
    if (length(level) < 1e-40) {
      e.visible = false;
      continue;
    }
    level = unit(level);
    std::vector<Vec> normals{level, Real(-1) * level};
    for (const Vec& s : sides) {
      const Vec n = cross(e.direction, s);
      normals.push_back(n.z < 0 ? Real(-1) * n : n);
    }
    e.visible = std::any_of(normals.begin(), normals.end(), [&](const Vec& n) {
      return std::all_of(sides.begin(), sides.end(), [&](const Vec& s) { return dot(n, s) < 1e-40; });
    });
  }
}

Vec ExactContacts::foot(const Feature& f, const Vec& p) {
  const auto on_segment = [&](const Vec& a, const Vec& b) {
    const Vec d = b - a;
    const Real s = dot(p - a, d) / dot(d, d);
    return s <= 0 ? a : s >= 1 ? b : a + s * d;
  };
  if (f.corners.size() == 1) return f.corners[0];
  if (f.corners.size() == 2) return on_segment(f.corners[0], f.corners[1]);
  const Vec &a = f.corners[0], &b = f.corners[1], &c = f.corners[2];
  const Vec n = cross(b - a, c - a), q = p - (dot(p - a, n) / dot(n, n)) * n;
  const auto left = [&](const Vec& v, const Vec& w) { return dot(cross(w - v, q - v), n) >= 0; };
  if (left(a, b) && left(b, c) && left(c, a)) return q;
  Vec best = on_segment(a, b);
  for (const Vec& other : {on_segment(b, c), on_segment(c, a)}) {
    if (length(p - other) < length(p - best)) best = other;
  }
  return best;
}

Real ExactContacts::distance(const std::vector<Vec>& corners, const Vec& p) {
  return length(p - foot({corners, {}, {}}, p));
}

Real ExactContacts::distance(const Vec& p) const {
  Real least = -1;
  for (const auto* list : {&features_, &vertical_}) {
    for (const Feature& f : *list) {
      if (f.corners.size() != 3) continue;
      const Real d = length(p - foot(f, p));
      if (least < 0 || d < least) least = d;
    }
  }
  return least;
}

bool ExactContacts::incident(const Feature& f, const Feature& g) {
  const bool more = f.vertices.size() > g.vertices.size();
  const auto &large = more ? f.vertices : g.vertices, &small = more ? g.vertices : f.vertices;
  return std::includes(large.begin(), large.end(), small.begin(), small.end());
}

/// No ball reaches both.
bool ExactContacts::far(const Feature& f, const Feature& g) const {
  const auto apart = [&](auto coordinate) {
    const auto less = [&](const Vec& v, const Vec& w) { return coordinate(v) < coordinate(w); };
    const auto [f0, f1] = std::minmax_element(f.corners.begin(), f.corners.end(), less);
    const auto [g0, g1] = std::minmax_element(g.corners.begin(), g.corners.end(), less);
    return std::max<Real>(coordinate(*f0) - coordinate(*g1), coordinate(*g0) - coordinate(*f1)) > 2 * radius_;
  };
  return apart([](const Vec& v) { return v.x; }) || apart([](const Vec& v) { return v.y; }) ||
         apart([](const Vec& v) { return v.z; });
}

/// Above vertices, along the normals of their faces and at right angles to two of their edges.
void ExactContacts::corners() {
  for (const Feature& v : features_) {
    if (v.corners.size() != 1) continue;
    std::vector<const Feature*> edges;
    for (const Feature& f : features_) {
      if (!incident(v, f)) continue;
      if (f.corners.size() == 3) examine(v.corners[0] + radius_ * f.direction);
      if (f.corners.size() == 2) edges.push_back(&f);
    }
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (std::size_t j = i + 1; j < edges.size(); ++j) {
        const Vec n = cross(edges[i]->direction, edges[j]->direction);
        if (length(n) < 1e-40) continue;
        examine(v.corners[0] + (radius_ / length(n)) * n);
        examine(v.corners[0] - (radius_ / length(n)) * n);
      }
    }
  }
}

/// Along the places where the ball rolls from a face to one of its edges, and from an edge to one of its ends.
void ExactContacts::seams() {
  for (const Feature& e : features_) {
    if (e.corners.size() != 2 || !e.visible) continue;
    for (const Feature& f : features_) {
      if (f.corners.size() == 3 && incident(e, f)) {
        for (const Feature& g : features_) {
          if (g.visible && !incident(e, g) && !far(e, g)) on_seam(f, e, g);
        }
      }
    }
    for (const Feature& g : features_) {
      if (!g.visible || incident(e, g) || far(e, g)) continue;
      on_arc(e, e.corners[0], g);
      on_arc(e, e.corners[1], g);
    }
  }
}

void ExactContacts::on_seam(const Feature& face, const Feature& edge, const Feature& other) {
  const Vec start = edge.corners[0] + radius_ * face.direction, &d = edge.direction;
  const Vec w = start - other.corners[0];
  std::vector<Real> places;
  if (other.corners.size() == 3) {
    places = real_roots({dot(w, other.direction) - radius_, dot(d, other.direction)});
  } else if (other.corners.size() == 1) {
    places = quadratic(Real(1), 2 * dot(w, d), dot(w, w) - radius_ * radius_);
  } else {
    const Real wo = dot(w, other.direction), o = dot(d, other.direction);
    places = quadratic(1 - o * o, 2 * (dot(w, d) - wo * o), dot(w, w) - wo * wo - radius_ * radius_);
  }
  for (const Real& s : places) examine(start + s * d);
}

void ExactContacts::on_arc(const Feature& edge, const Vec& end, const Feature& other) {
  const auto [p, q] = frame(edge.direction);
  const Polynomial turn = one_and_square;
  const Vec w = end - other.corners[0];
  const auto along = [&](const Vec& n) {
    return (radius_ * dot(p, n)) * cosine + (radius_ * dot(q, n)) * sine;
  };  // of the arm
  Polynomial f;
  if (other.corners.size() == 3) {
    f = along(other.direction) + constant(dot(w, other.direction) - radius_);
  } else if (other.corners.size() == 1) {
    f = Real(2) * along(w) + constant(dot(w, w));
  } else {
    const Polynomial far = along(other.direction) + constant(dot(w, other.direction));
    f = (Real(2) * along(w) + constant(dot(w, w))) * turn + Real(-1) * (far * far);
  }
  for (const Real& t : real_roots(f)) examine(end + radius_ * around(p, q, t));
}

void ExactContacts::triples() {
  const std::size_t n = features_.size();
  const auto apart = [&](std::size_t i, std::size_t j) {
    return features_[i].visible && features_[j].visible && !incident(features_[i], features_[j]) &&
           !far(features_[i], features_[j]);
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (!apart(i, j)) continue;
      for (std::size_t k = j + 1; k < n; ++k) {
        if (apart(i, k) && apart(j, k)) on_three(features_[i], features_[j], features_[k]);
      }
    }
  }
}

void ExactContacts::on_three(const Feature& f, const Feature& g, const Feature& h) {
  if (f.corners.size() == 2) return beside_line(f, g, h);
  if (g.corners.size() == 2) return beside_line(g, f, h);
  if (h.corners.size() == 2) return beside_line(h, f, g);
  without_line({&f, &g, &h});
}

/// Planes give linear equations, and so do differences of two spheres: what is left is at most one sphere.
void ExactContacts::without_line(const std::vector<const Feature*>& three) {
  struct Linear {
    Vec n;
    Real c;
  };
  std::vector<Linear> linear;
  const Feature* sphere = nullptr;
  for (const Feature* f : three) {
    if (f->corners.size() == 3) {
      linear.push_back({f->direction, dot(f->direction, f->corners[0]) + radius_});
    } else if (sphere == nullptr) {
      sphere = f;
    } else {
      const Vec &v = sphere->corners[0], &w = f->corners[0];
      linear.push_back({Real(2) * (w - v), dot(w, w) - dot(v, v)});
    }
  }
  const Vec d = cross(linear[0].n, linear[1].n);
  if (length(d) < 1e-40) return;
  // A point on both planes.
  const Vec base = (1 / dot(d, d)) * (linear[0].c * cross(linear[1].n, d) + linear[1].c * cross(d, linear[0].n));
  if (sphere == nullptr) {
    const Real slope = dot(linear[2].n, d);
    if (abs(slope) > 1e-40) examine(base + ((linear[2].c - dot(linear[2].n, base)) / slope) * d);
    return;
  }
  const Vec w = base - sphere->corners[0];
  for (const Real& s : quadratic(dot(d, d), 2 * dot(w, d), dot(w, w) - radius_ * radius_)) examine(base + s * d);
}

/// Centres at distance R from a line are known by their place s along it and an angle. Each of the others gives an
/// equation that is at most quadratic in s, with trigonometric polynomials as coefficients; s is eliminated.
void ExactContacts::beside_line(const Feature& line, const Feature& g, const Feature& h) {
  const Vec& d = line.direction;
  const auto [p, q] = frame(d);
  struct Equation {
    Real square;
    Polynomial linear, free;  // times 1 + t^2 and its square
  };
  const auto equation = [&](const Feature& f) {
    const Vec w = line.corners[0] - f.corners[0];
    const auto along = [&](const Vec& n) { return (radius_ * dot(p, n)) * cosine + (radius_ * dot(q, n)) * sine; };
    if (f.corners.size() == 3) {
      const Vec& n = f.direction;
      return Equation{0, constant(dot(d, n)), (along(n) + constant(dot(w, n) - radius_)) * one_and_square};
    }
    // |w + arm + s d|^2 = R^2, where |arm| = R.
    const Polynomial free = (Real(2) * along(w) + constant(dot(w, w))) * one_and_square;
    if (f.corners.size() == 1) return Equation{1, constant(2 * dot(w, d)), free};
    const Vec& e = f.direction;
    const Real o = dot(d, e);
    const Polynomial far = along(e) + constant(dot(w, e));
    return Equation{1 - o * o, constant(2 * dot(w, d)) + (-2 * o) * far, free + Real(-1) * (far * far)};
  };
  Equation a = equation(g), b = equation(h);
  const Real nothing = 1e-45 * radius_;
  const auto only_angle = [&](const Equation& e) { return abs(e.square) < 1e-45 && is_zero(e.linear, nothing); };
  const auto at = [&](const Real& t, const Real& s) { examine(line.corners[0] + s * d + radius_ * around(p, q, t)); };
  const auto solve = [&](const Equation& e, const Real& t) {
    const Real u = 1 + t * t;
    for (const Real& s : quadratic(e.square, value(e.linear, t) / u, value(e.free, t) / (u * u))) at(t, s);
  };
  if (only_angle(b)) std::swap(a, b);
  if (only_angle(a)) {
    if (only_angle(b)) return;  // three parallel ones: no single place
    for (const Real& t : real_roots(a.free)) solve(b, t);
    return;
  }
  if (abs(a.square) < 1e-45) std::swap(a, b);
  // b's square eliminated, unless it is zero already: linear s + free = 0.
  Equation rest = b;
  if (abs(b.square) >= 1e-45) {
    rest = {0, a.square * b.linear + (-b.square) * a.linear, a.square * b.free + (-b.square) * a.free};
  }
  // Both free of s^2 and s: the second decides.
  const Polynomial resultant = abs(a.square) < 1e-45 ? a.linear * rest.free + Real(-1) * (a.free * rest.linear)
                                                     : a.square * (rest.free * rest.free) +
                                                           Real(-1) * (a.linear * rest.free * rest.linear) +
                                                           a.free * rest.linear * rest.linear;
  for (const Real& t : real_roots(resultant)) {
    const Real u = 1 + t * t, slope = value(rest.linear, t) / u, free = value(rest.free, t) / (u * u);
    if (abs(slope) > 1e-25 * radius_)
      at(t, -free / slope);
    else
      solve(a, t);
  }
}

bool ExactContacts::in_touch(const Feature& f, const Vec& p, const Real& slack) const {
  const Vec up = p - foot(f, p);
  if (abs(length(up) - radius_) > slack) return false;
  if (f.corners.size() == 2) return abs(dot(up, f.direction)) <= slack;
  if (f.corners.size() == 3) return length(up - radius_ * f.direction) <= slack;
  return true;
}

void ExactContacts::examine(const Vec& center) {
  // Most are far inside; no need for many digits to see that.
  const LongPoint roughly{Long(center.x), Long(center.y), Long(center.z)};
  if (quick_.distance(roughly) < Long(radius_) * (1 - 1e-9L)) return;
  int touched = 0;
  for (const auto* list : {&features_, &vertical_}) {
    for (const Feature& f : *list) {
      const Vec up = center - foot(f, center);
      const Real off = length(up) - radius_;
      if (off < -slack_) return;
      if (off > slack_) continue;
      if (up.z < 1e-9 * radius_) return;  // from below, or on a wall
      touched += in_touch(f, center, slack_);
    }
  }
  if (touched < 3) return;
  for (const ContactPoint& p : points_) {
    if (length(p.center - center) < 1e-20 * radius_) return;
  }
  points_.push_back({center, certain(center)});
}

bool ExactContacts::rigid(const Vec& center, const Real& slack) const {
  std::vector<Vec> normals;
  for (const Feature& f : features_) {
    const Vec up = center - foot(f, center);
    if (abs(length(up) - radius_) > slack) continue;
    const Vec n = unit(up);
    if (std::none_of(normals.begin(), normals.end(), [&](const Vec& m) { return length(m - n) < 1e-6; }))
      normals.push_back(n);
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t j = i + 1; j < normals.size(); ++j) {
      for (std::size_t k = j + 1; k < normals.size(); ++k) {
        if (abs(dot(cross(normals[i], normals[j]), normals[k])) > 1e-6) return true;
      }
    }
  }
  return false;
}

/// Three contacts whose normals have rank 3 make a vertex: three planes that are equally high meet in a point. With
/// fewer places touched, the patches about one place must differ in a direction that the valley does not have.
bool ExactContacts::certain(const Vec& center) const {
  if (rigid(center, slack_)) return true;
  struct Touch {
    Vec normal;
    const Feature* vertex = nullptr;
    std::vector<const Feature*> edges, faces;
  };
  std::vector<Touch> touches;
  for (const Feature& f : features_) {
    const Vec up = center - foot(f, center);
    if (!in_touch(f, center, slack_)) continue;
    const Vec n = unit(up);
    auto t = std::find_if(touches.begin(), touches.end(),
                          [&](const Touch& other) { return length(other.normal - n) < 1e-20; });
    if (t == touches.end()) t = touches.insert(t, Touch{n, nullptr, {}, {}});
    if (f.corners.size() == 1) t->vertex = &f;
    if (f.corners.size() == 2) t->edges.push_back(&f);
    if (f.corners.size() == 3) t->faces.push_back(&f);
  }
  if (touches.size() == 1) {
    // The corner of a moved face, or of two cylinders that are not in line.
    const Touch& t = touches[0];
    if (t.vertex == nullptr) return false;
    if (!t.faces.empty()) return true;
    return std::any_of(t.edges.begin(), t.edges.end(),
                       [&](const Feature* e) { return length(cross(e->direction, t.edges[0]->direction)) > 1e-20; });
  }
  if (touches.size() != 2) return false;
  const Vec valley = cross(touches[0].normal, touches[1].normal);
  for (const Touch& t : touches) {
    Vec seam;
    if (t.vertex == nullptr && t.edges.size() == 1 && !t.faces.empty())
      seam = t.edges[0]->direction;
    else if (t.vertex != nullptr && t.edges.size() == 1 && t.faces.empty() && !t.edges[0]->flat)
      seam = cross(t.normal, t.edges[0]->direction);
    else
      continue;
    if (length(cross(seam, valley)) > 1e-9 * length(valley)) return true;
  }
  return false;
}

}  // namespace krepl::test
