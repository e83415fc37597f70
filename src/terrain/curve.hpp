#pragma once

#include "krepl/surface.hpp"

namespace krepl::terrain {

/// True if both features are edges in one line of space, so that their patches join smoothly wherever they meet.
bool are_in_one_line(const Terrain& terrain, Surface::Index f, Surface::Index g);

/// What kind of curve an edge of a surface is, from the features that the ball touches along it (engines.md, section 3).
Surface::Curve curve_kind(const Terrain& terrain, const Surface::Edge& edge);

/// The point of the edge's curve next to one that is near it; of a valley, no farther from that than `reach`.
Point3 project_to_curve(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 near, double reach);

/// True if a ball about p touches what it touches along the edge, to within `tolerance`.
bool is_on_edge(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 p, double tolerance);

/// Height of the ball's centre over the place of p when it rests on the edge's features: on that by which it is nearer
/// to p, where they differ.
double height_on_edge(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 p);

}  // namespace krepl::terrain
