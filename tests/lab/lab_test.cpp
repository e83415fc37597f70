// The laboratory: counts against the theorems, constructions against brute force and the other engine, the same bytes
// for any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "krepl/incremental.hpp"
#include "lab/chart.hpp"
#include "lab/experiments.hpp"
#include "lab/families.hpp"
#include "lab/figures.hpp"
#include "lab/fit.hpp"
#include "lab/lower_bound.hpp"
#include "lab/measure.hpp"
#include "lab/profiles.hpp"
#include "support/environment.hpp"
#include "support/surface_faults.hpp"

namespace krepl::test {

namespace {

using lab::Construction;
using lab::Report;

SmallTerrain case_of(const Construction& c) {
  SmallTerrain t;
  t.is_grid = false;
  t.radius = c.radius;
  for (const auto& corner : c.triangles)
    t.triangles.push_back({c.vertices[corner[0]], c.vertices[corner[1]], c.vertices[corner[2]]});
  return t;
}

/// By brute force on both engines, and one engine against the other.
void expect_sound(const Construction& c, const char* name) {
  const auto surface = lab::surface_of(c, {});
  ASSERT_TRUE(surface) << name << ": " << surface.error().text();
  const SmallTerrain same = case_of(c);
  const auto fault = fault_in(*surface, same), difference = fault_between_engines(*surface, same);
  EXPECT_FALSE(fault) << name << ": " << *fault;
  EXPECT_FALSE(difference) << name << ": " << *difference;
}

double result_named(const Report& report, const std::string& name) {
  for (const auto& [key, value] : report.results) {
    if (key == name) return value;
  }
  ADD_FAILURE() << "no result " << name;
  return std::nan("");
}

std::int64_t cell(const Report& report, std::size_t row, const std::string& column) {
  const auto& names = report.table.columns;
  const auto k = std::size_t(std::find(names.begin(), names.end(), column) - names.begin());
  return std::get<std::int64_t>(report.table.rows.at(row).at(k));
}

std::string bytes_of(const Report& report) {
  std::string all;
  for (const auto& file : lab::files_of(report)) all += file.file_name + '\n' + file.content;
  for (const auto& finding : report.findings) all += finding;
  return all;
}

TEST(LabLowerBound, EveryPairHasVerticesOfItsOwn) {
  for (const auto& [grooves, needles] :
       {std::pair<std::size_t, std::size_t>{2, 1}, {2, 9}, {4, 4}, {6, 3}, {10, 2}, {16, 16}, {2, 40}, {40, 2}}) {
    const Construction c = lab::lower_bound(grooves, needles);
    EXPECT_EQ(c.triangles.size(), 6 * needles + 8 * grooves + 26);
    const auto surface = lab::surface_of(c, {});
    ASSERT_TRUE(surface) << surface.error().text();
    EXPECT_EQ(surface->subdivision().vertex_count, lab::lower_bound_vertices(grooves, needles))
        << grooves << " grooves, " << needles << " needles";
    const auto counts = terrain::count_surface(*surface);
    EXPECT_GE(counts.triple_contacts, 2 * needles * (grooves + 1));
    EXPECT_EQ(counts.planes, 0u);
  }
}

TEST(LabLowerBound, IsATerrainAndSoundByBothEngines) {
  EXPECT_FALSE(lab::projections_overlap(lab::lower_bound(4, 3)));
  EXPECT_FALSE(lab::projections_overlap(lab::lower_bound_islands(6, 5)));
  expect_sound(lab::lower_bound(2, 2), "lower bound");
  expect_sound(lab::lower_bound(4, 3), "lower bound");
  expect_sound(lab::lower_bound_islands(4, 4), "islands");
}

TEST(LabLowerBound, GrowsAsTheSquare) {
  const auto report = lab::lower_bound_experiment({32, 64, 128}, {});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_NEAR(result_named(*report, "lower-bound: exponent in triangles"), 2.0, 0.05);
  EXPECT_NEAR(result_named(*report, "islands: exponent in triangles"), 2.0, 0.05);
  ASSERT_EQ(report->table.rows.size(), 6u);
}

TEST(LabLongLowerBound, GrowsAsTheSquare) {
  const auto report = lab::lower_bound_experiment({32, 64, 128, 256}, {});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_NEAR(result_named(*report, "lower-bound: exponent in triangles"), 2.0, 0.05);
  EXPECT_NEAR(result_named(*report, "islands: exponent in triangles"), 2.0, 0.05);
}

TEST(LabSweep, GrowsAsTheSquareWithoutRounds) {
  const auto report = lab::sweep_experiment({12, 50, 200}, {});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_NEAR(result_named(*report, "bundle, one sweep: exponent of crossings"), 2.0, 0.1);
  EXPECT_LT(result_named(*report, "bundle, in rounds: exponent of crossings"), 1.3);
  EXPECT_LT(result_named(*report, "spread, one sweep: exponent of crossings"), 1.2);
  ASSERT_EQ(report->table.rows.size(), 12u);
  for (std::size_t row = 0; row < 6; ++row)  // pairs of cigars cross, and next to nothing of it is boundary
    EXPECT_EQ(cell(*report, row, "pieces"), cell(*report, row, "n") + 3);
  EXPECT_FALSE(lab::sweep_experiment({2}, {}));
}

TEST(LabProfiles, HitTheBoundsExactly) {
  const auto report = lab::profiles_experiment({2, 3, 10, 1000, 20000}, {});
  ASSERT_TRUE(report) << report.error().text();
  ASSERT_EQ(report->table.rows.size(), 15u);
  for (std::size_t row = 0; row < 15; ++row) {
    const std::int64_t n = cell(*report, row, "n"), vertices = cell(*report, row, "vertices");
    const std::string& kind = std::get<std::string>(report->table.rows[row][0]);
    if (kind == "convex-chain") {
      EXPECT_EQ(vertices, 2 * n + 2);
    } else if (kind == "bowl") {
      EXPECT_EQ(cell(*report, row, "explicit"), n - 1);
    } else {
      EXPECT_EQ(vertices, 3);
    }
  }
}

TEST(LabFigures, AreSoundByBothEngines) {
  expect_sound(lab::crossing_needles(), "crossing needles");
  expect_sound(lab::crossing_blades(), "crossing blades");
  EXPECT_TRUE(lab::projections_overlap(lab::crossing_needles()));
  EXPECT_FALSE(lab::projections_overlap(lab::crossing_blades()));
  EXPECT_FALSE(lab::projections_overlap(lab::two_components()));
}

Point3 minus(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// By halving both parameters' ranges on a convex function: slow, and shares nothing with any engine.
double distance_to(Point3 p, const std::array<Point3, 3>& t) {
  const auto at = [&](double u, double v) {
    const Point3 a = minus(t[1], t[0]), b = minus(t[2], t[0]), q = minus(p, t[0]);
    const Point3 d{q.x - u * a.x - v * b.x, q.y - u * a.y - v * b.y, q.z - u * a.z - v * b.z};
    return std::sqrt(dot(d, d));
  };
  const auto least = [](double high, auto&& f) {
    double low = 0;
    for (int k = 0; k < 200; ++k) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      if (f(a) < f(b))
        high = b;
      else
        low = a;
    }
    return f((low + high) / 2);
  };
  return least(1, [&](double u) { return least(1 - u, [&](double v) { return at(u, v); }); });
}

/// Not by labels: by the distances of the surface's vertices from all three triangles.
TEST(LabFigures, FourBallsTouchThreeTriangles) {
  for (const Construction& c : {lab::crossing_needles(), lab::crossing_blades()}) {
    const auto surface = lab::surface_of(c, {});
    ASSERT_TRUE(surface) << surface.error().text();
    const Point3 o = surface->terrain().origin();
    int found = 0;
    for (Surface::Index v = 0; v < surface->subdivision().vertex_count; ++v) {
      const Point3 p = surface->vertex(v), centre{p.x + o.x, p.y + o.y, p.z + o.z};
      const auto triangles = case_of(c).triangles;
      found += std::all_of(triangles.begin(), triangles.end(),
                           [&](const auto& t) { return std::fabs(distance_to(centre, t) - c.radius) < 1e-6; });
    }
    EXPECT_EQ(found, 4);
  }
  const auto report = lab::pseudospheres_experiment({});
  ASSERT_TRUE(report) << report.error().text();
  for (std::size_t row = 0; row < report->table.rows.size(); ++row)
    EXPECT_EQ(cell(*report, row, "touching_all_three"), 4);
}

TEST(LabFigures, LastTriangleMeetsTheOthersInTwoComponents) {
  const auto report = lab::components_experiment({});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(cell(*report, 0, "components_of_last"), 2);
  EXPECT_EQ(cell(*report, 0, "closed_of_last"), 1);
}

TEST(LabFamilies, AreTerrainsOfTheSizeAskedFor) {
  for (const lab::Family& family : lab::families()) {
    for (const std::size_t size : {std::size_t(8), std::size_t(50), std::size_t(64), std::size_t(128)}) {
      if (size < family.least_triangles) continue;
      for (std::uint64_t k = 0; k < 5; ++k) {
        lab::Random random(seed(), k);
        const Construction c = family.make(random, size);
        EXPECT_LE(c.triangles.size(), size) << family.name;
        EXPECT_GE(c.triangles.size(), size / 2) << family.name;
        EXPECT_FALSE(family.terrain && lab::projections_overlap(c)) << family.name << ", case " << k;
      }
    }
  }
}

TEST(LabExperiments, GiveTheSameBytesForAnyNumberOfThreads) {
  lab::ConjectureOptions table;
  table.count = 60, table.sizes = {6, 12}, table.seed = seed();
  lab::SearchOptions search;
  search.sizes = {4}, search.steps = 6, search.restarts = 1, search.seed = seed();
  std::vector<std::string> bytes;
  for (const unsigned threads : {1u, 3u}) {
    Context context;
    context.threads = threads;
    const auto conjecture = lab::conjecture_experiment(table, context), found = lab::search_experiment(search, context),
               bound = lab::lower_bound_experiment({8, 16}, context);
    ASSERT_TRUE(conjecture && found && bound);
    bytes.push_back(bytes_of(*conjecture) + bytes_of(*found) + bytes_of(*bound));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(LabExperiments, ClimbsNeverLoseVertices) {
  lab::SearchOptions search;
  search.sizes = {4}, search.steps = 15, search.restarts = 2, search.seed = seed();
  const auto report = lab::search_experiment(search, {});
  ASSERT_TRUE(report) << report.error().text();
  for (std::size_t row = 0; row < report->table.rows.size(); ++row)
    EXPECT_GE(cell(*report, row, "vertices"), cell(*report, row, "start_vertices"));
}

TEST(LabExperiments, SmoothGroundIsLinear) {
  Terrain::Grid grid;
  grid.columns = grid.rows = 129;
  std::vector<double> heights;
  for (int j = 0; j < 129; ++j) {
    for (int i = 0; i < 129; ++i) heights.push_back(std::sin(0.7 * i + 0.2 * j) + std::sin(0.5 * j - 0.3 * i));
  }
  const auto terrain = Terrain::from_grid(grid, heights);
  ASSERT_TRUE(terrain);
  const auto report = lab::crops_experiment(*terrain, {0.5}, {});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->table.rows.size(), 4u);
  EXPECT_NEAR(result_named(*report, "radius 0.5: exponent"), 1.0, 0.05);
  const auto mesh = lab::terrain_of(lab::crossing_needles());
  ASSERT_TRUE(mesh);
  EXPECT_EQ(lab::crops_experiment(**mesh, {1}, {}).error().code, ErrorCode::input);
}

TEST(LabExperiments, RefuseWithAReason) {
  for (const std::size_t n : {0u, 2u, 6u, 2000u})
    EXPECT_EQ(lab::lower_bound_experiment({n}, {}).error().code, ErrorCode::usage);
  EXPECT_EQ(lab::profiles_experiment({1}, {}).error().code, ErrorCode::usage);
  lab::ConjectureOptions table;
  table.sizes = {0};
  EXPECT_EQ(lab::conjecture_experiment(table, {}).error().code, ErrorCode::usage);
  table.sizes = {}, table.count = 5;
  EXPECT_EQ(lab::conjecture_experiment(table, {}).error().code, ErrorCode::usage);
  lab::SearchOptions search;
  search.sizes = {1};
  EXPECT_EQ(lab::search_experiment(search, {}).error().code, ErrorCode::usage);
  const std::atomic<bool> stop = true;
  Context context;
  context.cancel = &stop;
  EXPECT_EQ(lab::lower_bound_experiment({8}, context).error().code, ErrorCode::cancelled);
  EXPECT_EQ(lab::conjecture_experiment({}, context).error().code, ErrorCode::cancelled);
  EXPECT_EQ(lab::search_experiment({}, context).error().code, ErrorCode::cancelled);
}

/// A limit that no terrain keeps: all are late, none is failed.
TEST(LabExperiments, CountWhatIsLate) {
  std::atomic<int> cancelled = 0;
  EXPECT_TRUE(lab::run_limited({}, 0.01, 3, [&](std::size_t, const Context& context) {
    while (!context.cancelled()) {
    }
    ++cancelled;
  }));
  EXPECT_EQ(cancelled, 3);
}

TEST(LabFit, FindsTheExponent) {
  std::vector<Point> points;
  for (const double x : {3.0, 10.0, 70.0}) points.push_back({x, 5 * std::pow(x, 1.75)});
  EXPECT_NEAR(lab::fitted_exponent(points), 1.75, 1e-12);
  EXPECT_TRUE(std::isnan(lab::fitted_exponent(std::vector<Point>{{2, 3}, {2, 5}})));
}

TEST(LabReport, QuotesInTables) {
  lab::Table table{{"a", "b"}, {{std::string("x,\"y\""), 0.1}}};
  EXPECT_EQ(lab::csv_of(table), "a,b\n\"x,\"\"y\"\"\",0.1\n");
  EXPECT_EQ(lab::text_of(table), "    a    b\nx,\"y\"  0.1");
}

/// 10,000 terrains. Records up to n = 32 are confirmed by both engines; above, the engine by cells has more vertices
/// than there are in some.
TEST(LabLongConjecture, NothingComesNearToBreakingIt) {
  lab::ConjectureOptions options;
  options.count = std::size_t(10000 * std::max(1.0, effort()));
  const auto report = lab::conjecture_experiment(options, {});
  ASSERT_TRUE(report) << report.error().text();
  for (std::size_t row = 0; row < report->table.rows.size(); ++row) {
    EXPECT_EQ(cell(*report, row, "failed"), 0) << "row " << row;
    const bool terrain = std::get<std::string>(report->table.rows[row][1]) == "yes";
    if (terrain && cell(*report, row, "n") == 32) {
      EXPECT_LT(std::get<double>(report->table.rows[row].back()), 0.4);
    }
  }
  for (const lab::Family& family : lab::families()) {
    const std::string name = std::string(family.name) + ": exponent of the most vertices";
    const bool fitted =
        std::any_of(report->results.begin(), report->results.end(), [&](const auto& r) { return r.first == name; });
    if (!fitted || !family.terrain) continue;
    EXPECT_LT(result_named(*report, name), 2.05) << name;
  }
}

}  // namespace

}  // namespace krepl::test
