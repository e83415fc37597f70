#pragma once

#include <ogr_feature.h>

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "input/network_reader.hpp"
#include "input/parts.hpp"

namespace krepl::input {

struct FeatureRequest {
  NetworkRequest network;
  std::string radius_field;       ///< a radius for each feature from this field ...
  std::string radius_expression;  ///< ... or from this expression of fields (SQLite's), as "width / 2 + 5"
  std::string group_field;        ///< a field that must be there
};

/// Features with their geometry in the plane, their attributes, and a radius each where one was asked for. Features
/// without geometry are left out (noted).
struct FeatureData {
  Parts parts;
  std::vector<std::size_t> part_begin{0};        ///< feature i has parts part_begin[i] .. part_begin[i+1]
  std::vector<std::unique_ptr<OGRFeature>> row;  ///< attributes only; none at all for WKT and WKB
  std::vector<double> radius;                    ///< per feature; none where none was asked for
  std::vector<std::string> place;                ///< per feature: what messages call it
  std::string crs;
  std::vector<std::string> notes;

  std::size_t size() const { return place.size(); }
};

/// The attributes of all features with geometry, by their numbers; none for WKT, WKB and standard input, which cannot be
/// read a second time.
Result<std::unordered_map<std::int64_t, std::shared_ptr<const OGRFeature>>> read_attributes(const NetworkRequest& request,
                                                                                           const Context& context = {});

/// As read_network, with attributes; arcs that are kept are told by `parts.middle`. Errors also: a field that is not there (lists those there are), an expression that
/// is none; a radius that is null, no number, not finite, zero or negative, with the feature's name.
Result<FeatureData> read_features(const FeatureRequest& request, const Context& context = {});

}  // namespace krepl::input
