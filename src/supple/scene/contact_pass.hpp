#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/pair_filter.hpp"
#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "narrow_phase/traversal.hpp"
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
  /// A contact as a worker finds it, `contact.first_point` counting that worker's points.
  struct Found {
    std::uint32_t job = 0;
    Contact contact;
  };
  struct CollidingLeaves {
    std::uint32_t job = 0;
    LeafPair leaves;
  };
  struct Worker {
    Traversal traversal;
    TrianglePairBlock<float> floats;
    TrianglePairBlock<double> doubles;
    std::vector<Found> found;
    std::vector<ContactPoint> points;
    std::vector<CollidingLeaves> leaves;
    TaskStats stats;
  };
  /// Where a contact was put, and its place within its job: triangle a, then triangle b.
  struct SortKey {
    std::uint64_t place;
    std::uint32_t worker, index;
  };

  /// What was found for a job: a range of the contacts of its step.
  struct Outcome {
    ContactJob job;
    std::uint64_t version_a = 0, version_b = 0;
    std::uint32_t first_contact = 0, contact_count = 0;
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  void plan_outcomes(std::span<const ContactJob> jobs);
  void append_points(const ContactPoint* points, Contact& contact);
  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(const ContactTask& task, Worker& worker) const;
  void test_candidates(std::uint32_t job, const ObjectPairView& pair,
                       std::span<const TrianglePair> candidates, Worker& worker) const;
  PairVerdicts filter_candidates(const ObjectPairView& pair, std::span<const TrianglePair> candidates,
                                 Worker& worker) const;
  void test_candidate(std::uint32_t job, const ObjectPairView& pair, TrianglePair candidate,
                      Worker& worker) const;
  void add_contact(std::uint32_t job, TrianglePair pair, IntersectionKind kind, std::uint8_t point_count,
                   Worker& worker) const;
  void sort_found();
  void gather_contacts();
  void gather_colliding_vertices();
  void append_marked_vertices(std::uint32_t object, std::span<const CollidingLeaves> leaves, bool side_b);

  std::vector<ContactJob> jobs_;  // to be done; `Found::job` and tasks count these
  std::span<const ContactObject> objects_;
  SceneOptions options_;
  const Parallel* parallel_ = nullptr;

  std::vector<Worker> workers_;
  ContactTasks tasks_;
  std::vector<SortKey> keys_;                // by job
  std::vector<std::uint32_t> first_of_job_;  // in `keys_`, and one past the last
  std::vector<CollidingLeaves> leaves_;
  std::vector<std::uint8_t> marked_;

  std::vector<ContactGroup> groups_;
  std::vector<Contact> contacts_, last_contacts_;
  std::vector<ContactPoint> points_, last_points_;
  std::vector<Outcome> outcomes_, last_outcomes_;  // of all jobs
  bool is_complete_ = true;                        // no exception left the last step unfinished
  std::vector<std::uint32_t> sources_;             // of each outcome: that of the step before, or `none`
  std::vector<CollidingVertices> vertex_groups_;
  std::vector<std::uint32_t> vertices_;
};

}  // namespace supple
