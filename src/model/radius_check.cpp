#include "model/radius_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace krepl {

std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

std::optional<Error> refuse_radius(const Terrain& terrain, double radius, double finest, const std::string& otherwise) {
  if (!std::isfinite(radius) || radius <= 0) {
    return Error{ErrorCode::usage, "the radius is " + shown(radius), "", "give a positive, finite number"};
  }
  const double scale = std::max(radius, terrain.extent());
  if (scale > 1e100 || radius < 1e-100) {
    return Error{ErrorCode::input, "coordinates or radius are beyond 1e100, or the radius is below 1e-100", "",
                 "scale the input"};
  }
  if (radius < finest * scale) {
    return Error{ErrorCode::usage, "the radius " + shown(radius) + " is too fine for an extent of " + shown(scale), "",
                 "use at least " + shown(finest * scale) + otherwise};
  }
  return std::nullopt;
}

}  // namespace krepl
