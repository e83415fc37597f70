#pragma once

#include <memory>
#include <span>

#include "krepl/context.hpp"
#include "krepl/curve_network.hpp"
#include "krepl/error.hpp"
#include "krepl/shape.hpp"
#include "krepl/zone.hpp"

namespace krepl {

/// The zone of lines and polygons with circular arcs: all places within the radius of them, polygons filled
/// (docs/arcs.md). Its boundary is made of segments, arcs of the radius about vertices, and arcs of r + R and r - R
/// about the centre of an arc of radius r (Zone::Piece::from_arc).
///
/// As exact as compute_zone of a Network: the topology is that of an instance whose radius is 2^-48 S (or 4 units in
/// the last place of the coordinates) above the given one and whose parts are moved by far less. Arcs that are less
/// than 2^-44 S high count as their chords. Without arcs this is the same zone as compute_zone's, up to rounding and
/// the order of pieces. Errors: radius not finite and positive, or finer than the coordinates' resolution; cancelled; a
/// result that does not certify. Expected O(n log n); some 100 µs an element.
Result<Zone> compute_zone(std::shared_ptr<const CurveNetwork> network, const ZoneOptions& options,
                          const Context& context = {});

/// The same with a radius for each part of the network (part_radii[p] for network->straight().part(p)), as compute_zone of a Network
/// has it: the union of the parts' own zones; what parts share has the largest of their radii.
Result<Zone> compute_zone(std::shared_ptr<const CurveNetwork> network, std::span<const double> part_radii,
                          const Context& context = {});

/// The same in one of the shapes of krepl/shape.hpp, as compute_shape of a Network makes them, without chords: caps and
/// joins (what is straight beside an arc goes on beyond its centre if the radius is more), shrunk polygons and rings
/// (Zone::Role::input: along the input's own segments and arcs). With the defaults and a positive
/// distance the same as compute_zone. Polygons of one feature count by the even-odd rule; where a feature's sides run
/// along each other within 2^-46 of the extent, an even number of them is no border.
///
/// Errors: those of compute_shape and compute_zone; usage for one-sided zones.
Result<Zone> compute_shape(std::shared_ptr<const CurveNetwork> network, const ShapeOptions& options,
                           const Context& context = {});

/// As check_rings of a Network. Places nearer to each other than 2^-46 of the extent count as one.
Result<std::vector<RingFault>> check_rings(const CurveNetwork& network, const Context& context = {});

}  // namespace krepl
