#include "input/byte_stream.hpp"

#include <cpl_vsi.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "input/geometry_source.hpp"
#include "input/whole_file.hpp"
#include "ogr/message_capture.hpp"

namespace krepl::input {

namespace {

Error failure() { return {ErrorCode::io, std::string("cannot be read: ") + std::strerror(errno), "", ""}; }
Error interrupted() { return {ErrorCode::cancelled, "interrupted while reading", "", ""}; }

}  // namespace

struct ByteStream::Source {
  int descriptor = -1;
  VSILFILE* file = nullptr;

  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  ~Source() {
    if (file != nullptr) VSIFCloseL(file);
    if (descriptor > STDIN_FILENO) ::close(descriptor);
  }
};

ByteStream::ByteStream(std::unique_ptr<Source> source) : source_(std::move(source)) {}
ByteStream::ByteStream(ByteStream&&) noexcept = default;
ByteStream::~ByteStream() = default;

Result<ByteStream> ByteStream::open(const std::string& path) {
  auto source = std::make_unique<Source>();
  if (is_stream(path)) {
    source->descriptor = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (source->descriptor < 0) return failure();
    return ByteStream(std::move(source));
  }
  const Result<std::string> checked = checked_path(path);
  if (!checked) return checked.error();
  ogr::initialise();
  const ogr::MessageCapture messages;
  source->file = VSIFOpenL(checked->c_str(), "rb");
  if (source->file == nullptr) return messages.error(ErrorCode::io, "cannot be read");
  return ByteStream(std::move(source));
}

Result<std::size_t> ByteStream::read(char* bytes, std::size_t count, const Context& context) {
  for (;;) {
    if (context.cancelled()) return interrupted();
    if (source_->file != nullptr) {
      const ogr::MessageCapture messages;
      const std::size_t got = VSIFReadL(bytes, 1, count, source_->file);
      if (messages.failed())
        return messages.error(ErrorCode::io, "cannot be read to its end", "",
                              "the file seems to be damaged: get it again");
      return got;
    }
    // A signal makes read() return, so that the wait ends.
    const ssize_t got = ::read(source_->descriptor, bytes, count);
    if (got >= 0) return std::size_t(got);
    if (errno != EINTR) return failure();
  }
}

}  // namespace krepl::input
