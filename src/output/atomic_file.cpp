#include "output/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>
#include <vector>

namespace krepl::output {

namespace fs = std::filesystem;

namespace {

Error io_error(const std::string& what, int number, const std::string& remedy = {}) {
  return {ErrorCode::io, what + ": " + std::strerror(number), "", remedy};
}

/// Makes sure that a file's (or directory's) content has reached the disk: delayed allocation reports a full disk only
/// here, and a rename must not become durable before what it points to.
Status flush_to_disk(const fs::path& path) {
  int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return io_error("cannot open the temporary file", errno);
  int outcome = ::fsync(descriptor);
  int number = errno;
  ::close(descriptor);
  // EINVAL: a file system that has nothing to flush.
  if (outcome != 0 && number != EINVAL) return io_error("cannot write", number, "free some space or choose another place");
  return std::monostate{};
}

/// The place behind symbolic links, also when the last link points to a file that does not exist yet.
Result<fs::path> resolve(const std::string& path) {
  std::error_code code;
  fs::path target = path;
  for (int links = 0; fs::is_symlink(target, code); ++links) {
    if (links == 40) return io_error("cannot be written", ELOOP);
    fs::path next = fs::read_symlink(target, code);
    if (code) return io_error("cannot be written", code.value());
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

}  // namespace

namespace {

// Temporary directories that exist now. The mutex is also held while files are renamed.
std::mutex registry_mutex;
std::set<fs::path>& registry() {
  static auto* paths = new std::set<fs::path>;  // never destroyed: another thread may use it until the very end
  return *paths;
}

}  // namespace

struct AtomicFile::Place {
  fs::path target;
  fs::path directory;  // the temporary one
  std::string temporary;

  Place(fs::path target_path, fs::path temporary_directory)
      : target(std::move(target_path)), directory(std::move(temporary_directory)),
        temporary((directory / target.filename()).string()) {
    std::lock_guard lock(registry_mutex);
    registry().insert(directory);
  }
  ~Place() {
    std::lock_guard lock(registry_mutex);
    registry().erase(directory);
    std::error_code ignored;
    fs::remove_all(directory, ignored);
  }
};

void abandon_temporary_files() {
  registry_mutex.lock();  // for good
  for (const fs::path& directory : registry()) {
    std::error_code ignored;
    fs::remove_all(directory, ignored);
  }
}

AtomicFile::AtomicFile(std::shared_ptr<Place> place) : place_(std::move(place)) {}

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  Result<fs::path> target = resolve(path);
  if (!target) return target.error();
  struct stat status {};
  if (::stat(target->c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) return Error{ErrorCode::io, "is a directory", "", "name a file in it"};
    if (!S_ISREG(status.st_mode)) {
      return Error{ErrorCode::io, "is not an ordinary file", "", "only text formats can be written to a stream"};
    }
    if (::access(target->c_str(), W_OK) != 0) return io_error("cannot be written", errno);
  }
  fs::path parent = target->parent_path().empty() ? fs::path(".") : target->parent_path();
  if (target->filename().empty()) return Error{ErrorCode::io, "is not a file name", "", "name a file"};

  std::string pattern = (parent / std::string(".").append(target->filename().string()).append(".krepl-XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    std::string remedy = errno == ENOENT ? "create the directory first" : "";
    return io_error("cannot be written", errno, remedy);
  }
  return AtomicFile(std::make_shared<Place>(*target, pattern));
}

const std::string& AtomicFile::temporary_path() const { return place_->temporary; }

Status AtomicFile::commit() {
  std::error_code code;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(place_->directory, code)) files.push_back(entry.path());
  if (code) return io_error("cannot read the temporary directory", code.value());
  std::sort(files.begin(), files.end());
  // The file that was asked for goes last: when it has changed, everything that belongs to it has.
  std::stable_partition(files.begin(), files.end(), [&](const fs::path& f) { return f != place_->temporary; });
  if (files.empty() || files.back() != place_->temporary) {
    return Error{ErrorCode::io, "nothing was written", "", ""};
  }

  fs::path parent = place_->target.parent_path().empty() ? fs::path(".") : place_->target.parent_path();
  struct stat old {};
  bool replaces = ::stat(place_->target.c_str(), &old) == 0;
  for (const fs::path& file : files) {
    if (fs::is_directory(file, code)) continue;
    if (Status flushed = flush_to_disk(file); !flushed) return flushed;
    // Best effort: a file system without permissions is no reason to lose the result.
    if (replaces && ::chmod(file.c_str(), old.st_mode & 07777) != 0) errno = 0;
  }
  std::lock_guard lock(registry_mutex);
  for (const fs::path& file : files) {
    fs::rename(file, parent / file.filename(), code);
    if (code) return io_error("cannot be replaced", code.value());
  }
  // The new name is in place; whether it survives a power cut is all that this can still change.
  static_cast<void>(flush_to_disk(parent));
  return std::monostate{};
}

bool is_stream_target(const std::string& path) {
  if (path == "-") return true;
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

}  // namespace krepl::output
