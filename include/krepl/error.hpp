#pragma once

#include <string>
#include <utility>
#include <variant>

namespace krepl {

/// What kind of failure an Error reports; the command line maps `usage` to exit status 2, all others to 1.
enum class ErrorCode {
  usage,        ///< a parameter is out of its range (radius zero, unknown format)
  input,        ///< the data cannot be taken as they are (empty, NaN, wrong geometry)
  io,           ///< a file cannot be read or written
  computation,  ///< a result could not be certified; nothing is returned rather than something broken
  cancelled     ///< the caller asked to stop
};

/// A failure as a value. `what` says what is wrong, `where` names the feature, line or coordinate (may be empty),
/// `remedy` says what to do about it (may be empty). None of them ends with a full stop.
struct Error {
  ErrorCode code = ErrorCode::input;
  std::string what;
  std::string where;
  std::string remedy;

  /// "what, where; remedy", leaving out what is empty.
  std::string text() const {
    std::string t = what;
    if (!where.empty()) t += ", " + where;
    if (!remedy.empty()) t += "; " + remedy;
    return t;
  }
};

/// Either a value or an Error; the library throws nothing of its own (std::bad_alloc passes through).
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  /// Precondition: ok().
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  /// Precondition: !ok().
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// The Result of an action that returns nothing.
using Status = Result<std::monostate>;

}  // namespace krepl
