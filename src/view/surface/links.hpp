#pragma once

#include "input/subdivision_file.hpp"
#include "krepl/error.hpp"

namespace krepl::view {

/// Whether a file's numbers can be followed: every index leads somewhere, half-edges 2e and 2e + 1 belong to edge e,
/// `next` is a permutation within each face, coordinates and radius are finite. Linear time. Errors name the item.
Status check_links(const input::SubdivisionFile& file);

}  // namespace krepl::view
