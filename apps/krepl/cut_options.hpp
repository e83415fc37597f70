// What `krepl section` and `krepl contour` have in common.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "krepl/section.hpp"
#include "output/cut_file.hpp"
#include "terrain_options.hpp"
#include "verbs.hpp"

namespace krepl::app {

struct CutOptions {
  TerrainOptions terrain;
  std::string output, radius, format, max_error;
};

struct CutPlan {
  double radius = 0;
  input::TerrainRequest request;
  output::CutFormat format;
  output::CutFileOptions file;
};

/// A surface ready to be cut.
struct CutInput {
  std::shared_ptr<const Terrain> terrain;
  std::unique_ptr<SurfaceCutter> cutter;
};

void add_cut_options(Verb& verb, CutOptions& options, const char* result);
Result<CutPlan> cut_plan(const CutOptions& options);
/// Reads the terrain and computes its surface; null after a failure that has been told, whose exit status goes to
/// `status`.
std::unique_ptr<CutInput> read_and_compute(const CutOptions& options, CutPlan& plan, Session& session, int& status);
/// The numbers of a list separated by commas, all finite. Errors: usage.
Result<std::vector<double>> parse_numbers(const std::string& option, const std::string& text);

}  // namespace krepl::app
