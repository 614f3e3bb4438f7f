#pragma once

namespace supple::cli {

/// Scripts rely on these values.
enum ExitStatus : int {
  exit_done = 0,
  exit_contact = 1,  ///< --fail-on-contact, and something touches
  exit_differ = 1,   ///< supple diff found a difference
  exit_unusable =
      2,  ///< usage or input error, reported in one line on standard error; a motion that blew up; or
          ///< --fail-on-contact, and nothing was tested
  exit_differences = 3,    ///< --verify found a difference, or an answer of a query is false
  exit_interrupted = 128,  ///< plus the number of the signal that ended a run early
};

}  // namespace supple::cli
