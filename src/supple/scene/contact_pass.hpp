#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/pair_filter.hpp"
#include "contact/separating_normal.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "core/timer.hpp"
#include "narrow_phase/traversal.hpp"
#include "scene/contact_limit.hpp"
#include "scene/contact_order.hpp"
#include "scene/contact_tasks.hpp"
#include "scene/job_outcomes.hpp"
#include "supple/contact.hpp"
#include "supple/result.hpp"

namespace supple {

/// What the pass reads of an object.
struct ContactObject {
  ObjectId id;
  OctreeView view;
  std::span<const std::uint32_t> triangle_ids;  ///< octree order to the user's
  std::size_t vertex_count = 0;
};

/// What the pass looks for.
struct ContactSearch {
  bool contacts = true;            ///< or else candidates are counted only
  bool contact_points = true;      ///< also the points of the contacts
  bool colliding_vertices = true;  ///< also the vertices in leaves that collide

  constexpr bool operator==(const ContactSearch&) const = default;
};

/// Narrow phase and exact stage of intersections over all jobs of a step, on all workers. Candidates stream
/// from one to the other in batches. Keeps its memory between steps.
class ContactPass {
 public:
  /// `jobs` ascending; `objects` are addressed by the jobs, and `versions` are of their positions. The first
  /// `max_contacts`, in canonical order whatever the threads. Returns false, the lists being of no use, when
  /// it was stopped.
  bool run(std::span<const ContactJob> jobs, std::span<const ContactObject> objects,
           std::span<const std::uint64_t> versions, const ContactSearch& search, std::uint64_t max_contacts,
           const StopSignal& stop, const Parallel& parallel, StepStats& stats);

  std::span<const ContactGroup> groups() const { return groups_; }
  std::span<const Contact> contacts() const { return contacts_; }
  std::span<const ContactPoint> contact_points() const { return points_; }
  std::span<const CollidingVertices> colliding_vertex_groups() const { return vertex_groups_; }
  std::span<const std::uint32_t> colliding_vertices() const { return vertices_; }
  /// There are more contacts.
  bool is_truncated() const { return is_truncated_; }

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
  static constexpr std::size_t of_contacts = 0, of_points = 1;
  using Outcomes = JobOutcomes<2>;

  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(std::size_t task, Worker& worker);
  /// Contacts come with the octrees' triangles.
  void test_candidates(std::uint32_t job, const ObjectPairView& pair,
                       std::span<const TrianglePair> candidates, Worker& worker) const;
  void test_candidate(const ObjectPairView& pair, TrianglePair candidate, Worker& worker) const;
  static void add_normals(Worker& worker);
  void drop_excess(std::uint32_t job, std::size_t first, Worker& worker);
  void gather_contacts(const Parallel& parallel);
  void renumber_points(std::size_t job);
  std::span<const FoundContact> found_of(std::size_t job, Worker& worker) const;
  void gather_found(std::size_t job, Worker& worker);
  void truncate(std::uint64_t max_contacts);
  void gather_colliding_vertices();
  void append_marked_vertices(std::uint32_t object, std::span<const CollidingLeaves> leaves, bool side_b);

  std::span<const ContactObject> objects_;
  ContactSearch search_;
  StopSignal stop_;

  std::vector<Worker> workers_;
  ContactTasks tasks_;
  ContactLimit limit_;
  Outcomes outcomes_;
  std::vector<CollidingLeaves> leaves_;
  std::vector<std::uint8_t> marked_;

  std::vector<ContactGroup> groups_;
  std::vector<Contact> contacts_;
  std::vector<ContactPoint> points_;
  bool is_truncated_ = false;
  std::vector<CollidingVertices> vertex_groups_;
  std::vector<std::uint32_t> vertices_;
};

}  // namespace supple
