#pragma once

#include <functional>
#include <optional>
#include <string>

namespace supple::viewer {

struct Failure {
  std::string message;
  bool out_of_memory = false;
};

/// Runs `action` and returns how it failed: with the message of an `Error`, or for lack of memory. Returns
/// nothing on success. Where exceptions are compiled out, a failure does not return: the failure handler of
/// the library ends the session.
std::optional<Failure> failure_of_function(const std::function<void()>& action);
template <class Action>
std::optional<Failure> failure_of(const Action& action) {
  return failure_of_function(std::cref(action));  // std::cref avoids a copy, which might allocate
}

/// Reports unusable input in the way of the library.
[[noreturn]] void fail(const std::string& message);

}  // namespace supple::viewer
