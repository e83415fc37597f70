// Plain files of geometries: WKT, one a line, and WKB, one after the other.
#include <cpl_vsi.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <string_view>

#include "input/geometry_source.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
using File = std::unique_ptr<VSILFILE, CloseFile>;

Result<File> open_file(const std::string& vsi_path) {
  ogr::MessageCapture messages;
  File file(VSIFOpenL(vsi_path.c_str(), "rb"));
  if (!file) return messages.error(ErrorCode::io, "cannot be read");
  return file;
}

std::int64_t file_size(const std::string& vsi_path) {
  VSIStatBufL status;
  // The size of what is compressed is known only after unpacking it, which would double the cost of reading.
  if (vsi_path.starts_with("/vsigzip/") || VSIStatL(vsi_path.c_str(), &status) != 0) return 0;
  return static_cast<std::int64_t>(status.st_size);
}

class LineReader {
 public:
  explicit LineReader(File file) : file_(std::move(file)), buffer_(1 << 18) {}

  /// False at the end of the file or after a read error (see error()).
  bool next(std::string& line) {
    line.clear();
    for (;;) {
      if (begin_ == end_ && !fill()) return !line.empty();
      const char* first = buffer_.data() + begin_;
      const void* newline = std::memchr(first, '\n', end_ - begin_);
      if (newline == nullptr) {
        line.append(first, end_ - begin_);
        begin_ = end_;
        continue;
      }
      auto length = static_cast<std::size_t>(static_cast<const char*>(newline) - first);
      line.append(first, length);
      begin_ += length + 1;
      return true;
    }
  }
  std::int64_t position() const { return position_; }
  const std::optional<Error>& error() const { return error_; }

 private:
  bool fill() {
    if (done_) return false;
    ogr::MessageCapture messages;
    begin_ = 0;
    end_ = VSIFReadL(buffer_.data(), 1, buffer_.size(), file_.get());
    position_ += static_cast<std::int64_t>(end_);
    if (end_ < buffer_.size()) done_ = true;
    if (messages.failed()) error_ = messages.error(ErrorCode::io, "cannot be read to its end");
    return end_ > 0 && !error_;
  }

  File file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::int64_t position_ = 0;
  bool done_ = false;
  std::optional<Error> error_;
};

std::string_view trimmed(std::string_view text) {
  auto blank = [](unsigned char c) { return std::isspace(c) != 0; };
  while (!text.empty() && blank(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && blank(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

/// True if a number of the text is written as nan or inf, which OGR does not take for a number.
bool names_non_finite(std::string_view text) {
  for (std::size_t i = 0; i + 3 <= text.size(); ++i) {
    std::string word;
    for (std::size_t k = i; k < i + 3; ++k) word += static_cast<char>(std::tolower(static_cast<unsigned char>(text[k])));
    bool starts = i == 0 || std::isalpha(static_cast<unsigned char>(text[i - 1])) == 0;
    if (starts && (word == "nan" || word == "inf")) return true;
  }
  return false;
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string shown;
  for (char c : text.substr(0, longest)) shown += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  return "'" + shown + (text.size() > longest ? "...'" : "'");
}

class WktSource : public GeometrySource {
 public:
  WktSource(File file, std::int64_t size) : reader_(std::move(file)), size_(size) {}

  Result<std::optional<Item>> next() override {
    while (reader_.next(line_)) {
      ++number_;
      std::string_view text = line_;
      if (number_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
      text = trimmed(text);
      if (text.empty() || text.front() == '#') continue;
      if (Status status = take_srid(text); !status) return status.error();
      return parse(text);
    }
    if (reader_.error()) return *reader_.error();
    return std::optional<Item>{};
  }

  std::optional<OGRSpatialReference> crs() const override { return crs_; }
  const char* number_name() const override { return "line"; }
  double fraction() const override {
    return size_ > 0 ? std::min(1.0, static_cast<double>(reader_.position()) / static_cast<double>(size_)) : 0;
  }

 private:
  /// Takes off the prefix of EWKT, as `SRID=25832;`.
  Status take_srid(std::string_view& text) {
    if (!text.starts_with("SRID=")) return std::monostate{};
    std::size_t end = text.find(';');
    if (end == std::string_view::npos) {
      return Error{ErrorCode::input, "SRID without ';'", place(number_), "write SRID=25832;LINESTRING (...)"};
    }
    std::string srid(text.substr(5, end - 5));
    text = trimmed(text.substr(end + 1));
    if (!srid_.empty() && srid != srid_) {
      return Error{ErrorCode::input, "SRID " + srid + " differs from " + srid_ + " on an earlier line", place(number_),
                   "bring all lines into one coordinate system"};
    }
    if (srid_.empty() && srid != "0") {
      Result<OGRSpatialReference> crs = ogr::parse_crs("EPSG:" + srid);
      if (!crs) return Error{ErrorCode::input, crs.error().what, place(number_), crs.error().remedy};
      crs_ = *crs;
    }
    srid_ = srid;
    return std::monostate{};
  }

  Result<std::optional<Item>> parse(std::string_view text) {
    ogr::MessageCapture messages;
    std::string copy(text);  // the parser wants a terminating zero, and the view may end before the line does
    const char* cursor = copy.c_str();
    OGRGeometry* made = nullptr;
    OGRErr outcome = OGRGeometryFactory::createFromWkt(&cursor, nullptr, &made);
    geometry_.reset(made);
    if (outcome != OGRERR_NONE || !geometry_) {
      if (names_non_finite(text)) {
        return Error{ErrorCode::input, "a coordinate is not a finite number", place(number_), "correct or remove it"};
      }
      return Error{ErrorCode::input, "not a geometry in WKT", place(number_) + ": " + excerpt(text),
                   "give one geometry a line"};
    }
    if (std::string_view rest = trimmed(cursor); !rest.empty()) {
      return Error{ErrorCode::input, "text after the geometry", place(number_) + ": " + excerpt(rest),
                   "give one geometry a line"};
    }
    return std::optional<Item>{Item{number_, geometry_.get(), nullptr}};
  }

  LineReader reader_;
  std::int64_t size_;
  std::string line_, srid_;
  std::int64_t number_ = 0;
  std::unique_ptr<OGRGeometry> geometry_;
  std::optional<OGRSpatialReference> crs_;
};

class WkbSource : public GeometrySource {
 public:
  explicit WkbSource(std::string bytes) : bytes_(std::move(bytes)) {}

  Result<std::optional<Item>> next() override {
    if (begin_ == bytes_.size()) return std::optional<Item>{};
    ++number_;
    ogr::MessageCapture messages;
    OGRGeometry* made = nullptr;
    size_t consumed = 0;
    OGRErr outcome = OGRGeometryFactory::createFromWkb(bytes_.data() + begin_, nullptr, &made, bytes_.size() - begin_,
                                                       wkbVariantIso, consumed);
    geometry_.reset(made);
    if (outcome != OGRERR_NONE || !geometry_ || consumed == 0) {
      return messages.error(ErrorCode::input, "not a geometry in WKB", "byte " + std::to_string(begin_));
    }
    begin_ += consumed;
    return std::optional<Item>{Item{number_, geometry_.get(), nullptr}};
  }

  std::optional<OGRSpatialReference> crs() const override { return std::nullopt; }
  const char* number_name() const override { return "feature"; }
  double fraction() const override { return static_cast<double>(begin_) / static_cast<double>(bytes_.size()); }

 private:
  std::string bytes_;
  std::size_t begin_ = 0;
  std::int64_t number_ = 0;
  std::unique_ptr<OGRGeometry> geometry_;
};

}  // namespace

Result<std::unique_ptr<GeometrySource>> open_wkt_source(const std::string& vsi_path) {
  Result<File> file = open_file(vsi_path);
  if (!file) return file.error();
  return std::unique_ptr<GeometrySource>(new WktSource(std::move(*file), file_size(vsi_path)));
}

Result<std::unique_ptr<GeometrySource>> open_wkb_source(const std::string& vsi_path) {
  Result<File> file = open_file(vsi_path);
  if (!file) return file.error();
  ogr::MessageCapture messages;
  std::string bytes;
  std::vector<char> block(1 << 18);
  while (size_t count = VSIFReadL(block.data(), 1, block.size(), file->get())) bytes.append(block.data(), count);
  if (messages.failed()) return messages.error(ErrorCode::io, "cannot be read to its end");
  return std::unique_ptr<GeometrySource>(new WkbSource(std::move(bytes)));
}

}  // namespace krepl::input
