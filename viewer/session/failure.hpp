#pragma once

#include <functional>
#include <optional>
#include <string>

namespace supple::viewer {

struct Failure {
  std::string message;
  bool out_of_memory = false;
};

/// What `action` fails with: the message of the `Error` that it throws, or that there is no memory left, or
/// nothing when it succeeds. Where exceptions are compiled out, what fails does not return: the library's
/// failure handler ends the session.
std::optional<Failure> failure_of_function(const std::function<void()>& action);
template <class Action>
std::optional<Failure> failure_of(const Action& action) {
  return failure_of_function(std::cref(action));  // without a copy, which may ask for memory
}

/// Reports unusable input, as the library does.
[[noreturn]] void fail(const std::string& message);

}  // namespace supple::viewer
