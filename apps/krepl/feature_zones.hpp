#pragma once

#include <string>
#include <vector>

#include "feature_buffer.hpp"
#include "input/collected.hpp"
#include "input/feature_reader.hpp"
#include "krepl/network.hpp"
#include "output/feature_file.hpp"
#include "shape_options.hpp"

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

/// A group for each value of the field, in the order of first occurrence (features without a value make one too); for
/// each feature if no field is named.
std::vector<FeatureGroup> make_groups(const input::FeatureData& data, const std::string& field);
std::vector<std::size_t> all_features(const input::FeatureData& data);
/// Adds the features' parts to a network (with their arcs, if it can have some), and to `radii` the radius of each part where
/// features have their own.
template <class Builder>
void add_features(const input::FeatureData& data, const std::vector<std::size_t>& features, Builder& builder,
                  std::vector<double>& radii) {
  for (const std::size_t f : features) {
    for (std::size_t i = data.part_begin[f]; i < data.part_begin[f + 1]; ++i) {
      input::add_part(builder, data.parts, i, data.parts.feature[i]);
      if (!data.radius.empty()) radii.push_back(data.radius[f]);
    }
  }
}
/// True if zones of features or groups are made of arcs as they are; else they are to be replaced by chords.
bool groups_take_arcs(const FeatureOptions& features, const ShapeOptions& shape);

/// The fields of the file: those of the features, or the one that groups have in common; radius, area, perimeter.
output::FeatureColumns columns_of(const GroupJob& job);

/// Computes the zones block by block on all threads, writes them in order. Returns the exit status.
int write_groups(const GroupJob& job, Session& session);
/// The same without overlaps: each place belongs to the nearest group. One radius at a time for all.
int write_owners(const GroupJob& job, Session& session);

/// Notes about a file that was written.
void tell(const output::ZoneFileReport& report, const FeatureJob& job, Session& session);

}  // namespace krepl::app
