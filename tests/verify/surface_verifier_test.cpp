// The verifier passes right surfaces that are written by hand here (no engine), and catches each planted fault.
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "support/environment.hpp"
#include "verify/surface_verifier.hpp"

namespace krepl::test {
namespace {

using input::SubdivisionFile;
using verify::Check;
using verify::SurfaceReport;
using Index = SubdivisionFile::Index;
using Curve = SubdivisionFile::Curve;
using EdgeKind = SubdivisionFile::EdgeKind;
constexpr Index none = SubdivisionFile::none;

struct Triangle {
  Point3 at[3];  ///< counter-clockwise seen from above
};

Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point3 operator*(double s, Point3 a) { return {s * a.x, s * a.y, s * a.z}; }
Point3 cross(Point3 a, Point3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point3 unit(Point3 a) { return (1 / std::sqrt(dot(a, a))) * a; }

/// The upper boundary of triangle (+) ball: a plane, three half-cylinders, three sectors of spheres. Several triangles
/// whose outlines do not meet make one subdivision.
class Kreplach {
 public:
  explicit Kreplach(double radius) {
    file.radius = radius;
    file.faces.push_back({none, none, 0});
  }

  /// Feature and face numbers of the triangle follow each other: plane, cylinders, spheres. Its outline is an inner
  /// loop of face `around`.
  void add(const Triangle& triangle, Index around = 0) {
    const auto v = triangle.at;
    const double r = file.radius;
    const auto feature = Index(file.features.size()), face = Index(file.faces.size()),
               vertex = Index(file.vertices.size());
    file.features.push_back({{v[0], v[1], v[2]}, 3});
    for (int i = 0; i < 3; ++i) file.features.push_back({{v[i], v[(i + 1) % 3], {}}, 2});
    for (int i = 0; i < 3; ++i) file.features.push_back({{v[i], {}, {}}, 1});
    const Point3 n = unit(cross(v[1] - v[0], v[2] - v[0]));
    Point3 out[3];
    for (int i = 0; i < 3; ++i) out[i] = unit({v[(i + 1) % 3].y - v[i].y, v[i].x - v[(i + 1) % 3].x, 0});
    // Per corner: top, rim of the edge before, rim of the edge after.
    for (int i = 0; i < 3; ++i)
      for (const Point3 u : {n, out[(i + 2) % 3], out[i]}) file.vertices.push_back(v[i] + r * u);
    const auto top = [&](int i) { return vertex + Index(3 * (i % 3)); };
    const auto edge = [&](int i) { return Index(i % 3 + 1); };
    const auto corner = [&](int i) { return Index(i % 3 + 4); };
    Index seam[3], after[3], before[3], rim[3], round[3];
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 2) % 3;
      seam[i] = line(EdgeKind::seam, {feature, feature + edge(i)}, top(i), top(i + 1));
      after[i] = arc(EdgeKind::seam, {feature + edge(i), feature + corner(i)}, v[i], n, out[i], top(i), top(i) + 2);
      before[i] = arc(EdgeKind::seam, {feature + corner(i), feature + edge(k)}, v[i], n, out[k], top(i), top(i) + 1);
      rim[i] = line(EdgeKind::rim, {feature + edge(i), none}, top(i) + 2, top(i + 1) + 1);
      round[i] = arc(EdgeKind::rim, {feature + corner(i), none}, v[i], out[k], out[i], top(i) + 1, top(i) + 2);
    }
    add_face(feature, cycle(face, {2 * seam[0], 2 * seam[1], 2 * seam[2]}));
    for (int i = 0; i < 3; ++i)
      add_face(feature + edge(i),
               cycle(face + edge(i), {2 * rim[i], 2 * before[(i + 1) % 3] + 1, 2 * seam[i] + 1, 2 * after[i]}));
    for (int i = 0; i < 3; ++i)
      add_face(feature + corner(i), cycle(face + corner(i), {2 * round[i], 2 * after[i] + 1, 2 * before[i]}));
    const Index outside = cycle(
        around, {2 * rim[2] + 1, 2 * round[2] + 1, 2 * rim[1] + 1, 2 * round[1] + 1, 2 * rim[0] + 1, 2 * round[0] + 1});
    file.inner.insert(file.inner.begin() + std::ptrdiff_t(file.inner_end(around)), outside);
    for (Index f = around + 1; f < file.faces.size(); ++f) ++file.faces[f].first_inner;
  }

  SubdivisionFile file;

 private:
  static constexpr int points = 5;

  Index add_edge(EdgeKind kind, Curve curve, std::array<Index, 2> feature, Index from, Index to,
                 const std::function<Point3(double)>& at) {
    const auto e = Index(file.edges.size());
    file.edges.push_back({kind, curve, feature, file.points.size()});
    file.points.push_back(file.vertices[from]);
    for (int i = 1; i + 1 < points; ++i) file.points.push_back(at(double(i) / (points - 1)));
    file.points.push_back(file.vertices[to]);
    file.half_edges.push_back({from, 2 * e + 1, none, none, e});
    file.half_edges.push_back({to, 2 * e, none, none, e});
    return e;
  }
  Index line(EdgeKind kind, std::array<Index, 2> feature, Index from, Index to) {
    const Point3 a = file.vertices[from], b = file.vertices[to];
    return add_edge(kind, Curve::line, feature, from, to, [&](double t) { return a + t * (b - a); });
  }
  /// About c from c + R u to c + R w, the short way.
  Index arc(EdgeKind kind, std::array<Index, 2> feature, Point3 c, Point3 u, Point3 w, Index from, Index to) {
    const double angle = std::acos(dot(u, w)), r = file.radius;
    return add_edge(kind, Curve::circle, feature, from, to, [&](double t) {
      return c + (r * std::sin((1 - t) * angle) / std::sin(angle)) * u +
             (r * std::sin(t * angle) / std::sin(angle)) * w;
    });
  }
  Index cycle(Index face, const std::vector<Index>& half_edges) {
    for (std::size_t i = 0; i < half_edges.size(); ++i) {
      auto& half = file.half_edges[half_edges[i]];
      half.next = half_edges[(i + 1) % half_edges.size()], half.face = face;
    }
    return half_edges[0];
  }
  void add_face(Index feature, Index outer) { file.faces.push_back({feature, outer, file.inner.size()}); }
};

struct Example {
  std::vector<Triangle> triangles;
  SubdivisionFile file;
  Terrain terrain() const {
    std::vector<Point3> vertices;
    std::vector<std::array<Terrain::Index, 3>> indices;
    for (const Triangle& t : triangles) {
      const auto first = Terrain::Index(vertices.size());
      vertices.insert(vertices.end(), t.at, t.at + 3);
      indices.push_back({first, first + 1, first + 2});
    }
    auto terrain = Terrain::from_triangles(std::move(vertices), std::move(indices));
    EXPECT_TRUE(terrain.ok());
    return std::move(*terrain);
  }
};

constexpr Triangle big{{{0, 0, 0}, {20, 1, 2}, {4, 18, -3}}};
constexpr Triangle beside{{{40, 0, 1}, {52, 3, 1}, {44, 9, 7}}};
constexpr Triangle above{{{6, 5, 9}, {9, 5, 9}, {7, 8, 10}}};

Example single(double radius = 1) {
  Kreplach k(radius);
  k.add(big);
  return {{big}, k.file};
}

/// Two parts, and a third that floats above the plane of the first: an inner loop of a face.
Example floating() {
  Kreplach k(1);
  k.add(big);
  k.add(beside);
  k.add(above, 1);
  return {{big, beside, above}, k.file};
}

Example far_away() {
  const Point3 far{512345, 4612345, 300};
  Triangle t = big;
  for (Point3& p : t.at) p = p + far;
  Kreplach k(2);
  k.add(t);
  return {{t}, k.file};
}

SurfaceReport check(const Example& example, double radius = 0) {
  verify::SurfaceCheckOptions options;
  options.radius = radius > 0 ? radius : example.file.radius;
  options.seed = seed();
  auto report = verify::check_surface(example.file, example.terrain(), options);
  EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.error().text());
  return report.ok() ? *report : SurfaceReport{};
}

std::string text(const SurfaceReport& report) {
  std::string lines;
  for (const Check& c : report.checks)
    lines += c.name + ": " + std::to_string(c.violations) + " of " + std::to_string(c.tested) + ", worst " +
             std::to_string(c.worst) + " " + c.note + "\n";
  return lines;
}

void expect_caught(const Example& example, const std::string& name) {
  const SurfaceReport report = check(example);
  for (const Check& c : report.checks)
    if (c.name == name && !c.ok()) return;
  ADD_FAILURE() << name << " did not see it:\n" << text(report);
}

TEST(SurfaceVerifier, PassesWhatIsRight) {
  for (const Example& example : {single(), single(0.01), single(300), floating(), far_away()}) {
    const SurfaceReport report = check(example);
    EXPECT_TRUE(report.ok()) << text(report);
    EXPECT_EQ(report.checks.size(), 16u);
    for (const Check& c : report.checks) EXPECT_GT(c.tested, 0u) << c.name;
  }
}

TEST(SurfaceVerifier, TellsAreaAndCounts) {
  const SurfaceReport report = check(floating());
  EXPECT_EQ(report.components, 3u);
  EXPECT_EQ(report.holes, 0u);
  double expected = 0;
  for (const Triangle& t : {big, beside}) {
    double perimeter = 0;
    for (int i = 0; i < 3; ++i)
      perimeter += std::hypot(t.at[(i + 1) % 3].x - t.at[i].x, t.at[(i + 1) % 3].y - t.at[i].y);
    expected += cross(t.at[1] - t.at[0], t.at[2] - t.at[0]).z / 2 + perimeter + std::acos(-1);
  }
  EXPECT_NEAR(report.area, expected, 0.01);  // arcs are taken as parabolas between five points
}

TEST(SurfaceVerifier, CatchesBrokenTopology) {
  const std::pair<const char*, std::function<void(SubdivisionFile&)>> faults[] = {
      {"twin of itself", [](auto& f) { f.half_edges[4].twin = 4; }},
      {"foreign twin", [](auto& f) { f.half_edges[4].twin = 9; }},
      {"next swapped", [](auto& f) { std::swap(f.half_edges[0].next, f.half_edges[1].next); }},
      {"index out of range", [](auto& f) { f.half_edges[7].origin = 1000; }},
      {"feature out of range", [](auto& f) { f.edges[7].feature[0] = 1000; }},
      {"origin moved", [](auto& f) { f.half_edges[7].origin = f.half_edges[3].origin; }},
      {"inner loop dropped",
       [](auto& f) {
         f.inner.erase(f.inner.begin());
         for (auto& face : f.faces) face.first_inner -= face.first_inner > 0;
       }},
      {"outer loop of another face", [](auto& f) { f.faces[2].outer = f.faces[3].outer; }},
      {"face of one half-edge", [](auto& f) { f.half_edges[3].face = 2; }},
      {"half-edge missing", [](auto& f) { f.half_edges.pop_back(); }},
      {"vertex without edge",
       [](auto& f) {
         f.vertices.push_back({1, 1, 1});
       }},
      {"outside with a feature", [](auto& f) { f.faces[0].feature = 0; }},
  };
  for (const auto& [name, fault] : faults) {
    SCOPED_TRACE(name);
    Example example = floating();
    fault(example.file);
    expect_caught(example, "topology");
  }
}

TEST(SurfaceVerifier, CatchesMovedPoints) {
  Example moved = single();
  moved.file.vertices[0].x += 1e-6;
  expect_caught(moved, "edges end at vertices");
  expect_caught(moved, "vertices");

  // Edge 0 is a seam of plane and cylinder, 1 a seam of cylinder and sphere, 3 a straight rim, 4 a round one.
  Example high = single();
  high.file.points[high.file.edges[1].first + 2].z += 1e-6;
  expect_caught(high, "edges touch their features");
  Example low = single();
  low.file.points[low.file.edges[1].first + 2].z -= 1e-6;
  expect_caught(low, "nothing nearer to edges");

  // Along the plane: the distance from both features changes by 1e-13 only.
  Example aside = single();
  for (int i = 1; i < 4; ++i) {
    Point3& p = aside.file.points[aside.file.edges[0].first + std::size_t(i)];
    p = p + 1e-6 * unit(big.at[2] - big.at[0]);
  }
  expect_caught(aside, "seams and rims in place");

  Example bent = single();
  bent.file.points[bent.file.edges[3].first + 1].x += 1e-6;
  expect_caught(bent, "lines and circles");
  expect_caught(bent, "outline at distance R");

  Example round = single();
  round.file.points[round.file.edges[4].first + 1].z += 1e-6;
  expect_caught(round, "seams and rims in place");
  expect_caught(round, "lines and circles");
}

TEST(SurfaceVerifier, CatchesWrongLabels) {
  Example one = single();
  one.file.faces[2].feature = 3;
  expect_caught(one, "features and labels");

  // Everywhere alike: faces and edges agree with each other, but not with the terrain.
  Example both = single();
  const auto swap = [](Index& f) { f = f == 2 ? 3 : f == 3 ? 2 : f; };
  for (auto& face : both.file.faces) swap(face.feature);
  for (auto& edge : both.file.edges) swap(edge.feature[0]), swap(edge.feature[1]);
  expect_caught(both, "edges touch their features");
  expect_caught(both, "what the ball touches");

  Example foreign = single();
  foreign.file.features[5].at[0].x += 1e-9;
  expect_caught(foreign, "features and labels");
  Example kind = single();
  kind.file.edges[0].kind = EdgeKind::rim;
  expect_caught(kind, "features and labels");
  Example curve = single();
  curve.file.edges[0].curve = Curve::circle;
  expect_caught(curve, "features and labels");
  Example straight = single();
  straight.file.edges[1].curve = Curve::line;
  expect_caught(straight, "lines and circles");
}

TEST(SurfaceVerifier, CatchesWhatIsMissing) {
  Example floor = single();
  floor.triangles.push_back(above);
  expect_caught(floor, "what the ball touches");
  Example wide = single();
  wide.triangles.push_back(beside);
  expect_caught(wide, "what the ball touches");
  // Over an edge of the first one.
  Example cut = single();
  cut.triangles.push_back({{{-1, -1, 1}, {2, -1, 1}, {0, 2, 1}}});
  expect_caught(cut, "nothing nearer to edges");
  expect_caught(cut, "vertices");
}

TEST(SurfaceVerifier, CatchesAFalseDrawing) {
  // The floating part listed as if it lay in the plane of the second part.
  Example elsewhere = floating();
  auto& file = elsewhere.file;
  const Index start = file.inner[file.faces[1].first_inner];
  Index h = start;
  do file.half_edges[h].face = 8, h = file.half_edges[h].next;
  while (h != start);
  file.inner.erase(file.inner.begin() + std::ptrdiff_t(file.faces[1].first_inner));
  for (Index f = 2; f < file.faces.size(); ++f) --file.faces[f].first_inner;
  file.inner.insert(file.inner.begin() + std::ptrdiff_t(file.faces[8].first_inner), start);
  for (Index f = 9; f < file.faces.size(); ++f) ++file.faces[f].first_inner;
  expect_caught(elsewhere, "components in their faces");

  Example mirrored = single();
  for (auto& p : mirrored.file.points) p.x = -p.x;
  for (auto& p : mirrored.file.vertices) p.x = -p.x;
  expect_caught(mirrored, "loops turn the right way");

  // One side of the plane runs through the other two.
  Example crossing = single();
  for (int i = 1; i < 4; ++i)
    crossing.file.points[crossing.file.edges[0].first + std::size_t(i)] = {6 + 0.1 * i, 30, 0};
  expect_caught(crossing, "edges do not cross");
}

TEST(SurfaceVerifier, CatchesAnotherRadius) {
  const SurfaceReport report = check(single(), 1.001);
  EXPECT_FALSE(report.ok());
  EXPECT_FALSE(report.checks[0].ok());
  EXPECT_EQ(report.checks[0].name, "radius");
}

TEST(SurfaceVerifier, RefusesARadiusThatIsNone) {
  const Example example = single();
  for (const double radius : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    auto report = verify::check_surface(example.file, example.terrain(), {radius, 0, 1});
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.error().code, ErrorCode::usage);
  }
}

TEST(SurfaceVerifier, IsTheSameForAnyNumberOfThreads) {
  const Example example = floating();
  Context one, many;
  one.threads = 1, many.threads = 7;
  const auto a = verify::check_surface(example.file, example.terrain(), {1, 0, 1}, one);
  const auto b = verify::check_surface(example.file, example.terrain(), {1, 0, 1}, many);
  ASSERT_TRUE(a.ok() && b.ok());
  for (std::size_t i = 0; i < a.value().checks.size(); ++i) {
    const Check &p = a.value().checks[i], &q = b.value().checks[i];
    EXPECT_EQ(p.worst, q.worst) << p.name;
    EXPECT_EQ(p.where, q.where) << p.name;
    EXPECT_EQ(p.note, q.note) << p.name;
  }
}

}  // namespace
}  // namespace krepl::test
