#pragma once

// What the writers of river networks share.

#include <string>
#include <vector>

#include "krepl/river.hpp"
#include "output/ogr_dataset.hpp"

namespace krepl::output {

OgrDataset::Fields sub_river_fields();
void set_sub_river(OGRFeature& row, const RiverNetwork& rivers, RiverNetwork::Index s);

/// A drawing: lines as wide as their order, main stems dark, fusion vertices as dots.
Result<std::vector<std::string>> write_river_svg(const std::string& path, const RiverNetwork& rivers, const Context&);

}  // namespace krepl::output
