#pragma once

namespace supple::cli {

/// While this object exists, SIGINT and SIGTERM do not end the program but are remembered, so that the
/// current step can finish and files are closed. A second signal of the same kind ends the program
/// immediately.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The number of the received signal, or 0.
  int signal() const;
};

}  // namespace supple::cli
