#include "c_interface/handles.hpp"

#define KREPL_TEXT_OF(x) #x
#define KREPL_TEXT(x) KREPL_TEXT_OF(x)

namespace krepl::c_interface {

Context settings(krepl_context* context) {
  Context result;
  if (context == nullptr) return result;
  result.threads = context->threads;
  result.cancel = &context->cancel;
  if (context->progress != nullptr) {
    result.progress = [context](double fraction) {
      if (context->progress(fraction, context->user) == 0) return;
      context->cancelled_by_progress = true;
      context->cancel = true;
    };
  }
  return result;
}

krepl_status status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return KREPL_ERROR_USAGE;
    case ErrorCode::input:
      return KREPL_ERROR_INPUT;
    case ErrorCode::computation:
      return KREPL_ERROR_COMPUTATION;
    case ErrorCode::cancelled:
      return KREPL_ERROR_CANCELLED;
    case ErrorCode::io:
      break;  // the core reads and writes no files
  }
  return KREPL_ERROR_INTERNAL;
}

krepl_status fail(krepl_context* context, krepl_status status, const char* text) noexcept {
  if (context == nullptr) return status;
  try {
    context->message = text;
  } catch (...) {
    context->message.clear();  // no memory even for that: the status has to do
  }
  return status;
}

krepl_status fail(krepl_context* context, const Error& error) {
  return fail(context, status_of(error.code), error.text().c_str());
}

void forget_progress(krepl_context* context) noexcept {
  if (context != nullptr && context->cancelled_by_progress.exchange(false)) context->cancel = false;
}

}  // namespace krepl::c_interface

const char* krepl_version(void) {
  return KREPL_TEXT(KREPL_VERSION_MAJOR) "." KREPL_TEXT(KREPL_VERSION_MINOR) "." KREPL_TEXT(KREPL_VERSION_PATCH);
}

int32_t krepl_interface_version(void) { return KREPL_INTERFACE_VERSION; }

const char* krepl_status_text(krepl_status status) {
  switch (status) {
    case KREPL_OK:
      return "done";
    case KREPL_ERROR_USAGE:
      return "a parameter is out of its range";
    case KREPL_ERROR_INPUT:
      return "the data cannot be taken as they are";
    case KREPL_ERROR_COMPUTATION:
      return "the result could not be certified";
    case KREPL_ERROR_CANCELLED:
      return "cancelled";
    case KREPL_ERROR_MEMORY:
      return "out of memory";
    case KREPL_ERROR_INTERNAL:
      return "a fault of krepl";
    default:
      return "unknown status";
  }
}

krepl_context* krepl_context_create(void) { return new (std::nothrow) krepl_context; }

void krepl_context_destroy(krepl_context* context) { delete context; }

krepl_status krepl_context_set_threads(krepl_context* context, uint32_t threads) {
  if (context == nullptr) return KREPL_ERROR_USAGE;
  context->threads = threads;
  return KREPL_OK;
}

krepl_status krepl_context_set_progress(krepl_context* context, krepl_progress progress, void* user) {
  if (context == nullptr) return KREPL_ERROR_USAGE;
  context->progress = progress;
  context->user = user;
  return KREPL_OK;
}

void krepl_context_cancel(krepl_context* context) {
  if (context != nullptr) context->cancel = true;
}

void krepl_context_resume(krepl_context* context) {
  if (context != nullptr) context->cancel = false;
}

const char* krepl_context_message(const krepl_context* context) {
  return context == nullptr ? "" : context->message.c_str();
}
