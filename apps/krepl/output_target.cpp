#include "output_target.hpp"

#include <filesystem>

#include "output/atomic_file.hpp"

namespace krepl::app {

Status check_target(const std::string& target, std::initializer_list<std::string> inputs) {
  if (output::is_stream_target(target)) return std::monostate{};
  for (const std::string& input : inputs) {
    std::error_code not_there;
    if (!std::filesystem::equivalent(target, input, not_there)) continue;
    const std::string what = inputs.size() == 1 ? "is the input" : "is an input";
    return Error{ErrorCode::usage, what + ", which would be lost", "", "name another file for the result"};
  }
  Result<output::AtomicFile> file = output::AtomicFile::create(target);
  if (!file) return file.error();
  return std::monostate{};
}

}  // namespace krepl::app
