#pragma once

#include <string>

#include "input/network_reader.hpp"
#include "krepl/shape.hpp"
#include "output/zone_file.hpp"
#include "verbs.hpp"

namespace krepl::app {

/// The options of `krepl buffer` that look at features one by one and at their fields.
struct FeatureOptions {
  bool per_feature = false;
  std::string radius_field, dissolve_by, owner;
};

void add_feature_options(Verb& verb, FeatureOptions& options);

/// True for a --radius that is neither a number nor a list of them but looks like an expression of fields.
bool is_radius_expression(const std::string& text);

/// Everything that `krepl buffer` was told, where it has to look at features.
struct FeatureJob {
  FeatureOptions features;
  input::NetworkRequest input;
  std::string output, radius, engine;
  output::ZoneFormat format;
  output::ZoneFileOptions file;
  ShapeOptions shape;  ///< but for the distance
};

/// Whether the job needs features at all; if not, the zone is one of the whole layer at given radii.
bool needs_features(const FeatureOptions& options, const std::string& radius);

/// Reads, computes, writes and tells. Returns the exit status.
int run_feature_buffer(const FeatureJob& job, Session& session);

}  // namespace krepl::app
