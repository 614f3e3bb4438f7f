#include "core/error.hpp"

#include "supple/error.hpp"

#if !defined(__cpp_exceptions)
#include <cstdlib>
#endif

namespace supple {

void fail(const std::string& message) {
#if defined(__cpp_exceptions)
  throw Error(message);
#else
  (void)message;
  std::abort();
#endif
}

}  // namespace supple
