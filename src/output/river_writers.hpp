#pragma once

// What the writers of river networks share.

#include <string>
#include <vector>

#include "krepl/river.hpp"
#include "output/kept_fields.hpp"
#include "output/ogr_dataset.hpp"

namespace krepl::output {

/// The attributes of the input feature that a line comes from; none where it is not known.
class SourceAttributes {
 public:
  explicit SourceAttributes(const AttributeRows& rows)
      : rows_(rows), fields_(rows.empty() ? nullptr : rows.begin()->second->GetDefnRef()) {}

  Status create(OGRLayer& layer, const OgrDataset& dataset, std::vector<std::string>& notes) {
    return dataset.has_fields() ? fields_.create(layer, dataset.driver(), notes) : Status(std::monostate{});
  }
  void set(OGRFeature& row, std::int64_t feature) const {
    if (const auto found = rows_.find(feature); found != rows_.end()) fields_.copy(*found->second, row);
  }

 private:
  const AttributeRows& rows_;
  KeptFields fields_;
};

OgrDataset::Fields sub_river_fields();
void set_sub_river(OGRFeature& row, const RiverNetwork& rivers, RiverNetwork::Index s);

/// A drawing: lines as wide as their order, main stems dark, fusion vertices as dots.
Result<std::vector<std::string>> write_river_svg(const std::string& path, const RiverNetwork& rivers, const Context&);

}  // namespace krepl::output
