// Which features share a zone.
#include <fmt/format.h>

#include <unordered_map>

#include "feature_zones.hpp"

namespace krepl::app {

namespace {

/// Features of equal value in the field, in the order of first occurrence; those without a value make a group too.
std::vector<FeatureGroup> groups_by_field(const input::FeatureData& data, const std::string& name) {
  std::vector<FeatureGroup> groups;
  std::unordered_map<std::string, std::size_t> known;
  const int field = data.row.front()->GetDefnRef()->GetFieldIndex(name.c_str());
  for (std::size_t i = 0; i < data.size(); ++i) {
    const bool null = !data.row[i]->IsFieldSetAndNotNull(field);
    const std::string key = null ? "" : std::string("=") + data.row[i]->GetFieldAsString(field);
    const auto [at, is_new] = known.emplace(key, groups.size());
    if (is_new) groups.push_back({{}, data.row[i].get(), ""});
    groups[at->second].features.push_back(i);
  }
  for (FeatureGroup& group : groups) {
    group.name = data.place[group.features.front()];
    if (group.features.size() > 1) group.name += fmt::format(" and {} more", group.features.size() - 1);
  }
  return groups;
}

}  // namespace

std::vector<FeatureGroup> make_groups(const input::FeatureData& data, const std::string& field) {
  if (!field.empty()) return groups_by_field(data, field);
  std::vector<FeatureGroup> groups(data.size());
  for (std::size_t i = 0; i < data.size(); ++i)
    groups[i] = {{i}, data.row.empty() ? nullptr : data.row[i].get(), data.place[i]};
  return groups;
}

std::vector<std::size_t> all_features(const input::FeatureData& data) {
  std::vector<std::size_t> all(data.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

}  // namespace krepl::app
