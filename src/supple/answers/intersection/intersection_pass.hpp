#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "answers/pass.hpp"
#include "answers/question.hpp"
#include "contact/intersection/crossing_segments.hpp"
#include "contact/intersection/pair_filter.hpp"
#include "contact/intersection/separating_normal.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "mesh/vertex_triangles.hpp"
#include "octree/object_octree.hpp"
#include "supple/contact.hpp"
#include "supple/result.hpp"
#include "world/object/vertex_groups.hpp"

namespace supple {

/// The data of an object that the pass reads.
struct IntersectedObject {
  ObjectId id;
  OctreeView view;
  const ObjectOctree* octree = nullptr;
  VertexGroups groups;
  /// The triangles around each vertex, if triangles that share one are tested; else null.
  const VertexTriangles* neighbours = nullptr;
};

/// What the pass searches.
struct IntersectionSearch {
  bool contacts = true;            ///< false: it only counts candidates
  bool contact_points = true;      ///< also the points and the normals of contacts
  bool colliding_vertices = true;  ///< also the vertices in colliding leaves

  constexpr bool operator==(const IntersectionSearch&) const = default;
};

/// A contact before it enters the result. The job says which two objects it belongs to.
struct FoundContact {
  std::uint32_t triangle_a = 0, triangle_b = 0;
  std::uint32_t details = 0;  ///< index into the details of the worker that found it
  std::uint16_t worker = 0;
  IntersectionKind kind = IntersectionKind::segment;
  std::uint8_t point_count = 0;
};
static_assert(sizeof(FoundContact) == 16);

struct CollidingLeaves {
  std::uint32_t job = 0;
  LeafPair leaves;
};
/// The vertices in colliding leaves, by job.
struct CollidingVertexLists {
  std::vector<CollidingLeaves> leaves;
  std::vector<CollidingVertices> groups;
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint8_t> marked;  // scratch: by vertex of an object
};

/// What a worker of `IntersectionPass` has.
struct IntersectionWorker : PassWorker<FoundContact> {
  /// The rest of a contact. `FoundContact`, which is sorted, stays small.
  struct Details {
    Vec3d normal;
    std::uint32_t first_point = 0;  ///< index into `points`
  };
  std::vector<Details> details;
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
  std::vector<FoundContact> sorted;  // those of one job

  void start() {
    details.clear();
    points.clear();
    crossing_count = 0;
    unfinished.clear();
    leaves.clear();
  }
  std::size_t capacity() const { return points.capacity(); }
  std::array<std::uint32_t, 2> sizes() const {
    return {static_cast<std::uint32_t>(found.size()), static_cast<std::uint32_t>(points.size())};
  }
};

/// Narrow phase and exact stage of intersections for all jobs of a step, on all workers. The narrow phase
/// hands its candidates to the exact stage in batches. The memory is proportional to the contacts of the
/// result: a worker drops those of a job after the first `max_contacts`.
class IntersectionPass : public Pass<IntersectionPass, IntersectedObject, IntersectionWorker, Contact> {
 public:
  static constexpr ContactKinds answers = ContactKinds::intersection;
  static constexpr auto list_of_records = &DetectResult::contacts;
  static IntersectionSearch search_of(const Question& question, const DetectResult&) {
    return {question.has_intersections(), question.contact_points || question.has_penetration(),
            question.colliding_vertices};
  }
  /// Finds the first `max_contacts` contacts in canonical order, for any number of threads. Returns false
  /// when it was stopped; the lists are then not valid.
  bool run(const PassInput& input, std::span<const IntersectedObject> objects,
           const IntersectionSearch& search, StepStats& stats);

  std::span<const Contact> contacts() const { return records_; }
  std::span<const ContactPoint> contact_points() const { return points_; }
  void list(DetectResult& found) const {
    Pass::list(found);
    found.contact_points = points_;
    found.colliding_vertex_groups = colliding_.groups;
    found.colliding_vertices = colliding_.vertices;
  }
  template <class Visit>
  void visit_lists(const Visit& visit) {
    Pass::visit_lists(visit);
    visit(points_);
    visit(colliding_.groups);
    visit(colliding_.vertices);
  }

 private:
  friend Pass;
  static constexpr std::size_t of_contacts = 0, of_points = 1;

  ObjectPairView view_of_job(std::uint32_t job) const;
  void run_task(std::size_t task, Worker& worker);
  /// What a task tests: the objects of its job.
  struct TaskInput {
    std::uint32_t job;
    ObjectPairView pair;
    PlacedTriangles triangles_a, triangles_b;
    std::span<const std::uint32_t> ids_a, ids_b;
    const Object& object_a;
    const Object& object_b;
  };
  TaskInput input_of_job(std::uint32_t job) const;
  void test_candidates(const TaskInput& input, std::span<const TrianglePair> candidates,
                       Worker& worker) const;
  void test_candidate(const TaskInput& input, TrianglePair candidate, Worker& worker) const;
  template <class Test>
  void for_neighbours(const TaskInput& input, std::size_t task, Worker& worker, const Test& test) const;
  void add_crossing(const TaskInput& input, std::size_t count, Worker& worker) const;
  static void add_normals(Worker& worker);
  static bool is_before(const FoundContact& p, const FoundContact& q) {
    const auto triangles = [](const FoundContact& f) {
      return std::uint64_t{f.triangle_a} << 32 | f.triangle_b;
    };
    return triangles(p) < triangles(q);
  }
  static std::uint64_t place_of(std::uint32_t job, const FoundContact& found) {
    return ContactLimit::place(job, found.triangle_a);
  }
  void drop_points(std::size_t first, std::size_t first_point, Worker& worker) const;
  void move_known();
  void gather_found(std::size_t outcome, Worker& worker, const Parallel& parallel);
  void gather_colliding_vertices();

  IntersectionSearch search_;
  std::vector<ContactPoint> points_;
  CollidingVertexLists colliding_;
};

}  // namespace supple
