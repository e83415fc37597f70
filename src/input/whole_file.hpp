#pragma once

#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::input {

/// All bytes of a file, unpacked if it is a .gz; of standard input if the name is `-`; of a pipe. Errors: what
/// checked_path reports; cannot be read or unpacked to its end; cancelled, also while waiting for a stream.
Result<std::vector<char>> read_whole_file(const std::string& path, const Context& context = {});

/// True for `-`, pipes and terminals: what can be read once, from front to back.
bool is_stream(const std::string& path);

}  // namespace krepl::input
