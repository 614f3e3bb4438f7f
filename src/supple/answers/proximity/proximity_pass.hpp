#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "answers/element_candidates.hpp"
#include "answers/pass.hpp"
#include "answers/question.hpp"
#include "answers/search_options.hpp"
#include "contact/distance/distance_batch.hpp"
#include "contact/distance/recent_elements.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "queries/pairs/proximity_pair.hpp"
#include "supple/proximity.hpp"
#include "supple/result.hpp"

namespace supple {

/// What a search for proximity lists.
struct ProximitySearch {
  ProximityListing listing = ProximityListing::features;
  ElementKinds kinds = ElementKinds::all;

  constexpr bool operator==(const ProximitySearch&) const = default;
};

/// A pair within the margins. Several candidates may have the same closest features, and so the same name and
/// the same numbers, which are computed for one of them.
struct FoundPair {
  std::uint32_t job = 0;
  PairName name;
  CandidateKind kind{};
  FeatureCode code{};
  ElementPair candidate;

  /// An edge and a face; `code` says nothing.
  bool crosses() const { return kind > CandidateKind::edge_edge; }
  bool operator<(const FoundPair& other) const {
    return job != other.job ? job < other.job : name < other.name;
  }
  bool operator==(const FoundPair& other) const { return job == other.job && name == other.name; }
  std::uint32_t hash() const {
    std::uint64_t hash = job;
    for (const std::uint32_t id :
         {name.element_a[0], name.element_a[1], name.element_b[0], name.element_b[1]})
      hash = (hash ^ id) * 0x9e3779b97f4a7c15u;
    return static_cast<std::uint32_t>(hash >> 32);
  }
};

/// What a worker of `ProximityPass` has.
struct ProximityWorker : PassWorker<FoundPair> {
  /// Candidates of one job that follow each other in `found`.
  struct Run {
    std::uint32_t job = 0, first = 0, end = 0;
  };

  PointsBlock block;
  // Pairs whose numbers are computed together.
  std::array<std::array<PairElement, 2>, DistanceBatch::capacity> elements;
  std::array<FoundFeatures, DistanceBatch::capacity> features;
  std::array<ElementDistance, DistanceBatch::capacity> distances;
  DistanceBatch batch;
  std::vector<Run> runs;        // of finished tasks, or of what was merged
  std::uint32_t run_first = 0;  // where the present task began to add candidates after those
  std::size_t merge_at = 0;     // size of `found`
  bool is_full = false;         // nothing after the last of what was merged is needed
  FoundPair last;
  // The hashes of some that were added before, and their places in `found`.
  std::array<std::array<std::uint32_t, 2>, 8192> recent{};
  /// What only exact arithmetic decides, of one job.
  struct Decision {
    std::optional<ClosestFeatures> features;
    bool used_exact = false;
  };
  RecentElements<Decision> decisions;
  std::uint32_t job_of_decisions = 0;

  void start();
};

/// Narrow phase and exact stage of proximity for all jobs of a step, on all workers. The memory is
/// proportional to the pairs of the result: a worker merges candidates with the same features when its buffer
/// is full, and drops those after the first `max_pairs`.
class ProximityPass : public Pass<ProximityPass, MovingObject, ProximityWorker, ProximityPair> {
 public:
  static constexpr ContactKinds answers = ContactKinds::proximity;
  static constexpr auto list_of_records = &DetectResult::proximity_pairs;
  static ProximitySearch search_of(const Question& question, const DetectResult&) {
    return {question.proximity_listing, question.impact.kinds};
  }
  /// Finds the first `max_contacts` pairs in canonical order; the objects are at rest. Returns false when it
  /// was stopped; the lists are then not valid.
  bool run(const PassInput& input, std::span<const MovingObject> objects, const ProximitySearch& search,
           StepStats& stats);

  std::span<const ProximityPair> pairs() const { return records_; }

 private:
  friend Pass;
  /// The elements of a candidate in the order of `ElementPoints`.
  struct Elements {
    ElementIds first, second;
    std::array<std::uint32_t, 4> vertices;  // of first, then of second, in the order of their corners
    bool is_swapped = false;  // two edges of one object, in the other order than the candidate's

    ClosestFeatures features_of(FeatureCode code) const;
  };
  /// A candidate that may cross.
  struct Crossing {
    const MovingObject &of_edge, &of_face;
    const Edge& edge;
    const Triangle& face;
    std::uint32_t triangle;
  };

  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(std::size_t task, Worker& worker);
  void test_candidates(std::uint32_t job, ElementPairKind kind, std::span<const ElementPair> candidates,
                       Worker& worker);
  void add(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
           const std::array<std::uint32_t, 4>& vertices, FeatureCode code, Worker& worker);
  FeatureCode decide(std::uint32_t job, ElementPairKind kind, ElementPair candidate, Worker& worker) const;
  Crossing crossing_of(std::uint32_t job, CandidateKind kind, ElementPair candidate) const;
  void test_crossings(std::uint32_t job, CandidateKind kind, std::span<const ElementPair> candidates,
                      Worker& worker);
  static std::array<PairElement, 2> with_points(const Crossing& crossing);
  Elements elements_of(std::uint32_t job, ElementPairKind kind, ElementPair candidate) const;
  std::array<PairElement, 2> with_points(std::uint32_t job, ElementPairKind kind,
                                         const Elements& elements) const;
  PairOrder order_of(std::uint32_t job, CandidateKind kind) const;
  void keep(const FoundPair& found, Worker& worker) const;
  void merge(Worker& worker) const;
  void sort_found(const Parallel& parallel);
  void sort_job(std::uint32_t job, BucketSort& order, std::vector<FoundPair>& sorted) const;
  void compute_found(const Parallel& parallel);
  void compute_pairs(std::uint32_t job, std::span<const FoundPair> found, Worker& worker,
                     ProximityPair* pairs);

  ProximitySearch search_;
  std::uint64_t max_pairs_ = 0;
  std::size_t least_merge_ = 0;  // size of `found`
  /// Part of a list of `sorted_`.
  struct Block {
    std::uint32_t list = 0, first = 0;
    std::uint32_t place = 0;  // in the result
  };
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> found_jobs_;
  std::vector<std::vector<FoundPair>> sorted_;  // of each of these jobs, each name once
};

}  // namespace supple
