#pragma once

namespace supple::cli {

/// While it lives, SIGINT and SIGTERM do not end the program but are remembered, so that the step under way
/// can be finished and files closed. A second one of the same kind ends it at once.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The number of the signal that came, 0 when none did.
  int signal() const;
};

}  // namespace supple::cli
