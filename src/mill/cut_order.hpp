#pragma once

#include <vector>

#include "mill/links.hpp"

namespace krepl::mill {

/// The same way from its end to its start.
void reverse(Cut& cut);

/// Puts cuts of lines into an order of short ways: always the nearest next, closed ones from their place that is nearest, open
/// ones from their nearer end. Of many cuts only some of those that follow are looked at.
void order_cuts(std::vector<Cut>& cuts);

}  // namespace krepl::mill
