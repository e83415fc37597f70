#pragma once

#include <ogr_geometry.h>

#include <memory>

#include "krepl/owners.hpp"
#include "output/linear.hpp"
#include "output/ogr_geometry.hpp"

namespace krepl::output {

/// An owner's share as a MULTISURFACE with true arcs; parabolas are the chords that the share has.
std::unique_ptr<OGRGeometry> owner_curve_geometry(const OwnerZone& zone);

/// The same with chords for arcs too: a MULTIPOLYGON.
std::unique_ptr<OGRGeometry> owner_linear_geometry(const OwnerZone& zone, Linearizer& linearizer, OuterSense sense);

}  // namespace krepl::output
