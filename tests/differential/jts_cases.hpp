#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace krepl::test {

/// One operation of a test file of JTS's XML runner.
struct JtsCase {
  std::string file;         ///< "jts_TestBuffer"
  int number = 0;           ///< of the <case>, from 1
  std::string description;  ///< of the case, on one line
  std::string operation;    ///< "buffer", "bufferMitredJoin"
  double distance = 0;
  std::string input, expected;  ///< WKT
  /// "jts_TestBuffer 3, 10": as docs/jts.md names it.
  std::string name() const;
};

/// All operations of a file, in its order. Throws std::runtime_error on what it does not understand.
std::vector<JtsCase> read_jts_cases(const std::filesystem::path& path);

}  // namespace krepl::test
