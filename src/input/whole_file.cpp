#include "input/whole_file.hpp"

#include <cpl_vsi.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "input/geometry_source.hpp"
#include "ogr/message_capture.hpp"

namespace krepl::input {

namespace {

/// A signal makes read() return, so that the wait ends.
Result<std::vector<char>> read_descriptor(int descriptor, const Context& context) {
  std::vector<char> text, block(1 << 16);
  for (;;) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count == 0) return text;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return Error{ErrorCode::io, std::string("cannot be read: ") + std::strerror(errno), "", ""};
    text.insert(text.end(), block.begin(), block.begin() + count);
  }
}

Result<std::vector<char>> read_stream(const std::string& path, const Context& context) {
  if (path == "-") return read_descriptor(STDIN_FILENO, context);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return Error{ErrorCode::io, std::string("cannot be read: ") + std::strerror(errno), "", ""};
  Result<std::vector<char>> text = read_descriptor(descriptor, context);
  ::close(descriptor);
  return text;
}

}  // namespace

bool is_stream(const std::string& path) {
  struct stat status {};
  return path == "-" || (::stat(path.c_str(), &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode)));
}

Result<std::vector<char>> read_whole_file(const std::string& path, const Context& context) {
  if (is_stream(path)) return read_stream(path, context);
  const Result<std::string> checked = checked_path(path);
  if (!checked) return checked.error();
  ogr::initialise();
  ogr::MessageCapture messages;
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(VSIFOpenL(checked->c_str(), "rb"), VSIFCloseL);
  if (!file) return messages.error(ErrorCode::io, "cannot be read");
  std::vector<char> text;
  constexpr std::size_t portion = std::size_t{1} << 20;
  for (std::size_t got = portion; got == portion;) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    const std::size_t before = text.size();
    text.resize(before + portion);
    got = VSIFReadL(text.data() + before, 1, portion, file.get());
    text.resize(before + got);
  }
  if (messages.failed())
    return messages.error(ErrorCode::io, "cannot be read to its end", "", "the file seems to be damaged: get it again");
  return text;
}

}  // namespace krepl::input
