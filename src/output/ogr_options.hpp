#pragma once

#include <cpl_conv.h>

#include <string>

namespace krepl::output {

/// A configuration option of GDAL for this thread, while it lives.
class ScopedOption {
 public:
  ScopedOption(const char* name, const std::string& value) : name_(name) {
    CPLSetThreadLocalConfigOption(name, value.c_str());
  }
  ~ScopedOption() { CPLSetThreadLocalConfigOption(name_, nullptr); }
  ScopedOption(const ScopedOption&) = delete;
  ScopedOption& operator=(const ScopedOption&) = delete;

 private:
  const char* name_;
};

/// The date that goes into files that want one. The same input must give the same bytes, so it is not today's: it is
/// SOURCE_DATE_EPOCH where that is set, else the beginning of 1970.
std::string file_date(const char* pattern);

}  // namespace krepl::output
