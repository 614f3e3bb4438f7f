#pragma once

#include <cstdio>
#include <cstdlib>
#include <source_location>
#include <string>
#include <string_view>

namespace supple::fuzz {

/// Ends the program when `holds` is false, so that the fuzzer keeps the input. Not an `assert`, because
/// release builds check, too.
inline void check(bool holds, std::string_view what,
                  const std::source_location& place = std::source_location::current()) {
  if (holds) return;
  std::fprintf(stderr, "%s:%u: wrong: %.*s\n", place.file_name(), static_cast<unsigned>(place.line()),
               static_cast<int>(what.size()), what.data());
  std::abort();
}

/// Every message of an `Error` is one line that begins with what it is about.
inline void check_message(const std::string& message, std::string_view begin) {
  check(message.starts_with(begin) && message.size() > begin.size(),
        "the message does not name the input: " + message);
  check(message.find_first_of("\r\n") == std::string::npos, "the message has several lines: " + message);
}

}  // namespace supple::fuzz
