#include "input/whole_file.hpp"

#include <sys/stat.h>

#include "input/byte_stream.hpp"

namespace krepl::input {

bool is_stream(const std::string& path) {
  struct stat status {};
  return path == "-" || (::stat(path.c_str(), &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode)));
}

Result<std::vector<char>> read_whole_file(const std::string& path, const Context& context) {
  Result<ByteStream> stream = ByteStream::open(path);
  if (!stream) return stream.error();
  std::vector<char> text;
  for (std::size_t portion = std::size_t{1} << 16;; portion = std::size_t{1} << 20) {
    const std::size_t before = text.size();
    text.resize(before + portion);
    const Result<std::size_t> got = stream->read(text.data() + before, portion, context);
    if (!got) return got.error();
    text.resize(before + *got);
    if (*got == 0) return text;
  }
}

}  // namespace krepl::input
