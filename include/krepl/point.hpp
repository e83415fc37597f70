#pragma once

namespace krepl {

/// A place or a vector in the plane, in the input's own unit (metres, millimetres, ...).
struct Point {
  double x = 0;
  double y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// A place or a vector in space; z points up.
struct Point3 {
  double x = 0;
  double y = 0;
  double z = 0;
  friend bool operator==(const Point3&, const Point3&) = default;
};

}  // namespace krepl
