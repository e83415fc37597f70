// The bounds that the search prunes by lie above what they bound, and not far above it where it matters.
#include <gtest/gtest.h>

#include <cmath>

#include "drop_terrains.hpp"
#include "support/environment.hpp"
#include "terrain/drop_cutter_bound.hpp"
#include "terrain/drop_cutter_search.hpp"

namespace krepl::test {

namespace {

using namespace drop;

struct Triangle {
  Point3 a, b, c;  // counter-clockwise, relative to a place
  double slope_x, slope_y;
};

Triangle any_triangle(Random& random, double size, double slope) {
  for (;;) {
    Triangle t;
    for (Point3* p : {&t.a, &t.b, &t.c}) *p = {size * uniform(random, -1, 1), size * uniform(random, -1, 1), 0};
    const double area = (t.b.x - t.a.x) * (t.c.y - t.a.y) - (t.b.y - t.a.y) * (t.c.x - t.a.x);
    if (std::abs(area) < 1e-3 * size * size) continue;
    if (area < 0) std::swap(t.b, t.c);
    t.slope_x = uniform(random, -slope, slope), t.slope_y = uniform(random, -slope, slope);
    const double shift_x = uniform(random, -1.5, 1.5), shift_y = uniform(random, -1.5, 1.5);
    for (Point3* p : {&t.a, &t.b, &t.c}) p->x += shift_x, p->y += shift_y, p->z = t.slope_x * p->x + t.slope_y * p->y;
    return t;
  }
}

/// The height of a ball of radius 1 over (x, y) that touches the triangle, less 1, from a fine sample of the triangle.
double sampled(const Triangle& t, double x, double y) {
  double best = nothing;
  constexpr int n = 40;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j) {
      const double v = double(i) / n, w = double(j) / n, u = 1 - v - w;
      const double qx = u * t.a.x + v * t.b.x + w * t.c.x - x, qy = u * t.a.y + v * t.b.y + w * t.c.y - y;
      const double s = 1 - qx * qx - qy * qy;
      if (s >= 0) best = std::max(best, u * t.a.z + v * t.b.z + w * t.c.z + std::sqrt(s) - 1);
    }
  return best;
}

FourTriangles four(const Triangle& t) {
  return {float(std::max({t.a.z, t.b.z, t.c.z})), float(t.a.z), float(t.slope_x), float(t.slope_y), float(t.a.x), float(t.a.y),
          float(t.b.x), float(t.b.y), float(t.c.x), float(t.c.y)};
}
FourBlocks block(const Triangle& t) {
  const double x0 = std::min({t.a.x, t.b.x, t.c.x}), x1 = std::max({t.a.x, t.b.x, t.c.x});
  const double y0 = std::min({t.a.y, t.b.y, t.c.y}), y1 = std::max({t.a.y, t.b.y, t.c.y});
  return {float(std::max({t.a.z, t.b.z, t.c.z})), float(t.slope_x * (x0 + x1) / 2 + t.slope_y * (y0 + y1) / 2),
          float(t.slope_x), float(t.slope_y), float(x0), float(x1), float(y0), float(y1)};
}

float first(Float4 four) {
  float lanes[4];
  four.store(lanes);
  return lanes[0];
}

TEST(DropBounds, LieAboveAllPlaces) {
  Random random(seed());
  const BallBound ball(1, 1e-6);
  for (int k = 0; k < int(3000 * effort()); ++k) {
    const Triangle t = any_triangle(random, exponential(random, -2, 0.5), exponential(random, -2, 0.7));
    const double height = sampled(t, 0, 0);
    const float by_triangle = first(bound(ball, four(t), OnePlace{})), by_block = first(bound(ball, block(t), OnePlace{}));
    EXPECT_GE(by_triangle, height - 1e-4);
    EXPECT_GE(by_block, height - 1e-4);
  }
}

TEST(DropBounds, AreTightForSmallTriangles) {
  Random random(seed());
  const BallBound ball(1, 1e-6);
  double worst = 0;
  for (int k = 0; k < 3000; ++k) {
    const double size = 0.05;
    const Triangle t = any_triangle(random, size, 0.5);
    const double height = sampled(t, 0, 0);
    if (height < -0.5) continue;
    worst = std::max(worst, (first(bound(ball, four(t), OnePlace{})) - height) / (size * size));
  }
  EXPECT_LT(worst, 60);  // an error of the second order in the size
}

TEST(DropBounds, LieAboveAllPlacesOfARectangle) {
  Random random(seed());
  const BallBound ball(1, 1e-6);
  for (int k = 0; k < int(500 * effort()); ++k) {
    const Triangle t = any_triangle(random, exponential(random, -2, 0), exponential(random, -2, 0.7));
    const ManyPlaces many{float(exponential(random, -3, 0)), float(exponential(random, -3, 0)),
                          float(uniform(random, -1, 1)), float(uniform(random, -1, 1))};
    const float by_triangle = first(bound(ball, four(t), many)), by_block = first(bound(ball, block(t), many));
    for (int i = 0; i < 9; ++i) {
      const double x = many.half_x * (i % 3 - 1), y = many.half_y * (i / 3 - 1);
      const double height = sampled(t, x, y) - many.slope_x * x - many.slope_y * y;
      EXPECT_GE(by_triangle, height - 1e-4);
      EXPECT_GE(by_block, height - 1e-4);
    }
  }
}

TEST(DropBounds, NothingIsExpectedOfPartsOutOfReach) {
  const BallBound ball(1, 1e-6);
  const Triangle t{{1.1, 0, 5}, {3, 0, 5}, {2, 1, 5}, 0, 0};
  EXPECT_EQ(first(bound(ball, four(t), OnePlace{})), -INFINITY);
  EXPECT_EQ(first(bound(ball, block(t), OnePlace{})), -INFINITY);
  EXPECT_GT(first(bound(ball, block(t), ManyPlaces{0.2f, 0, 0, 0})), 3);
}

TEST(DropBounds, TouchesInDoubleAndQuadruplePrecisionAgree) {
  Random random(seed());
  for (int k = 0; k < int(20000 * effort()); ++k) {
    const double size = exponential(random, -2, 2);
    const auto point = [&] {
      return Point3{size * uniform(random, -1, 1), size * uniform(random, -1, 1), size * uniform(random, -1, 1)};
    };
    const Point3 a = point(), b = point(), c = point();
    const Ball ball{{uniform(random, -1, 1), uniform(random, -1, 1)}, 1, 1};
    const auto near = [&](double x, double y) { return x == y || std::abs(x - y) <= 1e-13 * (1 + size); };
    EXPECT_TRUE(near(touch_vertex(a, ball).height, touch_vertex_quad(a, ball).height));
    const EdgeTouch e = touch_edge(a, b, ball), f = touch_edge_quad(a, b, ball);
    EXPECT_EQ(e.ends, f.ends);
    EXPECT_TRUE(near(e.height, f.height));
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const FaceTouch g = area > 0 ? touch_face(a, b, c, ball) : touch_face(a, c, b, ball);
    const FaceTouch h = area > 0 ? touch_face_quad(a, b, c, ball) : touch_face_quad(a, c, b, ball);
    EXPECT_EQ(g.beyond, h.beyond);
    EXPECT_TRUE(near(g.height, h.height));
  }
}

}  // namespace

}  // namespace krepl::test
