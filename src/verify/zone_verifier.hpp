#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "input/result_file.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "verify/obstacle.hpp"
#include "verify/shape_oracle.hpp"

namespace krepl::verify {

struct ZoneCheckOptions {
  double radius = 0;
  /// Of a band, which leaves out what is no farther than this from the input; 0: a whole zone.
  double inner = 0;
  /// Deviation that a linear format was allowed (absolute, 0 for true curves); added to every tolerance.
  double max_error = 0;
  /// Of zones of other shapes: arcs of the boundary may lie on arcs of the input (rings), or across their centres (flat
  /// caps and joins). Set by check_shape.
  bool along = false, beyond = false;
  /// Number of points whose membership is tested; 0: as many as take some seconds.
  std::uint64_t samples = 0;
  /// Factor on the number of samples of all checks, greater than 0.
  double effort = 1;
  std::uint64_t seed = 1;
};

/// The outcome of one kind of check.
struct Check {
  std::string name;
  std::uint64_t tested = 0;      ///< how many samples, pieces or rings were looked at
  std::uint64_t violations = 0;  ///< how many of them broke the limit
  double worst = 0;              ///< the largest deviation found, in the input's unit (its square for areas)
  double limit = 0;              ///< the largest deviation allowed
  Point where;                   ///< place of the worst deviation
  std::string note;              ///< what else is worth saying
  bool ok() const { return violations == 0; }
};

struct ZoneReport {
  double radius = 0, inner = 0;
  double scale = 0;      ///< S of the accuracy contract: the largest of radius and extent
  double tolerance = 0;  ///< 1e-9 S, or 64 steps of the coordinates where that is coarser
  double area = 0;
  double perimeter = 0;
  std::size_t polygons = 0, holes = 0, pieces = 0, arcs = 0;
  std::vector<Check> checks;
  bool ok() const {
    for (const Check& c : checks)
      if (!c.ok()) return false;
    return true;
  }
};

/// Checks one zone against its input by brute force; see docs/verification.md for what each check proves.
/// Errors: radius not finite and positive, a coordinate of the result not finite, no input, cancelled.
Result<ZoneReport> check_zone(const std::vector<input::ResultPolygon>& polygons, const Obstacle& obstacle,
                              const ZoneCheckOptions& options, const Context& context = {});

/// The same for zones of other shapes; the radius is that of the question. The result may be empty.
Result<ZoneReport> check_shape(const std::vector<input::ResultPolygon>& polygons, const std::vector<InputPart>& parts,
                               const ShapeQuestion& question, const ZoneCheckOptions& options,
                               const Context& context = {});

}  // namespace krepl::verify
