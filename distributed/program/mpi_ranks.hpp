#pragma once

#include <mpi.h>

#include <optional>
#include <string>

#include "moving/ranks.hpp"

namespace supple::cli {

/// Ends the run on a rank other than 0, because all ranks end it. Rank 0 reports why.
struct EndedByAll {};

/// All processes of a job of MPI, in which this is one.
class MpiRanks : public Ranks {
 public:
  /// MPI must be initialized.
  MpiRanks();

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  /// Ranks other than 0 throw `EndedByAll`; rank 0 throws its own exception, or an `Error` that names the
  /// lowest rank that failed.
  void together(const std::function<void()>& work) override;
  int largest(int number) override;
  void check(const DetectionOptions& options, const Input& input) override;
  std::unique_ptr<MovingObjects> move(Input& input, bool records) override;

  /// Collective: the text of the lowest rank that has one.
  std::optional<std::string> first(const std::optional<std::string>& text);
  /// Collective: ends the run on all ranks with this error.
  [[noreturn]] void end(const std::string& error);
  /// All ranks have ended the run; an exception of this rank is no surprise to the others.
  bool has_ended() const { return has_ended_; }
  /// The threads of each rank when the options leave it open: the ranks of a machine share its cores.
  std::uint32_t default_threads() const;

 private:
  int first_with(bool has_text);

  int rank_ = 0, size_ = 1;
  bool has_ended_ = false;
};

}  // namespace supple::cli
