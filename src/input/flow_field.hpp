#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "input/network_reader.hpp"

namespace krepl::input {

/// What a field says about the sense in which lines were digitised.
struct FlowField {
  std::vector<std::int64_t> against;  ///< features digitised against the flow
  std::size_t unknown = 0;            ///< features that do not say; they are taken as digitised with it
};

/// Reads the field of the features that `request` selects. With the flow: a number above zero, `with`, `forward`,
/// `yes`, `true`, `F`, `FT`, `WithDigitized` (in any case, spaces and underscores aside); against it: a number below
/// zero, `against`, `backward`, `reverse`, `T`, `TF`, `AgainstDigitized`; unknown: nothing, 0, `Uninitialized`. Errors:
/// no such field; a value that is none of these (named with its feature); standard input, which cannot be read twice.
Result<FlowField> read_flow_field(const NetworkRequest& request, const std::string& field, const Context& context = {});

}  // namespace krepl::input
