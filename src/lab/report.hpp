#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace krepl::lab {

/// What an experiment found, as a table. Numbers keep their type, so that counts stay counts in every format.
struct Table {
  using Value = std::variant<std::string, std::int64_t, double>;
  std::vector<std::string> columns;
  std::vector<std::vector<Value>> rows;
};

inline std::int64_t whole(std::size_t n) { return std::int64_t(n); }

/// A line of a table with its kind, as `krepl lab` prints them.
std::string text_of(const Table& table);
/// RFC 4180 with a header; real numbers have all their digits.
std::string csv_of(const Table& table);

/// A file that belongs to a report: a terrain, a picture.
struct Exhibit {
  std::string file_name;
  std::string content;
};

struct Report {
  std::string name;  ///< of the experiment; files are named after it
  Table table;
  std::vector<std::string> findings;  ///< sentences for people
  /// Numbers drawn from the table, as fitted exponents.
  std::vector<std::pair<std::string, double>> results;
  std::vector<Exhibit> exhibits;
};

/// One object: name, rows as objects by column, results, findings.
std::string json_of(const Report& report);

/// Everything there is to write: the table as NAME.csv, all as NAME.json, and the exhibits.
std::vector<Exhibit> files_of(const Report& report);

}  // namespace krepl::lab
