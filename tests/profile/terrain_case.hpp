#pragma once

#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "krepl/profile.hpp"
#include "verify/profile_verifier.hpp"

namespace krepl::test {

using Terrain = std::vector<Point>;

/// A result as a reader of its file would see it.
std::vector<input::ProfileRecord> records_of(const Profile& profile);

/// The result for one thread; a test fails where there is none.
Profile profile_of(Terrain terrain, double radius);

/// What is wrong with the result by the verifier's brute force, or nothing. `allowed`: largest deviation, in units of S.
std::optional<std::string> fault_in(const Terrain& terrain, double radius, double allowed = 1e-12);

/// What differs, in kind, cause or a single bit of a coordinate, between the sequential run and: blocks of each of these
/// sizes (the last on `threads` threads, the others on one), and the stream with points pushed in portions of these sizes.
std::optional<std::string> difference_in(const Terrain& terrain, double radius, std::span<const std::size_t> sizes,
                                         unsigned threads = 2);

/// "x z" of all points with all digits, to copy into a test.
std::string text(const Terrain& terrain, double radius);

/// Families of terrains; `name` says which.
struct Family {
  const char* name;
  Terrain (*make)(std::mt19937_64& random, std::size_t points);
};
std::span<const Family> families();

/// Radii from 1e-6 to 1e6 times the mean segment length.
double any_radius(std::mt19937_64& random, const Terrain& terrain);

Terrain mirrored(Terrain terrain);
Terrain moved(Terrain terrain, double dx, double dy);
Terrain scaled(Terrain terrain, double factor);

}  // namespace krepl::test
