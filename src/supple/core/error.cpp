#include "core/error.hpp"

#include <cstdlib>

#include "supple/error.hpp"

namespace supple {
namespace {

FailureHandler failure_handler = nullptr;

}  // namespace

void set_failure_handler(FailureHandler handler) {
  failure_handler = handler;
}

void fail(const std::string& message) {
#if defined(__cpp_exceptions)
  throw Error(message);
#else
  if (failure_handler != nullptr) failure_handler(one_line(message));
  std::abort();
#endif
}

}  // namespace supple
