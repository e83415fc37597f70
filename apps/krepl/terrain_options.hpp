#pragma once

#include <string>

#include "command_line.hpp"
#include "input/terrain_reader.hpp"
#include "krepl/error.hpp"

namespace krepl::app {

class Session;

/// The terrain to read, as every verb that takes one has it on its command line.
struct TerrainOptions {
  input::TerrainRequest request;
  std::string z_scale, split, up;  ///< as given

  std::string name() const;  ///< as messages have it
  /// One of the options that add_reading_options declares that is given; null if none is.
  const char* given_reading_option() const;
};

/// Declares IN (or the option `name` in its place) and the options --crs, --to-crs, --z-scale, --split, --band and --up.
/// `options` must live until the verb has run.
void add_terrain_options(Verb& verb, TerrainOptions& options, const std::string& name = "IN");

/// Declares --z-scale, --split, --band and --up alone, for a verb that names its terrain in its own way. `where` begins their help
/// texts where not every input of the verb is a terrain.
void add_reading_options(Verb& verb, TerrainOptions& options, const std::string& where = "");

/// That an option was given for an input that is no terrain.
Error for_terrains_only(const char* option);

/// What the options mean; an Error of code usage names what is wrong. To be called before anything is read.
Result<input::TerrainRequest> terrain_request(const TerrainOptions& options);

/// Notes of the file and, with --verbose, what was found and left out on the way in.
void tell_terrain(const input::TerrainFile& file, const std::string& name, double seconds, Session& session);

}  // namespace krepl::app
