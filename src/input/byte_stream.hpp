#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::input {

/// The bytes of a file, unpacked if it is a .gz, of standard input (`-`) or of a pipe, from front to back.
class ByteStream {
 public:
  /// Errors: what checked_path reports; cannot be opened.
  static Result<ByteStream> open(const std::string& path);
  ByteStream(ByteStream&&) noexcept;
  ~ByteStream();

  /// Up to `count` bytes: what a stream has, else all of them; 0 at the end. Errors: cannot be read or unpacked;
  /// cancelled, also while waiting for a stream.
  Result<std::size_t> read(char* bytes, std::size_t count, const Context& context);

 private:
  struct Source;
  explicit ByteStream(std::unique_ptr<Source> source);
  std::unique_ptr<Source> source_;
};

}  // namespace krepl::input
