#include "lab/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace krepl::lab {

namespace {

using Json = nlohmann::ordered_json;

/// For people: five digits.
std::string shown(const Table::Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* count = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *count);
  return fmt::format("{:.5g}", std::get<double>(value));
}

std::string exact(const Table::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  const std::string text = shown(value);
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string text_of(const Table& table) {
  std::vector<std::size_t> width;
  for (const std::string& column : table.columns) width.push_back(column.size());
  for (const auto& row : table.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], shown(row[k]).size());
  }
  std::string text;
  for (std::size_t k = 0; k < table.columns.size(); ++k)
    text += fmt::format("{}{:>{}}", k > 0 ? "  " : "", table.columns[k], width[k]);
  for (const auto& row : table.rows) {
    text += '\n';
    for (std::size_t k = 0; k < row.size(); ++k)
      text += fmt::format("{}{:>{}}", k > 0 ? "  " : "", shown(row[k]), width[k]);
  }
  return text;
}

std::string csv_of(const Table& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
  for (const auto& row : table.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) text += (k > 0 ? "," : "") + exact(row[k]);
    text += '\n';
  }
  return text;
}

std::string json_of(const Report& report) {
  Json json{{"krepl", "lab"}, {"experiment", report.name}, {"rows", Json::array()}, {"results", Json::object()}};
  for (const auto& row : report.table.rows) {
    Json object = Json::object();
    for (std::size_t k = 0; k < row.size(); ++k)
      std::visit([&](const auto& value) { object[report.table.columns[k]] = value; }, row[k]);
    json["rows"].push_back(std::move(object));
  }
  for (const auto& [name, value] : report.results) json["results"][name] = value;
  json["findings"] = report.findings;
  return json.dump(1) + "\n";
}

std::vector<Exhibit> files_of(const Report& report) {
  std::vector<Exhibit> files = report.exhibits;
  files.push_back({report.name + ".csv", csv_of(report.table)});
  files.push_back({report.name + ".json", json_of(report)});
  return files;
}

}  // namespace krepl::lab
