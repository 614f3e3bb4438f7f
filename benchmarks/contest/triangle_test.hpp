#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contest/contestant.hpp"

namespace supple::benchmarks {

/// Triangle a of copy `object_a` and triangle b of copy `object_b`.
struct CopyPair {
  std::uint32_t object_a = 0, object_b = 0, triangle_a = 0, triangle_b = 0;
};

/// Objects whose boxes overlap, each pair once.
std::vector<IndexPair> overlapping_copies(const DeformingCopies& copies, std::vector<Aabb>& boxes);

/// The candidates whose triangles intersect: boxes first, then sixteen pairs at a time by the signs of
/// volumes in single precision. What these cannot tell beyond their error is decided by
/// `supple::triangles_intersect`, so that the outcome is exact for everyone who hands candidates in.
void keep_intersecting(const DeformingCopies& copies, std::span<const CopyPair> candidates,
                       std::vector<CopyPair>& intersecting);

PairDigest digest_of(std::span<const CopyPair> pairs);

/// What the contestants on deforming copies share: candidates, their test, and the three stages' times.
class CandidateContestant : public CopiesContestant {
 public:
  void frame(const DeformingCopies& copies) final;
  PairDigest pairs() const final { return digest_of(intersecting_); }
  std::vector<StageTime> stages() const final { return stages_; }

 protected:
  /// New positions into whatever is kept.
  virtual void update(const DeformingCopies& copies) = 0;
  /// Pairs that may intersect, among them all whose boxes overlap, into `candidates_`.
  virtual void find_candidates(const DeformingCopies& copies) = 0;

  std::vector<CopyPair> candidates_;

 private:
  std::vector<CopyPair> intersecting_;
  std::vector<StageTime> stages_;
};

}  // namespace supple::benchmarks
