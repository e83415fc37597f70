#pragma once

#include <ogrsf_frmts.h>

#include <optional>
#include <vector>

#include "input/result_file.hpp"

namespace krepl::input {

/// Appends the segments and arcs of a curve; heights are left out.
void append_pieces(const OGRCurve& curve, std::vector<ResultPiece>& pieces);

/// The number in a field; nothing where there is no feature, no such field or no value.
std::optional<double> number_field(const OGRFeature* feature, const char* name);

}  // namespace krepl::input
