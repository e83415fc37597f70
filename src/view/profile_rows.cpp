#include "view/profile_rows.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <string_view>

namespace krepl::view {

namespace {

using Fields = std::vector<std::string_view>;

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

Fields split(std::string_view line) {
  Fields fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

bool parse(std::string_view text, double& value) {
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  return status == std::errc{} && end == text.data() + text.size();
}

Error bad_line(std::size_t line, const std::string& what, const std::string& remedy = "") {
  return {ErrorCode::input, what, "line " + std::to_string(line), remedy};
}

/// Calls `row` for each line that is neither empty nor a comment; the first one is the header, number 0.
Status for_each_line(const std::string& path,
                     const std::function<Status(const Fields&, std::size_t line, bool header)>& row) {
  std::ifstream file(path);
  if (!file) return Error{ErrorCode::io, "cannot be read", "", "check the name and the permissions"};
  std::string line;
  bool header = true;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    if (Status status = row(split(text), number, header); !status) return status;
    header = false;
  }
  if (header) return Error{ErrorCode::input, "is empty", "", ""};
  return std::monostate{};
}

Result<ProfileRow> row_of(const Fields& fields, std::size_t line) {
  ProfileRow row;
  if (fields[0] == "half_line")
    row.kind = ProfileRow::Kind::half_line;
  else if (fields[0] == "arc")
    row.kind = ProfileRow::Kind::arc;
  else if (fields[0] != "segment")
    return bad_line(line, "unknown kind '" + std::string(fields[0]) + "'", "kinds are half_line, segment and arc");
  double* const numbers[] = {&row.start.x, &row.start.y, &row.end.x, &row.end.y, &row.center.x, &row.center.y};
  const std::size_t wanted = row.kind == ProfileRow::Kind::arc ? 6 : 4;
  for (std::size_t i = 0; i < wanted; ++i) {
    if (!parse(fields[i + 1], *numbers[i]))
      return bad_line(line, "'" + std::string(fields[i + 1]) + "' is not a number");
    const bool lower_end = row.kind == ProfileRow::Kind::half_line && (i == 1 || i == 3) && *numbers[i] == -INFINITY;
    if (!std::isfinite(*numbers[i]) && !lower_end) return bad_line(line, "a coordinate is not finite");
  }
  const std::string_view cause = fields[7];
  double index = 0;
  if (cause.size() > 1 && (cause[0] == 's' || cause[0] == 'v') && parse(cause.substr(1), index))
    row.cause = static_cast<std::int64_t>(index);
  return row;
}

/// -infinity is the only value that may differ: half-lines come from and go to it.
Status check_chain(const std::vector<ProfileRow>& rows, std::size_t line) {
  const ProfileRow& last = rows.back();
  if (last.kind == ProfileRow::Kind::half_line && rows.size() == 1 && last.start.y != -INFINITY)
    return bad_line(line, "the first half-line does not come from -inf");
  if (rows.size() < 2) return std::monostate{};
  const ProfileRow& before = rows[rows.size() - 2];
  if (before.end != last.start || !std::isfinite(last.start.y))
    return bad_line(line, "the piece does not start where the one before it ends", "give the file as krepl wrote it");
  return std::monostate{};
}

}  // namespace

Result<std::vector<ProfileRow>> read_profile_rows(const std::string& path) {
  std::vector<ProfileRow> rows;
  const Fields columns{"kind", "x0", "y0", "x1", "y1", "cx", "cy", "segment"};
  Status status = for_each_line(path, [&](const Fields& fields, std::size_t line, bool header) -> Status {
    if (header) {
      if (fields == columns) return std::monostate{};
      return bad_line(line, "is not a profile", "a profile starts with kind,x0,y0,x1,y1,cx,cy,segment");
    }
    if (fields.size() != columns.size()) return bad_line(line, "has not 8 columns");
    Result<ProfileRow> row = row_of(fields, line);
    if (!row) return row.error();
    rows.push_back(*row);
    return check_chain(rows, line);
  });
  if (!status) return status.error();
  if (rows.empty()) return Error{ErrorCode::input, "holds no piece", "", ""};
  return rows;
}

Result<std::vector<Point>> read_terrain_rows(const std::string& path) {
  std::vector<Point> terrain;
  std::size_t x = 0, z = 0;
  Status status = for_each_line(path, [&](const Fields& fields, std::size_t line, bool header) -> Status {
    if (header) {
      const auto find = [&](std::string_view name) {
        return static_cast<std::size_t>(std::find(fields.begin(), fields.end(), name) - fields.begin());
      };
      x = find("x");
      z = std::min(find("z"), fields.size());
      if (z == fields.size()) z = find("y");
      if (x < fields.size() && z < fields.size()) return std::monostate{};
      return bad_line(line, "has no columns x and z", "name them in the first line");
    }
    Point p;
    if (std::max(x, z) >= fields.size() || !parse(fields[x], p.x) || !parse(fields[z], p.y) || !std::isfinite(p.x) ||
        !std::isfinite(p.y))
      return bad_line(line, "holds no two finite numbers");
    terrain.push_back(p);
    return std::monostate{};
  });
  if (!status) return status.error();
  if (terrain.empty()) return Error{ErrorCode::input, "holds no point", "", ""};
  return terrain;
}

}  // namespace krepl::view
