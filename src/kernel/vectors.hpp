#pragma once

#include <cmath>

#include "krepl/point.hpp"

/// Vectors in the plane and in space; rooms take these names in with `using namespace vectors`.
namespace krepl::vectors {

inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
inline Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
inline double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
/// Twice the area of a triangle, positive if it runs counter-clockwise; rounded, see kernel/orientation.hpp for the sign.
inline double cross(Point o, Point a, Point b) { return cross(a - o, b - o); }
inline double length(Point a) { return std::hypot(a.x, a.y); }
inline double distance(Point a, Point b) { return length(a - b); }

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
