#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace krepl::input {

/// Reads JSON from a file piece by piece, in the order it stands there, so that a file of any size needs a fixed
/// buffer. Each function takes one thing and returns false if something else stands there; the first such place is
/// kept.
class JsonScanner {
 public:
  /// The file stays the caller's.
  explicit JsonScanner(std::FILE* file);

  bool number(double& value);
  bool index(std::uint32_t& value);
  bool string(std::string& value);
  /// Takes `null` if it stands next; true if it did. No failure otherwise.
  bool null();
  /// Any value, which is thrown away.
  bool skip_value();
  /// Nothing but white space up to the end of the file.
  bool end();

  /// `each` takes one element; returns false to stop.
  template <class F>
  bool array(F&& each) {
    if (!expect('[')) return false;
    if (next_is(']')) return take();
    do {
      if (!each()) return false;
    } while (next_is(',') && take());
    return expect(']');
  }
  /// `each(key)` takes the value of the key.
  template <class F>
  bool object(F&& each) {
    if (!expect('{')) return false;
    if (next_is('}')) return take();
    std::string key;
    do {
      if (!string(key) || !expect(':') || !each(key)) return false;
    } while (next_is(',') && take());
    return expect('}');
  }

  /// Keeps what is wrong, if nothing was before. Returns false.
  bool fail(std::string_view what);
  const std::string& failure() const { return failure_; }
  /// "line L, byte B".
  std::string place() const;

 private:
  bool next_is(char c);
  bool expect(char c);
  bool take() { return ++at_, true; }
  char peek();
  void fill();

  std::FILE* file_;
  std::vector<char> buffer_;
  std::size_t at_ = 0, end_ = 0;
  std::uint64_t passed_ = 0, line_ = 1;
  int depth_ = 0;
  std::string failure_;
};

}  // namespace krepl::input
