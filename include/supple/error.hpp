#pragma once

#include <stdexcept>
#include <string>

#include "supple/utf8.hpp"

namespace supple {

/// Unusable input: an option out of range, an unknown object, a file that cannot be read.
///
/// `what()` is one line of valid UTF-8 without a trailing newline. It says what is wrong, where, and how to
/// fix it: `rabbit.obj:17: face index 99 is out of range; the file has 12 vertices so far`. A broken
/// invariant inside the library is never an `Error`; it asserts in debug builds.
class Error : public std::runtime_error {
 public:
  /// `what()` returns the message after `one_line`.
  explicit Error(const std::string& message) : std::runtime_error(one_line(message)) {}
};

/// For builds without exceptions, such as WebAssembly; has no effect in other builds. The library calls the
/// handler with the message instead of throwing `Error`. The handler must not return: the call that failed
/// leaves its objects in an undefined state. Without a handler, or when it returns, the program aborts.
using FailureHandler = void (*)(const std::string& message);
void set_failure_handler(FailureHandler handler);

}  // namespace supple
