#include "input/geometry_source.hpp"

#include <cpl_vsi.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "ogr/message_capture.hpp"

namespace krepl::input {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Everything that comes from a stream. Interruptible: a signal makes read() return.
Result<std::string> read_stream(int descriptor, const Context& context) {
  std::string text;
  std::vector<char> block(1 << 16);
  for (;;) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count == 0) return text;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return Error{ErrorCode::io, std::string("cannot be read: ") + std::strerror(errno), "", ""};
    text.append(block.data(), static_cast<std::size_t>(count));
  }
}

/// A file of GDAL's in-memory file system that goes away with the source reading it.
class MemoryFile {
 public:
  MemoryFile(std::string text, const std::string& extension) : text_(std::move(text)) {
    path_ = "/vsimem/krepl-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + "." + extension;
    VSIFCloseL(VSIFileFromMemBuffer(path_.c_str(), reinterpret_cast<GByte*>(text_.data()), text_.size(), FALSE));
  }
  ~MemoryFile() { VSIUnlink(path_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string text_, path_;
};

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

Result<std::unique_ptr<GeometrySource>> open_text(std::string text, const SourceSelection& selection) {
  std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos) return Error{ErrorCode::input, "is empty", "", "give WKT or GeoJSON text"};
  bool json = text[first] == '{';
  auto file = std::make_unique<MemoryFile>(std::move(text), json ? "geojson" : "wkt");
  auto source = json ? open_ogr_source(file->path(), selection) : open_wkt_source(file->path());
  if (!source) return source.error();
  return std::unique_ptr<GeometrySource>(new StreamSource(std::move(file), std::move(*source)));
}

bool is_stream(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode));
}

Result<std::unique_ptr<GeometrySource>> open_stream(const std::string& path, const SourceSelection& selection,
                                                    const Context& context) {
  int descriptor = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return Error{ErrorCode::io, std::string("cannot be read: ") + std::strerror(errno), "", ""};
  Result<std::string> text = read_stream(descriptor, context);
  if (descriptor != STDIN_FILENO) ::close(descriptor);
  if (!text) return text.error();
  return open_text(std::move(*text), selection);
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
  bool stream = path == "-" || is_stream(path);
  std::string extension = stream ? "" : format_extension(path);
  bool plain = extension == "wkt" || extension == "wkb";
  if (plain && !selection.layer.empty()) {
    return Error{ErrorCode::usage, "a ." + extension + " file has no layers", "", "leave out --layer"};
  }
  if (plain && !selection.where.empty()) {
    return Error{ErrorCode::usage, "a ." + extension + " file has no fields", "", "leave out --where"};
  }
  if (stream) return open_stream(path, selection, context);
  Result<std::string> vsi_path = checked_path(path);
  if (!vsi_path) return vsi_path.error();
  if (extension == "wkt") return open_wkt_source(*vsi_path);
  if (extension == "wkb") return open_wkb_source(*vsi_path);
  return open_ogr_source(*vsi_path, selection);
}

}  // namespace krepl::input
