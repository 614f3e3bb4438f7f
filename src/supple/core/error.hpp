#pragma once

#include <string>

namespace supple {

/// The only function with which the library reports unusable input. It throws `Error`. In builds without
/// exceptions, it passes the message to the failure handler and does not return.
[[noreturn]] void fail(const std::string& message);

}  // namespace supple
