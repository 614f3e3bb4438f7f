#pragma once

#include <stdexcept>
#include <string>

namespace supple {

/// What went wrong at the library's edge: unusable input, an unknown object, a file that cannot be read.
///
/// `what()` is one line without a trailing newline that says what, where and how to mend it, e.g.
/// `rabbit.obj:17: face index 99 is out of range; the file has 12 vertices so far`.
/// A broken invariant inside the library is never an `Error`; it asserts in debug builds.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

/// Called with the message instead of throwing `Error` where the library was compiled without exceptions, as
/// for WebAssembly; without effect elsewhere. It must not return: what failed is left as it was in the
/// middle, so that the objects that took part are of no use any more. Without a handler, or when it returns,
/// the program is aborted.
using FailureHandler = void (*)(const std::string& message);
void set_failure_handler(FailureHandler handler);

}  // namespace supple
