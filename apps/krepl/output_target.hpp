#pragma once

#include <initializer_list>
#include <string>

#include "krepl/error.hpp"

namespace krepl::app {

/// Fails before a long computation rather than after it: the target of a result must not be one of the files that are read, and
/// must be writable. Leaves nothing in its place.
Status check_target(const std::string& target, std::initializer_list<std::string> inputs);

}  // namespace krepl::app
