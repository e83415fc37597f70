#include "mill/grown_cutter.hpp"

#include <cmath>
#include <numbers>

namespace krepl::mill {

Result<Cutter> grow(const Cutter& cutter, double allowance, double room) {
  const double by = allowance + room, diameter = cutter.diameter() + 2 * by;
  switch (cutter.kind()) {
    case Cutter::Kind::ball:
      return Cutter::ball(diameter);
    case Cutter::Kind::flat:
      return allowance > 0 ? Cutter::bull_nose(diameter, by) : Cutter::flat(diameter);
    case Cutter::Kind::bull_nose:
      return Cutter::bull_nose(diameter, cutter.corner_radius() + by);
    case Cutter::Kind::cone:
      return by > 0 ? Cutter::taper(diameter, cutter.angle(), by) : cutter;
    case Cutter::Kind::taper:
      break;
  }
  return Cutter::taper(diameter, cutter.angle(), cutter.corner_radius() + by);
}

double roundness(const Cutter& cutter, double allowance) {
  if (cutter.kind() == Cutter::Kind::flat) return allowance > 0 ? 1 : std::numbers::sqrt2;
  return cutter.angle() > 0 ? 1 / std::cos(cutter.angle() * (std::numbers::pi / 720)) : 1;
}

}  // namespace krepl::mill
