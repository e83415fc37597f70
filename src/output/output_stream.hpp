#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "krepl/error.hpp"
#include "output/atomic_file.hpp"

namespace krepl::output {

/// Bytes to a file (through AtomicFile) or to a stream (`-`, a pipe, a device), with every failure noticed: the first one
/// sticks and comes out of finish().
class OutputStream {
 public:
  static Result<OutputStream> open(const std::string& path);
  OutputStream(OutputStream&& other) noexcept;
  OutputStream& operator=(OutputStream&&) = delete;
  ~OutputStream();

  void write(std::string_view bytes);
  /// Whether seek() works: in files it does, in pipes it does not.
  bool can_seek() const { return atomic_.has_value(); }
  std::uint64_t position();
  void seek(std::uint64_t position);
  bool failed() const { return error_number_ != 0; }
  /// Closes, and puts the file in its place if nothing failed.
  Status finish();

 private:
  OutputStream(std::FILE* file, std::optional<AtomicFile> atomic) : file_(file), atomic_(std::move(atomic)) {}
  std::FILE* file_ = nullptr;
  std::optional<AtomicFile> atomic_;
  int error_number_ = 0;
};

}  // namespace krepl::output
