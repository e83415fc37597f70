#include "input/place_stream.hpp"

#include <algorithm>

namespace krepl::input {

Result<PlaceStream> PlaceStream::open(const std::string& path, bool with_z, const Context& context, std::string_view label) {
  Result<ByteStream> bytes = ByteStream::open(path);
  if (!bytes) return bytes.error();
  PlaceStream stream(std::move(*bytes), with_z);
  std::vector<char> text;
  for (bool found = false; !found;) {  // a pipe may give comments before it gives the header
    const Result<std::vector<char>> more = stream.whole_lines(context);
    if (!more) return more.error();
    text.insert(text.end(), more->begin(), more->end());
    Result<CsvTable> table = CsvTable::from_text(text);
    found = table.ok();
    if (!found && stream.at_end_) return table.error();
    if (found) stream.table_ = std::move(*table);
  }
  for (int k = 0; k < (with_z ? 3 : 2); ++k) {
    const Result<std::size_t> column = stream.table_.column(std::string_view("xyz").substr(std::size_t(k), 1));
    if (!column) return column.error();
    stream.column_[k] = *column;
  }
  if (!label.empty())
    if (const Result<std::size_t> column = stream.table_.column(label)) stream.label_column_ = *column;
  return stream;
}

/// What is there up to the last line's end: a megabyte, more only where a line is longer, less where a stream has no
/// more for now.
Result<std::vector<char>> PlaceStream::whole_lines(const Context& context) {
  constexpr std::size_t portion = std::size_t{1} << 20;
  std::vector<char> text = std::move(rest_);
  rest_.clear();
  while (!at_end_) {
    const std::size_t before = text.size();
    text.resize(before + portion);
    const Result<std::size_t> got = bytes_.read(text.data() + before, portion, context);
    if (!got) return got.error();
    text.resize(before + *got);
    at_end_ = *got == 0;
    const auto end = std::find(text.rbegin(), text.rend() - std::ptrdiff_t(before), '\n');
    if (at_end_ || end == text.rend() - std::ptrdiff_t(before)) continue;
    rest_.assign(end.base(), text.end());
    text.erase(end.base(), text.end());
    return text;
  }
  return text;
}

Result<Point3> PlaceStream::place() const {
  Point3 p;
  double* const to[] = {&p.x, &p.y, &p.z};
  for (int k = 0; k < (with_z_ ? 3 : 2); ++k) {
    const Result<double> number = table_.finite(column_[k]);
    if (!number) return number.error();
    *to[k] = *number;
  }
  return p;
}

Status PlaceStream::next(std::vector<Point3>& places, std::vector<std::string>* labels, const Context& context) {
  places.clear();
  if (labels != nullptr) labels->clear();
  for (;;) {
    while (table_.next()) {
      const Result<Point3> p = place();
      if (!p) return p.error();
      places.push_back(*p);
      if (labels != nullptr) labels->emplace_back(label_column_ ? table_.field(*label_column_) : std::string_view());
    }
    count_ += places.size();
    if (!places.empty()) return std::monostate{};
    if (at_end_ && count_ == 0)
      return Error{ErrorCode::input, "has no places", "", "give at least one row below the header"};
    if (at_end_) return std::monostate{};
    Result<std::vector<char>> text = whole_lines(context);
    if (!text) return text.error();
    table_.continue_with(std::move(*text));
  }
}

}  // namespace krepl::input
