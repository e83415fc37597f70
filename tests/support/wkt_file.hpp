#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/zone_case.hpp"

namespace krepl::test {

/// The parts of one geometry in WKT: points, lines, polygons, their multiples, collections. A reader apart from OGR.
/// `feature` numbers the first polygon; each further one gets the next number. Throws std::runtime_error on anything
/// else.
std::vector<InputPart> parse_wkt(const std::string& text, std::int64_t& feature);

/// All geometries of a text file, one a line; lines that start with # are skipped. `.gz` goes through gzip.
std::vector<InputPart> read_wkt_file(const std::filesystem::path& path);

/// The text files of KREPL_DATA/vector in order; none without that directory.
std::vector<std::filesystem::path> real_wkt_files();

/// The text of a file, decompressed if it ends in .gz.
std::string read_text(const std::filesystem::path& path);

}  // namespace krepl::test
