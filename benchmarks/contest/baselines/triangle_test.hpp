#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contest/contestant.hpp"

namespace supple::benchmarks {

/// Triangle a of copy `object_a` and triangle b of copy `object_b`.
struct CopyPair {
  std::uint32_t object_a = 0, object_b = 0, triangle_a = 0, triangle_b = 0;
};

/// Pairs of copies whose boxes overlap, each once.
std::vector<IndexPair> overlapping_copies(const DeformingCopies& copies, std::vector<Aabb>& boxes);

/// Keeps the candidates whose triangles intersect: compares boxes first, then the signs of volumes of
/// sixteen pairs at a time in single precision. `supple::triangles_intersect` decides pairs within the error
/// bound, so the result is exact for every contestant.
void keep_intersecting(const DeformingCopies& copies, std::span<const CopyPair> candidates,
                       std::vector<CopyPair>& intersecting);

PairDigest digest_of(std::span<const CopyPair> pairs);

/// The common part of all contestants on deforming copies: candidates, the triangle test, and times of the
/// three stages.
class CandidateContestant : public CopiesContestant {
 public:
  void frame(const DeformingCopies& copies) final;
  PairDigest pairs() const final { return digest_of(intersecting_); }
  std::vector<StageTime> stages() const final { return stages_; }
  std::span<const CopyPair> intersecting() const { return intersecting_; }

 protected:
  /// Updates the data structures with the new positions.
  virtual void update(const DeformingCopies& copies) = 0;
  /// Writes pairs that may intersect into `candidates_`, including all pairs whose boxes overlap.
  virtual void find_candidates(const DeformingCopies& copies) = 0;

  std::vector<CopyPair> candidates_;

 private:
  std::vector<CopyPair> intersecting_;
  std::vector<StageTime> stages_;
};

/// A contestant that also computes a normal and contact points for each pair that another one finds, in plain
/// double precision, as users of that library would.
std::unique_ptr<CopiesContestant> with_contact_points(std::unique_ptr<CandidateContestant> finder);

}  // namespace supple::benchmarks
