#pragma once

// What the handles of krepl.h are, and the edge at which exceptions and errors become numbers with a message.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/krepl.h"

struct krepl_context {
  unsigned threads = 0;
  krepl_progress progress = nullptr;
  void* user = nullptr;
  std::atomic<bool> cancel{false};
  std::atomic<bool> cancelled_by_progress{false};
  std::string message;
};

namespace krepl::c_interface {

/// The settings of a context that may be null.
Context settings(krepl_context* context);
krepl_status status_of(ErrorCode code);
/// Keeps the text in the context, which may be null.
krepl_status fail(krepl_context* context, krepl_status status, const char* text) noexcept;
krepl_status fail(krepl_context* context, const Error& error);
/// Ends a request to stop that the progress function made: it is for one computation only.
void forget_progress(krepl_context* context) noexcept;

/// Runs `work`, which returns a krepl_status; nothing that it throws gets out.
template <class Work>
krepl_status guarded(krepl_context* context, const Work& work) noexcept {
  krepl_status status;
  try {
    status = work();
  } catch (const std::bad_alloc&) {
    status = fail(context, KREPL_ERROR_MEMORY, "out of memory");
  } catch (const std::exception& exception) {
    status = fail(context, KREPL_ERROR_INTERNAL, exception.what());
  } catch (...) {
    status = fail(context, KREPL_ERROR_INTERNAL, "unknown exception");
  }
  forget_progress(context);
  return status;
}

/// Copies elements [first, first + count) of `total` as the caller's struct, of which only `size` bytes may be known to
/// it.
template <class Element, class Get>
krepl_status copy_elements(krepl_context* context, std::size_t total, std::size_t first, std::size_t count,
                           Element* out, std::size_t size, const Get& get) noexcept {
  return guarded(context, [&]() -> krepl_status {
    if (first > total || count > total - first)
      return fail(context, KREPL_ERROR_USAGE, "the range goes beyond the last element");
    if (count == 0) return KREPL_OK;
    if (out == nullptr) return fail(context, KREPL_ERROR_USAGE, "the array is NULL");
    if (size == 0) return fail(context, KREPL_ERROR_USAGE, "the size of an element is 0; give its sizeof");
    for (std::size_t i = 0; i < count; ++i) {
      const Element element = get(first + i);
      std::memcpy(reinterpret_cast<char*>(out) + i * size, &element, std::min(size, sizeof element));
    }
    return KREPL_OK;
  });
}

}  // namespace krepl::c_interface
