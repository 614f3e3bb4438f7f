#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "contact/element_distance.hpp"
#include "contact/impact_filter.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "narrow_phase/traversal.hpp"
#include "scene/contact_tasks.hpp"
#include "scene/element_candidates.hpp"
#include "scene/job_outcomes.hpp"
#include "supple/proximity.hpp"
#include "supple/result.hpp"

namespace supple {

/// The distance within which elements of the two objects are near.
inline double reach_of_margins(double margin_a, double margin_b) {
  return std::min(margin_a + margin_b, std::numeric_limits<double>::max());
}

/// What a search for proximity lists.
struct ProximitySearch {
  ProximityListing listing = ProximityListing::features;
  ElementKinds kinds = ElementKinds::all;

  constexpr bool operator==(const ProximitySearch&) const = default;
};

/// Narrow phase and exact stage of proximity for all jobs of a step, on all workers. The pass keeps its
/// memory between steps.
class ProximityPass {
 public:
  /// Finds the first `max_pairs` pairs in canonical order. `jobs` ascend and contain indices of `objects`,
  /// which are at rest; `versions` are those of the objects' positions and margins. Returns false when it was
  /// stopped; the lists are then not valid.
  bool run(std::span<const ContactJob> jobs, std::span<const MovingObject> objects,
           std::span<const std::uint64_t> versions, const ProximitySearch& search, std::uint64_t max_pairs,
           const StopSignal& stop, const Parallel& parallel, StepStats& stats);

  std::span<const ContactGroup> groups() const { return groups_; }
  std::span<const ProximityPair> pairs() const { return pairs_; }
  /// There are more than `max_pairs` pairs.
  bool is_truncated() const { return is_truncated_; }

 private:
  /// Orders the pairs of a job canonically and says where each is stored.
  struct Key {
    FeatureKind kind_a{}, kind_b{};
    std::array<std::uint32_t, 2> element_a{}, element_b{};
    std::uint32_t worker = 0, index = 0;

    auto operator<=>(const Key&) const = default;
    bool is_same_pair(const Key& other) const {
      return kind_a == other.kind_a && kind_b == other.kind_b && element_a == other.element_a &&
             element_b == other.element_b;
    }
  };
  struct Worker {
    Traversal traversal;
    RelativeMotionBlock block;
    std::vector<ProximityPair> found;  // by all tasks of the worker
    TaskStats stats;
  };

  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(std::size_t task, std::uint32_t worker);
  void test_candidates(std::uint32_t job, ElementPairKind kind, std::span<const ElementPair> candidates,
                       Worker& worker);
  void add_pair(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
                std::array<std::uint32_t, 4> vertices, Worker& worker);
  void sort_found(const Parallel& parallel);
  void sort_job(std::size_t first_task, std::size_t end_task, std::vector<Key>& keys);

  std::span<const ContactJob> jobs_;
  std::span<const MovingObject> objects_;
  ProximitySearch search_;
  StopSignal stop_;
  std::vector<Worker> workers_;
  ContactTasks tasks_;
  JobOutcomes<1> outcomes_;
  std::vector<std::uint32_t> first_tasks_;  // of each open job, and the number of tasks
  std::vector<std::vector<Key>> keys_;      // of each open job, in order
  std::vector<ContactGroup> groups_;
  std::vector<ProximityPair> pairs_;
  bool is_truncated_ = false;
};

}  // namespace supple
