#include "support/curve_generators.hpp"

#include <cmath>

namespace krepl::test {

namespace {

class Generator {
 public:
  explicit Generator(std::mt19937_64& random) : random_(random) {}

  ZoneCase make(CurveFamily family) {
    ZoneCase c;
    c.radius = pick({0.25, 0.5, 0.5, 1.0, 1.0, 1.5, 2.0, 3.0, 0.3, 0.7071067811865476, 7.0});
    switch (family) {
      case CurveFamily::grid:
        grid(c);
        break;
      case CurveFamily::circles:
        circles(c);
        break;
      case CurveFamily::concentric:
        concentric(c);
        break;
      case CurveFamily::one_circle:
        one_circle(c);
        break;
      case CurveFamily::tangent:
        tangent(c);
        break;
      case CurveFamily::flat:
        flat(c);
        break;
      case CurveFamily::crossing:
        crossing(c);
        break;
      case CurveFamily::fillets:
        fillets(c);
        break;
      case CurveFamily::arc_rings:
        arc_rings(c);
        break;
      case CurveFamily::near_equal:
        grid(c);
        near_equal(c);
        drop_ill_conditioned(c);
        break;
      case CurveFamily::count:
        break;
    }
    if (below(3) == 0) shift(c, 4.0e5 + below(1000), 5.4e6);
    return c;
  }

 private:
  int below(int n) { return int(random_() % std::uint64_t(n)); }
  double unit() { return double(random_() >> 11) * 0x1p-53; }
  double pick(std::initializer_list<double> list) { return *(list.begin() + below(int(list.size()))); }
  Point grid_point(int n) { return {double(below(n)), double(below(n))}; }
  static Point on_circle(Point c, double r, double angle) {
    return {c.x + r * std::cos(angle), c.y + r * std::sin(angle)};
  }
  static InputPart arc(Point a, Point m, Point b) { return curve({a, m, b}, {1}); }
  InputPart arc_about(Point c, double r, double from, double sweep) {
    if (std::abs(sweep) >= 2 * M_PI) return arc({c.x - r, c.y}, {c.x + r, c.y}, {c.x - r, c.y});
    return arc(on_circle(c, r, from), on_circle(c, r, from + sweep / 2), on_circle(c, r, from + sweep));
  }

  void grid(ZoneCase& c) {
    for (int k = 1 + below(5); k > 0; --k) {
      InputPart part;
      part.vertices.push_back(grid_point(6));
      for (int i = 1 + below(4); i > 0; --i) {
        if (below(2) == 0) {
          part.middles.push_back(std::uint32_t(part.vertices.size()));
          part.vertices.push_back(grid_point(6));
        }
        part.vertices.push_back(grid_point(6));
      }
      c.parts.push_back(part);
    }
  }
  void circles(ZoneCase& c) {
    const double step = pick({1, 2, 2, 3});
    for (int k = 1 + below(6); k > 0; --k) {
      const Point p = grid_point(4);
      c.parts.push_back(arc_about({step * p.x, step * p.y}, pick({0.5, 1, 1, 2, c.radius}), 0, 7));
    }
    if (below(2) == 0) c.parts.push_back(line({grid_point(8), grid_point(8)}));
  }
  void concentric(ZoneCase& c) {
    const Point centre{double(below(3)), double(below(3))};
    double r = c.radius * pick({0.5, 1, 1.5, 2});
    for (int k = 1 + below(5); k > 0; --k) {
      c.parts.push_back(arc_about(centre, r, below(8) * M_PI / 4, (1 + below(8)) * M_PI / 4 * (below(2) ? 1 : -1)));
      r += c.radius * pick({0, 1, 2, 2, 2, 3});
    }
  }
  void one_circle(ZoneCase& c) {
    const Point centre{double(below(3)), double(below(3))};
    const double r = c.radius * pick({0.5, 0.9, 1, 1, 1.1, 2, 5});
    for (int k = 2 + below(5); k > 0; --k) {
      c.parts.push_back(arc_about(centre, r, below(16) * M_PI / 8, (1 + below(15)) * M_PI / 8 * (below(2) ? 1 : -1)));
      if (below(3) > 0) continue;
      InputPart again = c.parts.back();
      std::swap(again.vertices[0], again.vertices[2]);
      c.parts.push_back(again);
    }
  }
  void tangent(ZoneCase& c) {
    for (int k = 1 + below(3); k > 0; --k) {
      InputPart part;
      Point at = grid_point(8);
      double heading = below(8) * M_PI / 4;
      part.vertices.push_back(at);
      for (int i = 2 + below(6); i > 0; --i) {
        if (below(2) == 0) {
          at = on_circle(at, pick({0.5, 1, 2, 3}), heading);
        } else {
          const double r = pick({c.radius, c.radius / 2, 0.5, 1, 2, 4}), side = below(2) ? 1 : -1;
          const double turn = pick({M_PI / 2, M_PI, M_PI / 4, 1e-3, 1e-6, 5}) * side;
          const Point centre = on_circle(at, r, heading + side * M_PI / 2);
          const double from = heading - side * M_PI / 2;
          part.middles.push_back(std::uint32_t(part.vertices.size()));
          part.vertices.push_back(on_circle(centre, r, from + turn / 2));
          at = on_circle(centre, r, from + turn);
          heading += turn;
        }
        part.vertices.push_back(at);
      }
      c.parts.push_back(part);
    }
  }
  void flat(ZoneCase& c) {
    for (int k = 1 + below(4); k > 0; --k) {
      const Point a = grid_point(5);
      Point b = grid_point(5);
      if (a == b) b.x += 1;
      const double height = std::ldexp(1 + unit(), -below(60)) * (below(2) ? 1 : -1), share = 0.25 + 0.5 * unit();
      const double bulge = 4 * share * (1 - share) * height;
      c.parts.push_back(arc(
          a, {a.x + share * (b.x - a.x) - bulge * (b.y - a.y), a.y + share * (b.y - a.y) + bulge * (b.x - a.x)}, b));
      if (below(3) == 0) c.parts.push_back(line({a, b}));
      if (below(3) == 0) c.parts.push_back(line({b, grid_point(5)}));
    }
  }
  void crossing(ZoneCase& c) {
    c.radius = std::ldexp(1 + unit(), below(12) - 7);
    for (int k = 1 + below(8); k > 0; --k) {
      const Point p{10 * unit(), 10 * unit()};
      const double size = std::ldexp(1, below(12) - 8);
      const auto near = [&](double s) { return Point{p.x + s * (unit() - 0.5), p.y + s * (unit() - 0.5)}; };
      if (below(3) == 0)
        c.parts.push_back(line({near(10 * size), near(10 * size)}));
      else
        c.parts.push_back(arc(near(10 * size), near(10 * size), near(10 * size)));
    }
  }
  void fillets(ZoneCase& c) {
    for (int k = 1 + below(3); k > 0; --k) {
      const Point p = grid_point(8);
      const double w = 1 + below(6), h = 1 + below(6), r = std::min(w, h) * pick({0.5, 0.25, 0.1, 1e-4});
      const double s = r * (1 - std::sqrt(0.5));
      InputPart part = curve_ring({{p.x + r, p.y},
                                   {p.x + w - r, p.y},
                                   {p.x + w - s, p.y + s},
                                   {p.x + w, p.y + r},
                                   {p.x + w, p.y + h - r},
                                   {p.x + w - s, p.y + h - s},
                                   {p.x + w - r, p.y + h},
                                   {p.x + r, p.y + h},
                                   {p.x + s, p.y + h - s},
                                   {p.x, p.y + h - r},
                                   {p.x, p.y + r},
                                   {p.x + s, p.y + s},
                                   {p.x + r, p.y}},
                                  {2, 5, 8, 11}, below(2));
      c.parts.push_back(part);
    }
  }
  void arc_rings(ZoneCase& c) {
    for (int k = 1 + below(3); k > 0; --k) {
      InputPart part;
      part.ring = true, part.feature = below(2);
      part.vertices.push_back(grid_point(9));
      for (int i = 1 + below(4); i > 0; --i) {
        if (below(3) > 0) {
          part.middles.push_back(std::uint32_t(part.vertices.size()));
          part.vertices.push_back(grid_point(9));
        }
        part.vertices.push_back(grid_point(9));
      }
      if (below(2) == 0) {
        part.middles.push_back(std::uint32_t(part.vertices.size()));
        part.vertices.push_back(grid_point(9));
        part.vertices.push_back(part.vertices.front());
      }
      c.parts.push_back(part);
    }
  }
  void near_equal(ZoneCase& c) {
    const std::vector<InputPart> parts = c.parts;
    c.parts.insert(c.parts.end(), parts.begin(), parts.end());
    const double size = std::ldexp(1, -30 - below(23));
    for (InputPart& part : c.parts)
      for (Point& p : part.vertices)
        if (below(2) == 0) p = {p.x + size * (unit() - 0.5), p.y + size * (unit() - 0.5)};
  }
  /// Parts with an arc around the whole world (the middle hardly off the line beyond an end), or with two of three
  /// places so near to each other that the last digits decide about the circle.
  static void drop_ill_conditioned(ZoneCase& c) {
    const auto is_ill = [](const InputPart& part) {
      for (const std::uint32_t m : part.middles) {
        const Point* p = &part.vertices[m - 1];
        const auto near = [](Point a, Point b) { return !(a == b) && std::hypot(a.x - b.x, a.y - b.y) < 1e-6; };
        const auto arc = verify::CircularArc::through(p[0], p[1], p[2]);
        if (near(p[0], p[1]) || near(p[1], p[2]) || near(p[0], p[2]) || (arc && arc->wide && arc->r > 1e3)) return true;
      }
      return false;
    };
    std::erase_if(c.parts, is_ill);
    if (c.parts.empty()) c.parts.push_back(point(0, 0));
  }
  static void shift(ZoneCase& c, double x, double y) {
    for (InputPart& part : c.parts)
      for (Point& p : part.vertices) p = {p.x + x, p.y + y};
  }

  std::mt19937_64& random_;
};

}  // namespace

const char* name(CurveFamily f) {
  static constexpr const char* names[] = {"grid", "circles",  "concentric", "one_circle", "tangent",
                                          "flat", "crossing", "fillets",    "arc_rings",  "near_equal"};
  return names[std::size_t(f)];
}

ZoneCase random_curves(CurveFamily family, std::mt19937_64& random) { return Generator(random).make(family); }

}  // namespace krepl::test
