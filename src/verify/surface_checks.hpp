#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "input/subdivision_file.hpp"
#include "verify/solid.hpp"
#include "verify/tally.hpp"

namespace krepl::verify {

using input::SubdivisionFile;

/// What the checks of one surface share. Coordinates of the file are relative to the solid's origin.
struct SurfaceCase {
  using Index = SubdivisionFile::Index;
  static constexpr Index none = SubdivisionFile::none;

  const SubdivisionFile& file;
  const Solid& solid;
  double radius;
  double scale;
  double tolerance;
  std::uint64_t samples;
  std::uint64_t seed;
  const Context& context;

  std::vector<Shape> shape;       ///< per feature
  std::vector<FeatureKey> key;    ///< per feature
  std::vector<Index> forward;     ///< per edge: the half-edge along its points
  std::vector<Index> loop;        ///< per half-edge
  std::vector<Index> loop_start;  ///< per loop: a half-edge
  std::vector<bool> loop_outer;   ///< per loop: it is the outer one of its face
  std::vector<Index> component;   ///< per vertex: its component, numbered from 0
  std::size_t components = 0;
  /// Per edge: how far its chords may be from its true curve in the plane, and the area between chords and curve
  /// (positive where the curve runs right of the chord).
  std::vector<double> sag, bulge;

  Index label(Index face) const { return file.faces[face].feature; }
  Index left_face(Index edge) const { return file.half_edges[forward[edge]].face; }
  Index right_face(Index edge) const { return file.half_edges[file.half_edges[forward[edge]].twin].face; }
  Index left_label(Index edge) const { return label(left_face(edge)); }
  Index right_label(Index edge) const { return label(right_face(edge)); }
  Space<double> point(std::uint64_t i) const { return Space<double>(file.points[i]); }
};

/// Rules that hold or do not; the first one broken is told.
class Rules {
 public:
  explicit Rules(std::string name) { check_.name = std::move(name); }
  bool require(bool right, const char* what, std::size_t item) {
    ++check_.tested;
    if (right) return true;
    if (check_.violations++ == 0) check_.note = std::string(what) + " " + std::to_string(item);
    return false;
  }
  const Check& check() const { return check_; }
  bool ok() const { return check_.ok(); }

 private:
  Check check_;
};

/// Fills forward, loop, loop_start, loop_outer and component. What they hold is of use only if the check passed.
Check check_topology(SurfaceCase& surface);
/// Features are those of the input, edges have kinds and features that fit, labels left and right of them agree.
Check check_labels(const SurfaceCase& surface);
/// Along edges; fills sag and bulge.
std::vector<Check> check_edges(SurfaceCase& surface);
Check check_vertices(const SurfaceCase& surface);
/// Sense of loops, edges that cross, places of components. The area of the projection comes along.
std::vector<Check> check_embedding(const SurfaceCase& surface, double& area);
/// Places at which the ball is let down.
std::vector<Check> check_samples(const SurfaceCase& surface);

}  // namespace krepl::verify
