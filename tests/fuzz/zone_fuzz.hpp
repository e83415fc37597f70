#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace krepl::test {

/// Decodes a case, computes its zone and checks it by validate() and brute force; what is wrong and the case as text,
/// or nothing.
std::optional<std::string> fuzz_zone(std::span<const std::uint8_t> bytes);

/// The same case by sweep and by intervals: how the zones differ, or nothing.
std::optional<std::string> fuzz_engines(std::span<const std::uint8_t> bytes);

}  // namespace krepl::test
