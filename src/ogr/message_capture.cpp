#include "ogr/message_capture.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>

#include <mutex>

namespace krepl::ogr {

struct MessageSink {
  static void CPL_STDCALL take(CPLErr level, CPLErrorNum, const char* message) {
    auto* capture = static_cast<MessageCapture*>(CPLGetErrorHandlerUserData());
    if (level >= CE_Failure) {
      capture->failed_ = true;
      if (capture->failure_.empty()) capture->failure_ = message;
    } else if (level == CE_Warning && capture->warning_.empty()) {
      capture->warning_ = message;
    }
  }
};

MessageCapture::MessageCapture() { CPLPushErrorHandlerEx(MessageSink::take, this); }
MessageCapture::~MessageCapture() { CPLPopErrorHandler(); }

std::string MessageCapture::text() const {
  std::string text = failure_.empty() ? warning_ : failure_;
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text;
}

void MessageCapture::clear() {
  failure_.clear();
  warning_.clear();
  failed_ = false;
}

Error MessageCapture::error(ErrorCode code, const std::string& what, const std::string& where,
                            const std::string& remedy) const {
  std::string said = text();
  return {code, said.empty() ? what : what + " (" + said + ")", where, remedy};
}

void initialise() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    // Answers must come as error values, not as prompts, and files must not grow side files when only read.
    CPLSetConfigOption("GDAL_PAM_ENABLED", "NO");
  });
}

}  // namespace krepl::ogr
