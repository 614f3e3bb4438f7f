#include "failure.hpp"

#include <new>

#include "supple/error.hpp"

#if defined(__cpp_exceptions)

namespace supple::viewer {

std::optional<Failure> failure_of_function(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return Failure{error.what()};
  } catch (const std::bad_alloc&) {
    return Failure{"there is not enough memory for that; show fewer or smaller objects", true};
  }
  return std::nullopt;
}

void fail(const std::string& message) {
  throw Error(message);
}

}  // namespace supple::viewer

#else

namespace supple {
/// Defined in core/error.hpp; calls the failure handler where exceptions are compiled out.
[[noreturn]] void fail(const std::string& message);
}  // namespace supple

namespace supple::viewer {

std::optional<Failure> failure_of_function(const std::function<void()>& action) {
  action();
  return std::nullopt;
}

void fail(const std::string& message) {
  supple::fail(message);
}

}  // namespace supple::viewer

#endif
