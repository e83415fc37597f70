#include "input/geometry_source.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "input/memory_file.hpp"
#include "input/whole_file.hpp"
#include "ogr/message_capture.hpp"

namespace krepl::input {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

class StreamSource : public GeometrySource {
 public:
  StreamSource(std::unique_ptr<MemoryFile> file, std::unique_ptr<GeometrySource> source)
      : file_(std::move(file)), source_(std::move(source)) {}
  Result<std::optional<Item>> next() override { return source_->next(); }
  std::optional<OGRSpatialReference> crs() const override { return source_->crs(); }
  const char* number_name() const override { return source_->number_name(); }
  double fraction() const override { return source_->fraction(); }
  std::vector<std::string> notes() const override { return source_->notes(); }

 private:
  std::unique_ptr<MemoryFile> file_;
  std::unique_ptr<GeometrySource> source_;  // goes first: it reads the file
};

Result<std::unique_ptr<GeometrySource>> open_text(std::vector<char> text, const SourceSelection& selection) {
  std::size_t first = std::string_view(text.data(), text.size()).find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string_view::npos) return Error{ErrorCode::input, "is empty", "", "give WKT or GeoJSON text"};
  bool json = text[first] == '{';
  auto file = std::make_unique<MemoryFile>(std::move(text), json ? "geojson" : "wkt");
  auto source = json ? open_ogr_source(file->path(), selection) : open_wkt_source(file->path());
  if (!source) return source.error();
  return std::unique_ptr<GeometrySource>(new StreamSource(std::move(file), std::move(*source)));
}

/// Data sources that are directories by nature.
bool is_directory_format(const std::string& path) { return lower(path).ends_with(".gdb"); }

}  // namespace

std::string format_extension(const std::string& path) {
  std::filesystem::path p = path;
  if (lower(p.extension().string()) == ".gz") p = p.stem();
  std::string extension = lower(p.extension().string());
  return extension.empty() ? extension : extension.substr(1);
}

Result<std::string> checked_path(const std::string& path) {
  if (path.empty()) return Error{ErrorCode::usage, "the name of the input file is empty", "", ""};
  if (path.starts_with("/vsi")) return path;
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    // Not a file, but perhaps the name of a database or service: PG:..., https://...
    if (errno == ENOENT && path.find(':') != std::string::npos) return path;
    std::string remedy = errno == ENOENT ? "check the name" : "";
    return Error{ErrorCode::io, errno == ENOENT ? "no such file" : std::string("cannot be read: ") + std::strerror(errno),
                 "", remedy};
  }
  if (S_ISDIR(status.st_mode)) {
    if (is_directory_format(path)) return path;
    return Error{ErrorCode::io, "is a directory", "", "name a file in it"};
  }
  if (::access(path.c_str(), R_OK) != 0) {
    return Error{ErrorCode::io, std::string("cannot be read: ") + std::strerror(errno), "", ""};
  }
  if (status.st_size == 0) return Error{ErrorCode::input, "is empty", "", ""};
  std::string absolute = std::filesystem::absolute(path).string();
  std::string name = lower(path);
  if (name.ends_with(".tar.gz") || name.ends_with(".tgz") || name.ends_with(".tar")) return "/vsitar/" + absolute;
  if (name.ends_with(".gz")) return "/vsigzip/" + absolute;
  if (name.ends_with(".zip")) return "/vsizip/" + absolute;
  return path;
}

Result<std::unique_ptr<GeometrySource>> open_geometry_source(const std::string& path, const SourceSelection& selection,
                                                             const Context& context) {
  ogr::initialise();
  const bool stream = is_stream(path);
  std::string extension = stream ? "" : format_extension(path);
  bool plain = extension == "wkt" || extension == "wkb";
  if (plain && !selection.layer.empty()) {
    return Error{ErrorCode::usage, "a ." + extension + " file has no layers", "", "leave out --layer"};
  }
  if (plain && !selection.where.empty()) {
    return Error{ErrorCode::usage, "a ." + extension + " file has no fields", "", "leave out --where"};
  }
  if (stream) {
    Result<std::vector<char>> text = read_whole_file(path, context);
    if (!text) return text.error();
    return open_text(std::move(*text), selection);
  }
  Result<std::string> vsi_path = checked_path(path);
  if (!vsi_path) return vsi_path.error();
  if (extension == "wkt") return open_wkt_source(*vsi_path);
  if (extension == "wkb") return open_wkb_source(*vsi_path);
  return open_ogr_source(*vsi_path, selection);
}

}  // namespace krepl::input
