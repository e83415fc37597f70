#pragma once

#include <cmath>

#include "krepl/point.hpp"

/// Vectors in space; rooms take these names in with `using namespace vectors`.
namespace krepl::vectors {

inline Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 operator*(double s, Point3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point3 cross(Point3 a, Point3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Point3 a) { return std::hypot(a.x, a.y, a.z); }
inline Point3 unit(Point3 a) { return (1 / length(a)) * a; }
inline double distance(Point3 a, Point3 b) { return length(a - b); }

}  // namespace krepl::vectors
