#pragma once

#include <string>
#include <vector>

#include "krepl/error.hpp"

namespace krepl::ogr {

/// While it lives, takes what GDAL and PROJ say in this thread (they print to standard error otherwise), so that it can
/// be part of an Error. Captures nest.
class MessageCapture {
 public:
  MessageCapture();
  ~MessageCapture();
  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;

  /// True if a failure (not only a warning) was reported since the last clear().
  bool failed() const { return failed_; }
  /// The first failure, else the first warning, else empty; in one line, without a full stop at its end.
  std::string text() const;
  void clear();

  /// An Error of the given code: `what`, followed by GDAL's own words in parentheses where it said any.
  Error error(ErrorCode code, const std::string& what, const std::string& where = {},
              const std::string& remedy = {}) const;

 private:
  friend struct MessageSink;
  std::string failure_, warning_;
  bool failed_ = false;
};

/// Registers GDAL's drivers and sets the options krepl relies on; may be called any number of times.
void initialise();

}  // namespace krepl::ogr
