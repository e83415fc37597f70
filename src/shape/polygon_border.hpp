#pragma once

#include <memory>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/shape.hpp"
#include "zone/shaped_rings.hpp"

namespace krepl::shape {

using zone::Index;
using zone::none;

/// The network that zones inside polygons are made of: the border of each feature's inside by the even-odd rule. The
/// network itself where all rings are sound, else its sides cut where they meet, without those that have the inside on
/// both sides. Null if no border is left.
Result<std::shared_ptr<const Network>> border_network(std::shared_ptr<const Network> network, const Context& context);

/// The border of the union of all polygons of the network as rings with the inside on their left, relative to the
/// origin of `target`; sources are its segments where they are segments of it, else `none`.
Result<zone::ShapedRings> union_border(const Network& network, const Network& target, const Context& context);

}  // namespace krepl::shape
