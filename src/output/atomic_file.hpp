#pragma once

#include <memory>
#include <string>

#include "krepl/error.hpp"

namespace krepl::output {

/// A file that appears under its name whole or not at all.
///
/// The content is written to temporary_path(): a file of the same name in a fresh hidden directory beside the target
/// (`.NAME.krepl-XXXXXX`), so that drivers see the extension they expect and may put further files next to it (journal,
/// .dbf, .shx). commit() flushes everything to the disk and renames each file into the target's directory, the one that
/// was asked for last. A run that fails or is killed leaves the old file; only a kill between two renames of a format of
/// several files (Shapefile) can leave a mixture. Symbolic links are followed; permissions of a replaced file are kept.
class AtomicFile {
 public:
  /// Errors: the directory does not exist or is not writable; the target is a directory, or exists and is not an ordinary
  /// file (replacing a device would be wrong).
  static Result<AtomicFile> create(const std::string& path);
  AtomicFile(AtomicFile&&) noexcept = default;
  AtomicFile& operator=(AtomicFile&&) noexcept = default;
  /// Removes whatever was not committed.
  ~AtomicFile() = default;

  const std::string& temporary_path() const;
  /// To be called once, after the file has been closed.
  Status commit();

 private:
  struct Place;  // the directories; removes the temporary one
  explicit AtomicFile(std::shared_ptr<Place> place);
  std::shared_ptr<Place> place_;
};

/// Removes the temporary directories of all files not committed yet, for a process about to end without unwinding its
/// stack. A commit that is renaming is let through to its end, and none can begin any more: the caller must exit.
void abandon_temporary_files();

/// True if `path` names something that is written to directly (a pipe, a terminal, /dev/null), not replaced.
bool is_stream_target(const std::string& path);

}  // namespace krepl::output
