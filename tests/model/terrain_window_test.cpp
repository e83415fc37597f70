// Windows on grids and meshes against the definition in terrain_window.hpp, by brute force.
#include <cmath>
#include <limits>
#include <random>

#include "reference_mesh.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

constexpr double no_data = std::numeric_limits<double>::quiet_NaN();

struct GridCase {
  Terrain::Grid grid;
  std::vector<double> heights;
};

/// The definition of a grid's triangles and numbers, cell by cell.
ReferenceMesh reference_of(const GridCase& c, const Terrain& terrain) {
  ReferenceMesh mesh;
  const Index columns = Index(c.grid.columns);
  const Point3 origin = terrain.origin();
  const auto h = [&](Index s) { return c.heights[s]; };
  const auto add_edge = [&](Index s, Index t, Index number) { mesh.edge[{6 * s, 6 * t}] = number; };
  const auto add_face = [&](Index number, std::array<Index, 3> samples) {
    if (std::isnan(h(samples[0])) || std::isnan(h(samples[1])) || std::isnan(h(samples[2]))) return false;
    mesh.face[number] = {{6 * samples[0], 6 * samples[1], 6 * samples[2]}};
    for (const Index s : samples) {
      mesh.vertex[6 * s] = {terrain.grid().first.x + (s % columns) * c.grid.cell_x,
                            terrain.grid().first.y + (s / columns) * c.grid.cell_y, h(s) - origin.z};
    }
    return true;
  };
  for (Index row = 0; row + 1 < c.grid.rows; ++row) {
    for (Index column = 0; column + 1 < columns; ++column) {
      const Index s = row * columns + column, east = s + 1, north = s + columns, far = north + 1;
      bool falling = c.grid.split == Terrain::Split::falling;
      if (c.grid.split == Terrain::Split::shorter) {
        const double rise = std::abs(h(s) - h(far)), fall = std::abs(h(east) - h(north));
        falling = !std::isnan(fall) && (std::isnan(rise) || fall < rise);
      }
      const bool lower = falling ? add_face(6 * s + 4, {s, east, north}) : add_face(6 * s + 4, {s, east, far});
      const bool upper = falling ? add_face(6 * s + 5, {east, far, north}) : add_face(6 * s + 5, {s, far, north});
      if (lower || upper) falling ? add_edge(east, north, 6 * s + 3) : add_edge(s, far, 6 * s + 3);
      if (lower) add_edge(s, east, 6 * s + 1);
      if (upper) add_edge(north, far, 6 * north + 1);
      if (falling ? lower : upper) add_edge(s, north, 6 * s + 2);
      if (falling ? upper : lower) add_edge(east, far, 6 * east + 2);
    }
  }
  return mesh;
}

class Random {
 public:
  explicit Random(std::uint64_t run) : engine_(seed() + run) {}
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  bool chance(double p) { return real(0, 1) < p; }

 private:
  std::mt19937_64 engine_;
};

GridCase random_grid(Random& random) {
  GridCase c;
  c.grid.columns = std::size_t(random.integer(2, 12));
  c.grid.rows = std::size_t(random.integer(2, 12));
  c.grid.split = Terrain::Split(random.integer(0, 2));
  if (random.chance(0.5)) {
    c.grid.first = {double(random.integer(-20, 20)), double(random.integer(-20, 20))};
  } else {
    c.grid.first = {random.real(-1e6, 1e6), random.real(-1e6, 1e6)};
    c.grid.cell_x = random.real(0.1, 50), c.grid.cell_y = random.real(0.1, 50);
  }
  const double holes = random.chance(0.5) ? random.real(0, 0.6) : 0;
  for (std::size_t i = 0; i < c.grid.columns * c.grid.rows; ++i)
    c.heights.push_back(random.chance(holes) ? no_data : double(random.integer(0, 4)));
  return c;
}

/// A rectangle near the box, often with sides exactly on coordinates that occur.
std::pair<Point, Point> random_rectangle(Random& random, const ReferenceMesh& mesh, const Terrain& terrain) {
  const auto coordinate = [&](double low, double high, double Point3::*axis) {
    if (random.chance(0.4)) {
      auto v = mesh.vertex.begin();
      std::advance(v, random.integer(0, int(mesh.vertex.size()) - 1));
      return v->second.*axis;
    }
    const double margin = 0.3 * (high - low) + 0.1;
    return random.real(low - margin, high + margin);
  };
  double x0 = coordinate(terrain.lowest().x, terrain.highest().x, &Point3::x),
         x1 = coordinate(terrain.lowest().x, terrain.highest().x, &Point3::x);
  double y0 = coordinate(terrain.lowest().y, terrain.highest().y, &Point3::y),
         y1 = coordinate(terrain.lowest().y, terrain.highest().y, &Point3::y);
  if (random.chance(0.1)) x1 = x0, y1 = y0;
  return {{std::min(x0, x1), std::min(y0, y1)}, {std::max(x0, x1), std::max(y0, y1)}};
}

TEST(TerrainWindow, GridsAgainstTheDefinition) {
  const int cases = int(400 * effort());
  TerrainWindow window;
  for (int run = 0; run < cases; ++run) {
    SCOPED_TRACE("run " + std::to_string(run));
    Random random{std::uint64_t(run)};
    const GridCase c = random_grid(random);
    const auto terrain = Terrain::from_grid(c.grid, c.heights);
    if (!terrain) {
      EXPECT_NE(terrain.error().what.find("no "), std::string::npos) << terrain.error().text();
      continue;
    }
    const ReferenceMesh mesh = reference_of(c, *terrain);
    EXPECT_EQ(terrain->triangle_count(), mesh.face.size());
    ASSERT_NO_FATAL_FAILURE(expect_corners(*terrain, mesh));
    for (int i = 0; i < 12; ++i) {
      const auto [low, high] = random_rectangle(random, mesh, *terrain);
      window.fill(*terrain, low, high);
      ASSERT_NO_FATAL_FAILURE(expect_window(window, mesh, low, high))
          << low.x << ' ' << low.y << ' ' << high.x << ' ' << high.y;
    }
  }
}

struct Soup {
  std::vector<Point3> vertices;
  std::vector<std::array<Index, 3>> triangles;
};

/// Small integers: most triangles share places, many are vertical, repeated or without area.
Soup random_soup(Random& random) {
  Soup soup;
  const int extent = random.integer(1, 7), height = random.integer(0, 3);
  const int count = random.integer(1, random.chance(0.1) ? 400 : 40);
  for (int i = 0, n = random.integer(3, 3 * count + 3); i < n; ++i) {
    soup.vertices.push_back(
        {double(random.integer(0, extent)), double(random.integer(0, extent)), double(random.integer(0, height))});
  }
  for (int i = 0; i < count; ++i) {
    std::array<Index, 3> t{};
    for (Index& v : t) v = Index(random.integer(0, int(soup.vertices.size()) - 1));
    soup.triangles.push_back(t);
  }
  return soup;
}

int sign(double v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

/// Twice the area in the plane of two coordinates; exact for small integers.
double area(const std::array<Point3, 3>& p, double Point3::*u, double Point3::*v) {
  return (p[1].*u - p[0].*u) * (p[2].*v - p[0].*v) - (p[1].*v - p[0].*v) * (p[2].*u - p[0].*u);
}

struct SoupReference {
  ReferenceMesh mesh;
  Terrain::Report report;
};

using Places = std::map<std::array<double, 3>, Index>;

/// The triangles that must be left, named by sorted vertex numbers; counts what must be dropped.
std::map<std::array<Index, 3>, ReferenceMesh::Face> kept_triangles(const Soup& soup, const Places& number,
                                                                   Terrain::Report& report) {
  std::map<std::array<Index, 3>, ReferenceMesh::Face> kept;
  std::set<std::array<std::array<double, 3>, 3>> seen;
  for (const auto& t : soup.triangles) {
    const std::array<Point3, 3> p{soup.vertices[t[0]], soup.vertices[t[1]], soup.vertices[t[2]]};
    const int turn = sign(area(p, &Point3::x, &Point3::y));
    if (turn == 0 && area(p, &Point3::y, &Point3::z) == 0 && area(p, &Point3::z, &Point3::x) == 0) {
      ++report.zero_area_triangles;
      continue;
    }
    std::array<std::array<double, 3>, 3> places;
    for (std::size_t i = 0; i < 3; ++i) places[i] = {p[i].x, p[i].y, p[i].z};
    ReferenceMesh::Face face{{number.at(places[0]), number.at(places[1]), number.at(places[2])}, turn == 0};
    if (turn < 0) std::swap(face.vertex[1], face.vertex[2]);
    if (turn == 0) std::sort(face.vertex.begin(), face.vertex.end());
    std::rotate(face.vertex.begin(), std::min_element(face.vertex.begin(), face.vertex.end()), face.vertex.end());
    std::array<Index, 3> name = face.vertex;
    std::sort(name.begin(), name.end());
    std::sort(places.begin(), places.end());
    if (!seen.insert(places).second)
      ++report.repeated_triangles;
    else
      report.vertical_triangles += turn == 0;
    kept[name] = face;
  }
  return kept;
}

SoupReference reference_of(const Soup& soup, const Terrain& terrain) {
  SoupReference r;
  r.report.triangles = soup.triangles.size();
  Places number;
  for (Index v = 0; v < terrain.feature_bound() && terrain.feature_kind(v) == Terrain::FeatureKind::vertex; ++v) {
    const Point3 at = terrain.corners(v).point[0], origin = terrain.origin();
    EXPECT_TRUE(number.insert({{at.x + origin.x, at.y + origin.y, at.z + origin.z}, v}).second) << "not welded";
    r.mesh.vertex[v] = at;
  }
  std::set<Index> used, corners;
  std::set<std::array<double, 3>> places;
  for (const auto& t : soup.triangles)
    for (const Index v : t) {
      corners.insert(v);
      const Point3 p = soup.vertices[v];
      places.insert({p.x, p.y, p.z});
      number.insert({{p.x, p.y, p.z}, Terrain::none});  // of no kept triangle
    }
  r.report.welded_vertices = corners.size() - places.size();
  const auto kept = kept_triangles(soup, number, r.report);
  std::map<std::pair<Index, Index>, int> sides;
  for (const auto& [name, face] : kept) {
    used.insert(name.begin(), name.end());
    for (int i = 0; i < 3; ++i) ++sides[ReferenceMesh::side(face, i)];
  }
  EXPECT_EQ(used.size(), r.mesh.vertex.size()) << "vertices that no triangle uses, or some are missing";
  Index next = Index(r.mesh.vertex.size());
  for (const auto& [ends, count] : sides) {
    r.mesh.edge[ends] = next++;
    r.report.border_edges += count == 1;
    r.report.non_manifold_edges += count > 2;
  }
  for (const auto& [name, face] : kept) r.mesh.face[next++] = face;
  return r;
}

void expect_report(const Terrain::Report& r, const Terrain::Report& want) {
  EXPECT_EQ(r.triangles, want.triangles);
  EXPECT_EQ(r.zero_area_triangles, want.zero_area_triangles);
  EXPECT_EQ(r.repeated_triangles, want.repeated_triangles);
  EXPECT_EQ(r.welded_vertices, want.welded_vertices);
  EXPECT_EQ(r.vertical_triangles, want.vertical_triangles);
  EXPECT_EQ(r.border_edges, want.border_edges);
  EXPECT_EQ(r.non_manifold_edges, want.non_manifold_edges);
}

TEST(TerrainWindow, SoupsAgainstTheDefinition) {
  const int cases = int(400 * effort());
  TerrainWindow window;
  for (int run = 0; run < cases; ++run) {
    SCOPED_TRACE("run " + std::to_string(run));
    Random random{std::uint64_t(1'000'000 + run)};
    Soup soup = random_soup(random);
    const double shift = random.chance(0.3) ? 1048576 : 0;  // an origin that is taken off
    for (Point3& p : soup.vertices) p = {p.x + shift, p.y - 3 * shift, p.z + shift};
    const auto terrain = Terrain::from_triangles(soup.vertices, soup.triangles);
    if (!terrain) {
      EXPECT_NE(terrain.error().what.find("no triangle is left"), std::string::npos) << terrain.error().text();
      continue;
    }
    const SoupReference reference = reference_of(soup, *terrain);
    expect_report(terrain->report(), reference.report);
    EXPECT_EQ(terrain->triangle_count(), reference.mesh.face.size());
    ASSERT_NO_FATAL_FAILURE(expect_corners(*terrain, reference.mesh));
    for (int i = 0; i < 12; ++i) {
      const auto [low, high] = random_rectangle(random, reference.mesh, *terrain);
      window.fill(*terrain, low, high);
      ASSERT_NO_FATAL_FAILURE(expect_window(window, reference.mesh, low, high))
          << low.x << ' ' << low.y << ' ' << high.x << ' ' << high.y;
    }
  }
}

}  // namespace
}  // namespace krepl::test
