#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "answers/contact_limit.hpp"
#include "answers/contact_order.hpp"
#include "answers/contact_tasks.hpp"
#include "answers/job_outcomes.hpp"
#include "contact/intersection/crossing_segments.hpp"
#include "contact/intersection/pair_filter.hpp"
#include "contact/intersection/separating_normal.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "core/timer.hpp"
#include "mesh/vertex_triangles.hpp"
#include "narrow_phase/traversal.hpp"
#include "supple/contact.hpp"
#include "supple/result.hpp"
#include "world/object/vertex_groups.hpp"

namespace supple {

/// The data of an object that the pass reads.
struct ContactObject {
  ObjectId id;
  OctreeView view;
  std::span<const std::uint32_t> triangle_ids;  ///< the user's id of each triangle in octree order
  std::size_t vertex_count = 0;
  VertexGroups groups;
  /// The triangles around each vertex, in octree order, if triangles that share one are tested; else null.
  const VertexTriangles* neighbours = nullptr;
};

/// What the pass searches.
struct ContactSearch {
  bool contacts = true;            ///< false: it only counts candidates
  bool contact_points = true;      ///< also the points and the normals of contacts
  bool colliding_vertices = true;  ///< also the vertices in colliding leaves

  constexpr bool operator==(const ContactSearch&) const = default;
};

/// Narrow phase and exact stage of intersections for all jobs of a step, on all workers. The narrow phase
/// hands its candidates to the exact stage in batches. The pass keeps its memory between steps. It is
/// proportional to the contacts of the result: a worker drops those of a job after the first `max_contacts`.
class ContactPass {
 public:
  /// Finds the first `max_contacts` contacts in canonical order, for any number of threads. `jobs` ascend and
  /// contain indices of `objects`; `versions` are those of the objects' positions. Returns false when it was
  /// stopped; the lists are then not valid.
  bool run(std::span<const ContactJob> jobs, std::span<const ContactObject> objects,
           std::span<const std::uint64_t> versions, const ContactSearch& search, std::uint64_t max_contacts,
           const StopSignal& stop, const Parallel& parallel, StepStats& stats);

  std::span<const ContactGroup> groups() const { return groups_; }
  std::span<const Contact> contacts() const { return contacts_; }
  std::span<const ContactPoint> contact_points() const { return points_; }
  std::span<const CollidingVertices> colliding_vertex_groups() const { return vertex_groups_; }
  std::span<const std::uint32_t> colliding_vertices() const { return vertices_; }
  /// There are more than `max_contacts` contacts.
  bool is_truncated() const { return is_truncated_; }
  /// The most points of contacts for which a worker has had memory since it was made.
  std::size_t largest_buffer() const;

 private:
  struct CollidingLeaves {
    std::uint32_t job = 0;
    LeafPair leaves;
  };
  /// The rest of a contact. `FoundContact`, which is sorted, stays small.
  struct ContactDetails {
    Vec3d normal;
    std::uint32_t first_point = 0;  // index into the points of the worker
  };
  struct Worker {
    std::uint16_t number = 0;
    std::size_t last_task = no_task;
    Traversal traversal;
    std::vector<FoundContact> found;  // by all tasks of the worker; triangles have the user's ids
    std::vector<ContactDetails> details;
    std::vector<ContactPoint> points;
    // Pairs that cross in a segment, in octree order. They wait here until there is a whole block of them.
    std::array<TrianglePair, CrossingSegments::capacity + pair_filter_capacity> crossing;
    std::size_t crossing_count = 0;
    CrossingSegments segments;
    std::vector<TrianglePair> neighbours;  // scratch
    // Contacts found one by one whose details have no normal yet, and the indices of these details.
    IntersectingPairs unfinished;
    std::array<std::uint32_t, IntersectingPairs::capacity> unfinished_details;
    std::vector<CollidingLeaves> leaves;
    TaskStats stats;
    // Scratch: sorts the contacts of one job.
    std::vector<FoundContact> of_job;
    ContactOrder order;
  };
  static constexpr std::size_t of_contacts = 0, of_points = 1;
  using Outcomes = JobOutcomes<2>;

  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(std::size_t task, Worker& worker);
  /// What a task tests: the objects of its job.
  struct TaskInput {
    std::uint32_t job;
    ObjectPairView pair;
    PlacedTriangles triangles_a, triangles_b;
    std::span<const std::uint32_t> ids_a, ids_b;
    const ContactObject& object_a;
    const ContactObject& object_b;
  };
  TaskInput input_of_job(std::uint32_t job) const;
  void test_candidates(const TaskInput& input, std::span<const TrianglePair> candidates,
                       Worker& worker) const;
  void test_candidate(const TaskInput& input, TrianglePair candidate, Worker& worker) const;
  template <class Test>
  void for_neighbours(const TaskInput& input, std::size_t task, Worker& worker, const Test& test) const;
  void add_crossing(const TaskInput& input, std::size_t count, Worker& worker) const;
  static void add_normals(Worker& worker);
  void drop_excess(std::uint32_t job, std::size_t first, std::size_t first_point, Worker& worker);
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
