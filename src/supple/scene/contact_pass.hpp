#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/pair_filter.hpp"
#include "contact/separating_normal.hpp"
#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "narrow_phase/traversal.hpp"
#include "scene/contact_order.hpp"
#include "scene/contact_tasks.hpp"
#include "supple/contact.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"

namespace supple {

/// What the pass reads of an object.
struct ContactObject {
  ObjectId id;
  OctreeView view;
  std::span<const std::uint32_t> triangle_ids;  ///< octree order to the user's
  std::size_t vertex_count = 0;
  std::uint64_t version = 0;  ///< another one whenever a position is, and of each object
};

/// Narrow phase and exact stage over all jobs of a step, on all workers. Candidates stream from one to the
/// other in batches. Of two objects that are where they were, contacts are taken from the step before. Keeps
/// its memory between steps.
class ContactPass {
 public:
  /// `jobs` ascending; `objects` are addressed by the jobs. The outcome is in canonical order whatever the
  /// threads.
  void run(std::span<const ContactJob> jobs, std::span<const ContactObject> objects,
           const SceneOptions& options, const Parallel& parallel, StepStats& stats);

  std::span<const ContactGroup> groups() const { return groups_; }
  std::span<const Contact> contacts() const { return contacts_; }
  std::span<const ContactPoint> contact_points() const { return points_; }
  std::span<const CollidingVertices> colliding_vertex_groups() const { return vertex_groups_; }
  std::span<const std::uint32_t> colliding_vertices() const { return vertices_; }

 private:
  struct CollidingLeaves {
    std::uint32_t job = 0;
    LeafPair leaves;
  };
  /// Kept apart from `FoundContact`, which is sorted.
  struct ContactDetails {
    Vec3d normal;
    std::uint32_t first_point = 0;  // in the worker's points
  };
  struct Worker {
    std::uint16_t number = 0;
    Traversal traversal;
    std::vector<FoundContact> found;  // of its tasks, one after the other
    std::vector<ContactDetails> details;
    std::vector<ContactPoint> points;
    IntersectingPairs unfinished;  // the last of `details` still lack their normals
    std::vector<CollidingLeaves> leaves;
    TaskStats stats;
    // For putting the contacts of one job at a time into order.
    std::vector<FoundContact> of_job;
    ContactOrder order;
  };
  struct Range {
    std::uint32_t first = 0, count = 0;

    std::uint32_t end() const { return first + count; }
  };
  /// What a task found: ranges of its worker's contacts and points.
  struct TaskOutcome {
    std::uint32_t worker = 0;
    Range contacts, points;
  };
  /// What was found for a job: ranges of the contacts and points of its step.
  struct Outcome {
    ContactJob job;
    std::uint64_t version_a = 0, version_b = 0;
    Range contacts, points;
  };
  /// Where an outcome comes from: that of the step before, or else tasks of this step.
  struct Source {
    std::uint32_t known = none;
    std::uint32_t first_task = 0, task_count = 0;
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  void plan_outcomes(std::span<const ContactJob> jobs);
  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(const ContactTask& task, Worker& worker);
  /// Contacts come with the octrees' triangles; `ids_a` and `ids_b` are the user's.
  void test_candidates(const ObjectPairView& pair, std::span<const std::uint32_t> ids_a,
                       std::span<const std::uint32_t> ids_b, std::span<const TrianglePair> candidates,
                       Worker& worker) const;
  void test_candidate(const ObjectPairView& pair, TrianglePair candidate, Worker& worker) const;
  static void add_normals(Worker& worker);
  void gather_contacts();
  void place_outcomes();
  template <class Item>
  void move_known(std::vector<Item>& items, Range Outcome::*range);
  void renumber_points(const Outcome& known, const Outcome& outcome);
  std::span<const FoundContact> found_of(const Source& source, Worker& worker) const;
  void gather_found(const Source& source, const Outcome& outcome, Worker& worker);
  void list_groups();
  void gather_colliding_vertices();
  void append_marked_vertices(std::uint32_t object, std::span<const CollidingLeaves> leaves, bool side_b);

  std::vector<ContactJob> jobs_;  // to be done; tasks count these
  std::span<const ContactObject> objects_;
  SceneOptions options_;
  const Parallel* parallel_ = nullptr;

  std::vector<Worker> workers_;
  ContactTasks tasks_;
  std::vector<TaskOutcome> task_outcomes_;
  std::vector<CollidingLeaves> leaves_;
  std::vector<std::uint8_t> marked_;

  std::vector<ContactGroup> groups_;
  std::vector<Contact> contacts_;
  std::vector<ContactPoint> points_;
  std::vector<Outcome> outcomes_, last_outcomes_;  // of all jobs
  bool is_complete_ = true;                        // no exception left the last step unfinished
  std::vector<Source> sources_;                    // of each outcome
  std::vector<CollidingVertices> vertex_groups_;
  std::vector<std::uint32_t> vertices_;
};

}  // namespace supple
