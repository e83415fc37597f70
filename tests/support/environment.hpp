#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace krepl::test {

/// Seed of all random generators: environment variable KREPL_SEED, else the one set at configuration.
std::uint64_t seed();

/// Directory of real data that is not shipped: environment variable KREPL_DATA, else ../shared/data beside the sources.
/// Nothing if there is none; tests then skip and say so.
std::optional<std::filesystem::path> data_directory();

/// Top directory of the sources, so that no test depends on the working directory.
std::filesystem::path source_directory();

/// Factor on the number of random cases: environment variable KREPL_TEST_EFFORT, default 1.
double effort();

}  // namespace krepl::test
