#pragma once

#include <string>

namespace supple {

/// The one door through which the library reports unusable input: throws `Error`, or, where exceptions are
/// compiled out, hands the message to the failure handler and does not return.
[[noreturn]] void fail(const std::string& message);

}  // namespace supple
