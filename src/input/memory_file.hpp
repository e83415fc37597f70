#pragma once

#include <cpl_vsi.h>

#include <cstdint>
#include <string>
#include <vector>

namespace krepl::input {

/// A file of GDAL's in-memory file system that goes away with this object.
class MemoryFile {
 public:
  MemoryFile(std::vector<char> text, const std::string& extension) : text_(std::move(text)) {
    path_ = "/vsimem/krepl-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + "." + extension;
    VSIFCloseL(VSIFileFromMemBuffer(path_.c_str(), reinterpret_cast<GByte*>(text_.data()), text_.size(), FALSE));
  }
  ~MemoryFile() { VSIUnlink(path_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::vector<char> text_;
  std::string path_;
};

}  // namespace krepl::input
