// A gap between two upright walls that narrows until the ball does not fit any more: what is left at its end, by closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "krepl/mill.hpp"
#include "mill/path_check.hpp"
#include "mill/plunges.hpp"

namespace krepl::test {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Two blocks on level ground, 1 high; the walls between them make an angle of twice `half` about a direction, from `apex` on.
struct Gap {
  Point3 apex{0.00003, 0.00007, 0};
  double half, turn;

  Point3 place(double angle, double away, double z) const {
    return {apex.x + away * std::cos(angle), apex.y + away * std::sin(angle), z};
  }
  /// Where a ball lies on the ground and touches both walls.
  Point3 end(double radius) const { return place(turn, radius / std::sin(half), radius); }

  std::shared_ptr<const Terrain> part() const {
    const double quarter = std::numbers::pi / 2;
    std::vector<Point3> points = {place(turn, 0, 1),           place(turn + half, 2, 1), place(turn + quarter, 0.3, 1),
                                  place(turn - half, 2, 1),    place(turn - quarter, 0.3, 1), {-0.4, -0.4, 0},
                                  {2.2, -0.4, 0},              {2.2, 1, 0},              {-0.4, 1, 0}};
    std::vector<std::array<Terrain::Index, 3>> triangles = {{0, 1, 2}, {0, 4, 3}, {5, 6, 7}, {5, 7, 8}};
    auto made = Terrain::from_triangles(std::move(points), std::move(triangles));
    return made ? std::make_shared<const Terrain>(std::move(*made)) : nullptr;
  }
};

/// The greatest distance from the path of places that a ball smaller by the scallop, at the end of the gap for the ball `contact`, reaches in
/// directions between those of what that touches: at most the tool's radius if the scallop is kept.
double farthest(const Gap& gap, const ToolPath& path, double contact, double scallop) {
  const Point3 end = gap.end(contact);
  const double quarter = std::numbers::pi / 2;
  constexpr int count = 16;
  std::vector<Point3> near;
  walk(path, 0.002, 1, [&](Point3 p, const Move& m) {
    if (m.kind != MoveKind::rapid && std::hypot(p.x - end.x, p.y - end.y, p.z - end.z) < 2 * contact) near.push_back(p);
  });
  double worst = 0;
  for (int i = 0; i <= count; ++i)
    for (int j = 0; j <= count; ++j) {
      // Towards the walls and between, from level down to the ground.
      const double around = gap.turn + std::numbers::pi + (2.0 * i / count - 1) * (quarter - gap.half), down = quarter * j / count;
      const Point3 x{end.x + (contact - scallop) * std::cos(down) * std::cos(around),
                     end.y + (contact - scallop) * std::cos(down) * std::sin(around), end.z - (contact - scallop) * std::sin(down)};
      double least = 1e300;
      for (const Point3 p : near) least = std::min(least, std::hypot(p.x - x.x, p.y - x.y, p.z - x.z));
      worst = std::max(worst, least);
    }
  return worst;
}

TEST(Gaps, AreProvenUpToTheirNarrowEnds) {
  for (const double turn : {5.0, 17.0}) {
    const Gap gap{.half = 2 * degree, .turn = turn * degree};
    const auto part = gap.part();
    ASSERT_NE(part, nullptr);
    ParallelOptions o;
    o.tool.radius = 0.05, o.scallop = 0.02, o.accuracy.tolerance = 0.005, o.accuracy.control_point = ControlPoint::centre;
    const auto milled = mill_parallel(part, o);
    ASSERT_TRUE(milled) << milled.error().text();
    EXPECT_EQ(milled->report.open_places, 0u) << turn;
    const double contact = o.tool.radius + 4 * o.accuracy.unit;  // what a larger ball does not enter is no gap
    EXPECT_LE(farthest(gap, milled->path, contact, o.scallop), o.tool.radius) << turn;
    const PathCheck check = check_path(*part, part, milled->path, o.tool.radius, o.tool.radius + o.accuracy.tolerance, -1e300, 0.02, 3,
                                       [](const Move&) { return false; });
    EXPECT_LE(check.deepest, 1e-9 * part->extent()) << turn;
  }
}

/// What passes do: they end before the gap does, by more than the scallop.
TEST(Gaps, GetPlungesWherePassesDoNotReachTheirEnds) {
  for (const double turn : {0.0, 17.0, 45.0}) {
    const Gap gap{.half = 2 * degree, .turn = turn * degree};
    const auto part = gap.part();
    ASSERT_NE(part, nullptr);
    ParallelOptions o;
    o.tool.radius = 0.05, o.step_over = 1, o.accuracy.control_point = ControlPoint::centre;
    const double scallop = 0.02, room = 4 * o.accuracy.unit, contact_radius = o.tool.radius + room;
    const auto plan = mill::make_plan(*part, o);
    ASSERT_TRUE(plan) << plan.error().text();
    const auto cutter = DropCutter::build(part, plan->radius), contact = DropCutter::build(part, contact_radius);
    ASSERT_TRUE(cutter && contact);
    const Point3 origin = part->origin(), end = gap.end(contact_radius);
    const Point3 from = gap.place(gap.turn, 1.9, contact_radius), to = gap.place(gap.turn, contact_radius / std::sin(gap.half) + 1.5 * scallop, contact_radius);
    const mill::Plunges plunges(*cutter, *contact, {o.tool.radius, room, scallop - room, 0, true}, *plan, o.accuracy.unit);
    const auto pass = [&](mill::CoverProof& proof) { proof.add(mill::Cut{from, {{MoveKind::line, ArcPlane::xy, to, {}, 1}}}); };
    // In the gap, about its end; not on the blocks.
    const auto is_of_interest = [&](Point3 p, double within) {
      const double away = std::hypot(p.x + origin.x - end.x, p.y + origin.y - end.y);
      return away < 0.03 + 2 * within && p.z + origin.z - within < 0.9;
    };
    std::vector<mill::Cut> cuts;
    std::vector<Point3> open;
    std::vector<std::size_t> tiles = mill::CoverProof(*contact, {o.tool.radius, room, scallop - room, 0, true}).all_tiles();
    ASSERT_TRUE(plunges.serve(pass, tiles, is_of_interest, {}, cuts, open));
    EXPECT_TRUE(open.empty()) << open.size() << " at " << turn;
    EXPECT_FALSE(cuts.empty()) << turn;
    EXPECT_LE(cuts.size(), 8u) << turn;
    ToolPath path;
    path.start = from, path.moves.push_back({MoveKind::line, ArcPlane::xy, to, {}, 1});
    EXPECT_GT(farthest(gap, path, contact_radius, scallop), o.tool.radius) << turn;
    for (const mill::Cut& cut : cuts) {
      EXPECT_TRUE(cut.moves.empty());
      const double height = std::max(cutter->at({cut.start.x - origin.x, cut.start.y - origin.y}).height, plan->floor) + origin.z;
      EXPECT_GE(cut.start.z, height);
      EXPECT_LE(cut.start.z, height + 1.001 * o.accuracy.unit);
      path.moves.push_back({MoveKind::rapid, ArcPlane::xy, {cut.start.x, cut.start.y, 2}, {}, 0});
      path.moves.push_back({MoveKind::line, ArcPlane::xy, cut.start, {}, 1});
    }
    EXPECT_LE(farthest(gap, path, contact_radius, scallop), o.tool.radius) << turn;
    // Beyond its end there is nothing to be found.
    const double side = 0.001;
    const Point3 beyond = gap.place(gap.turn, contact_radius / std::sin(gap.half) - 0.02, contact_radius);
    const mill::Plunges::Found found = plunges.find({beyond.x - origin.x, beyond.y - origin.y, beyond.z - origin.z}, side);
    EXPECT_FALSE(found.at);
    EXPECT_TRUE(found.is_empty);
  }
}

}  // namespace
}  // namespace krepl::test
