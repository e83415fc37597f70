#include "output/output_stream.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

namespace krepl::output {

namespace {

Error write_error(int number) {
  return {ErrorCode::io, std::string("cannot be written: ") + std::strerror(number), "",
          number == ENOSPC ? "free some space or choose another place" : ""};
}

}  // namespace

Result<OutputStream> OutputStream::open(const std::string& path) {
  if (path == "-") return OutputStream(stdout, std::nullopt);
  std::optional<AtomicFile> atomic;
  if (!is_stream_target(path)) {
    Result<AtomicFile> created = AtomicFile::create(path);
    if (!created) return created.error();
    atomic = std::move(*created);
  }
  std::FILE* file = std::fopen(atomic ? atomic->temporary_path().c_str() : path.c_str(), "wb");
  if (file == nullptr) return write_error(errno);
  std::setvbuf(file, nullptr, _IOFBF, 1 << 18);
  return OutputStream(file, std::move(atomic));
}

OutputStream::OutputStream(OutputStream&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)), atomic_(std::move(other.atomic_)), error_number_(other.error_number_) {}

OutputStream::~OutputStream() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
}

void OutputStream::write(std::string_view bytes) {
  if (failed()) return;
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) error_number_ = errno != 0 ? errno : EIO;
}

std::uint64_t OutputStream::position() {
  const off_t position = ftello(file_);
  if (position < 0 && !failed()) error_number_ = errno;
  return position < 0 ? 0 : std::uint64_t(position);
}

void OutputStream::seek(std::uint64_t position) {
  if (!failed() && fseeko(file_, off_t(position), SEEK_SET) != 0) error_number_ = errno;
}

Status OutputStream::finish() {
  std::FILE* file = std::exchange(file_, nullptr);
  errno = 0;
  int outcome = file == stdout ? std::fflush(file) : std::fclose(file);
  if (outcome != 0 && !failed()) error_number_ = errno != 0 ? errno : EIO;
  if (failed()) return write_error(error_number_);
  return atomic_ ? atomic_->commit() : Status(std::monostate{});
}

}  // namespace krepl::output
