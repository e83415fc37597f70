#pragma once

#include <string>

#include "verbs.hpp"
#include "verify/input_parts.hpp"

namespace krepl::app {

/// `krepl verify RESULT.csv --against IN --radius R` for a profile. Returns the exit status.
int verify_profile(const std::string& result, const verify::InputRequest& input, const std::string& radius, Session& session);

}  // namespace krepl::app
