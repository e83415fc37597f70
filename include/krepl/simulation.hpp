#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/cutter.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"
#include "krepl/terrain.hpp"
#include "krepl/tool_path.hpp"

namespace krepl {

/// A block of material about a part and how finely it is looked at. Lengths in the unit of the part.
struct StockOptions {
  double cell = 0;    ///< distance of dexels, greater than zero
  double margin = 0;  ///< how far the block reaches beyond the part's bounding rectangle, zero or more
  /// Height of its upper side, in the part's own coordinates; NaN (the default): that of the part's highest point.
  double top = std::numeric_limits<double>::quiet_NaN();
};

/// What a tool path leaves of a block of material, on vertical lines (*dexels*) at equal distances, and how that
/// compares with the part (docs/simulate.md).
///
/// For each dexel and each move the lowest point of the swept tool is found in closed form, in double precision or
/// quadruple where that would lose digits: heights are correct to 1e-12 S for straight moves, S being the largest of R
/// and the coordinates. Arcs and helices are replaced by chords that are off by arc_error() at most, and so are depths.
///
/// What is said of a dexel is true of the dexel: what lies between dexels is not looked at. Where the part has the
/// slope s, a gouge between dexels is deeper than that of the nearest dexel by cell sqrt((1 + s^2) / 2) at most.
class Simulation {
 public:
  /// A place and a value; of moves the number within the path.
  struct Extreme {
    double value = 0;  ///< 0 if there is none
    Point3 place;      ///< in the part's own coordinates
    std::size_t move = 0;
  };
  struct Report {
    std::size_t dexels = 0;            ///< in the block
    std::size_t dexels_over_part = 0;  ///< above some triangle
    /// How deep a point of the part's upper side has been inside the tool: the least way out of the tool, whose shank
    /// reaches up without end. Depths below depth_tolerance() are not told from 0.
    Extreme gouge;
    std::size_t gouged_dexels = 0;
    /// Material left above the part, measured vertically: tall beside steep walls even if it is thin.
    Extreme rest;
    /// How deep a point of the surface that the material had at the time has been inside the tool in a rapid move.
    Extreme rapid_cut;
    std::size_t cutting_rapids = 0;  ///< rapid moves that cut
    double stock_volume = 0, removed_volume = 0;
    double cutting_length = 0, rapid_length = 0;
    double cutting_minutes = 0;  ///< of all moves but the rapid ones, at their feeds; acceleration is not looked at
  };

  /// `path` in the coordinates of the part, its control point as ToolPath has it for this cutter.
  /// `before`: what another path has left of the same block, to go on with; null: the whole block.
  /// Errors: cell or margin out of range, a top that is not finite or below the part's lowest point, more than 2^31
  /// dexels (usage); `before` of another block (usage); a move with coordinates that are not finite (input); cancelled.
  /// Time: dexels below the tool, summed over all moves, some 50 ns each on one core, less where the tool is above what
  /// is left; 24 bytes a dexel.
  static Result<Simulation> run(const ToolPath& path, const Terrain& part, const Cutter& cutter,
                                const StockOptions& stock, const Context& context = {},
                                const Simulation* before = nullptr);

  const Report& report() const { return report_; }
  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  double cell() const { return cell_; }
  /// In the part's own coordinates, as all heights here. Row 0 has the least y.
  Point place(std::size_t column, std::size_t row) const {
    return {first_.x + double(column) * cell_, first_.y + double(row) * cell_};
  }
  /// By column + row * columns(): height of the material that is left; of the part, -infinity beside it; depth of the
  /// deepest gouge.
  const std::vector<double>& left() const { return left_; }
  const std::vector<double>& part() const { return part_; }
  const std::vector<float>& gouge() const { return gouge_; }
  double stock_top() const { return top_; }
  double stock_bottom() const { return bottom_; }  ///< the part's lowest point
  double arc_error() const { return arc_error_; }
  double depth_tolerance() const { return tolerance_; }

 private:
  class Work;
  Simulation() = default;
  template <class Found>
  void conclude(const std::vector<Found>& found, Point3 origin);

  std::size_t columns_ = 0, rows_ = 0;
  double cell_ = 0, top_ = 0, bottom_ = 0, arc_error_ = 0, tolerance_ = 0;
  Point first_;
  std::vector<double> left_, part_;
  std::vector<float> gouge_;
  Report report_;
};

}  // namespace krepl
