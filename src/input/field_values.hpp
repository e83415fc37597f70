#pragma once

#include <ogr_feature.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/error.hpp"

namespace krepl::input {

/// "the fields are: a, b", or that there are none: the remedy for a field that is not there.
std::string known_fields(const OGRFeatureDefn& definition);

/// A value that is a number, or what is wrong with it ("is null", "is 'wide', not a number").
struct FieldNumber {
  std::optional<double> value;
  std::string fault;
};

/// A field's values as numbers; text counts where all of it is a number.
Result<std::vector<FieldNumber>> field_numbers(std::span<const std::unique_ptr<OGRFeature>> rows, const std::string& name);

/// An SQL expression of the fields for each row, by SQLite through GDAL. Whole numbers count as real ones, so that
/// width / 2 is what it looks like.
Result<std::vector<FieldNumber>> expression_numbers(std::span<const std::unique_ptr<OGRFeature>> rows,
                                                    const std::string& expression);

}  // namespace krepl::input
