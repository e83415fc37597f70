#pragma once

#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/simulation.hpp"

namespace krepl::output {

/// What a simulation left, by the file's extension or `format`:
///   tif   GeoTIFF of 64-bit floats, the northernmost row first: band 1 the height of the material, band 2 the material
///   above
///         the part, band 3 the depth of gouges; NaN beside the part in bands 2 and 3. `crs` as WKT, or empty
///   png   relief lit from the north-west: grey what no move has cut, sand what is at the part within 1 % of `full`,
///   from there
///         over green to blue the material left on the part up to `full`, red gouges; white beside the block.
///         Small blocks are drawn with several pixels a dexel
struct SimulationFileOptions {
  std::string format;
  std::string crs;
  /// Material left that is drawn in the last colour; 0: the 98th of a hundred parts of the dexels have less.
  double full = 0;
};
/// Errors: another format (usage), a file that cannot be written.
Status write_simulation(const std::string& path, const Simulation& simulation, const SimulationFileOptions& options);

/// The format that write_simulation would take. Errors: as there.
Result<std::string> simulation_format(const std::string& path, const std::string& format);

}  // namespace krepl::output
