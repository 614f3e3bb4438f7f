#pragma once

#include <array>
#include <atomic>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contact/impact_filter.hpp"
#include "core/parallel.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/vertex_buffer.hpp"
#include "scene/contact_tasks.hpp"
#include "supple/contact.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"

namespace supple {

/// What the pass reads of an object in motion; `start` and `end` are the same at rest.
struct MovingObject {
  ObjectId id;
  OctreeView view;
  const VertexBuffer* start = nullptr;
  const VertexBuffer* end = nullptr;
  std::span<const std::uint32_t> triangle_ids, vertex_ids;  ///< octree order to the user's
};

/// Narrow phase and exact stage of continuous contacts over all jobs of a step, on all workers. Candidates
/// stream from one to the other in batches. Keeps its memory between steps.
class ImpactPass {
 public:
  /// All contacts, in canonical order whatever the threads. `jobs` ascending; `objects` are addressed by
  /// them.
  void run(std::span<const ContactJob> jobs, std::span<const MovingObject> objects,
           const ImpactOptions& options, const Parallel& parallel, StepStats& stats);
  /// The first contact in time, then in order.
  std::optional<ContinuousContact> find_earliest(std::span<const ContactJob> jobs,
                                                 std::span<const MovingObject> objects,
                                                 const ImpactOptions& options, const Parallel& parallel);

  std::span<const ContactGroup> groups() const { return groups_; }
  std::span<const ContinuousContact> contacts() const { return contacts_; }

 private:
  /// Where a contact stands in the canonical order, and where it is kept.
  struct Key {
    std::uint32_t job = 0;
    ElementPairKind kind = ElementPairKind::vertex_face;
    std::array<std::uint32_t, 2> element_a{}, element_b{};
    std::uint32_t worker = 0, index = 0;

    auto operator<=>(const Key&) const = default;
  };
  struct Worker {
    Traversal traversal;
    RelativeMotionBlock block;
    std::vector<ContinuousContact> found;
    std::vector<Key> keys, merged_keys;
    TaskStats stats;
    /// Of `find_earliest`.
    std::optional<ContinuousContact> earliest;
    Key earliest_key;
  };
  enum class Search : std::uint8_t { all, earliest };

  void search(Search search, std::span<const ContactJob> jobs, std::span<const MovingObject> objects,
              const ImpactOptions& options, const Parallel& parallel);
  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(const ContactTask& task, Worker& worker);
  void test_candidates(std::uint32_t job, ElementPairKind kind, std::span<const ElementPair> candidates,
                       Worker& worker);
  void test_candidate(std::uint32_t job, ElementPairKind kind, ElementPair candidate, Worker& worker);
  void keep(Key key, const ContinuousContact& contact, Worker& worker);
  void merge_keys();
  void gather_contacts();

  Search search_ = Search::all;
  std::span<const ContactJob> jobs_;
  std::span<const MovingObject> objects_;
  ImpactOptions options_;
  const Parallel* parallel_ = nullptr;
  std::vector<Worker> workers_;
  ContactTasks tasks_;
  /// Nothing that touches only later than this is looked for.
  std::atomic<float> latest_ = 1;

  std::vector<ContactGroup> groups_;
  std::vector<ContinuousContact> contacts_;
};

}  // namespace supple
