#pragma once

#include "drop_terrains.hpp"
#include "krepl/cutter.hpp"

namespace krepl::test {

/// A tool as its text has it, with a profile of the test's own.
struct TestTool {
  Cutter cutter;
  long double height(long double distance) const;
};

/// Any kind but a ball, of the given radius; corners from 1e-6 of the radius to all of it, angles from 1 to 179
/// degrees, now and then 90.
TestTool any_tool(Random& random, double radius);

/// The tip's height over a place by search: over each plane along its steepest line, over each side along it, golden
/// sections of a concave function; and over each corner. Nothing if no triangle is within R. `exactly`: in quadruple
/// precision.
std::optional<double> brute_tip(const DropCase& c, Point place, const Cutter& cutter, bool exactly);

/// What is wrong with a contact, or nothing: its height; whether the touched point lies on the feature and on the tool.
std::optional<std::string> cutter_fault(const DropCase& c, Point place, const Cutter& cutter,
                                        const DropCutter::Contact& contact);

/// The most that any of so many random points of the terrain is inside a tool that rests at this height.
double deepest_sample(const DropCase& c, Point place, const Cutter& cutter, double tip, int samples, Random& random);

}  // namespace krepl::test
