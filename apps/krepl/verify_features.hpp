#pragma once

#include <vector>

#include "feature_buffer.hpp"
#include "verify/input_parts.hpp"
#include "verify/shape_oracle.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::app {

/// Zones of features or groups to be checked one by one, or shares of owners.
struct FeatureVerification {
  std::string result;
  verify::InputRequest input;
  FeatureOptions features;
  std::vector<double> radii;  ///< as given; none where the result tells them
  ShapeOptions shape;         ///< but for the distance
  double max_error = 0;
  std::uint64_t samples = 0;
};

/// Prints one table of checks. Returns the exit status.
int verify_features(const FeatureVerification& job, Session& session);

/// What a zone of these options has to be.
verify::ShapeQuestion shape_question(const ShapeOptions& shape, double radius);
/// How far its border may be off without --max-error: parabolas in that of a one-sided zone are chords (docs/shape.md).
double border_chords(const ShapeOptions& shape, double radius);

/// A table of checks on standard output.
void print_checks(Session& session, const std::vector<verify::Check>& checks);

}  // namespace krepl::app
