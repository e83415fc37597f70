#pragma once

#include <string>
#include <vector>

#include "feature_buffer.hpp"
#include "input/feature_reader.hpp"
#include "krepl/network.hpp"

namespace krepl::app {

/// Features that share a zone.
struct FeatureGroup {
  std::vector<std::size_t> features;
  const OGRFeature* row = nullptr;  ///< whose attributes the zone keeps; null for none
  std::string name;                 ///< what messages call it
};

/// A zone for each group, at each of the radii or with the radii of the features.
struct GroupJob {
  const FeatureJob& job;
  const input::FeatureData& data;
  const std::vector<FeatureGroup>& groups;
  const std::vector<double>& radii;  ///< none where features have their own
};

std::vector<std::size_t> all_features(const input::FeatureData& data);
/// Adds the features' parts to a network, and to `radii` the radius of each part where features have their own.
void add_features(const input::FeatureData& data, const std::vector<std::size_t>& features, Network::Builder& builder,
                  std::vector<double>& radii);

/// Computes the zones block by block on all threads, writes them in order. Returns the exit status.
int write_groups(const GroupJob& job, Session& session);

/// Notes about a file that was written.
void tell(const output::ZoneFileReport& report, const FeatureJob& job, Session& session);

}  // namespace krepl::app
