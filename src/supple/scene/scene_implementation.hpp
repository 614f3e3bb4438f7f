#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broad_phase/pair_finder.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "octree/morton_curve.hpp"
#include "scene/contact_pass.hpp"
#include "scene/containment_cells.hpp"
#include "scene/exact_limit.hpp"
#include "scene/impact_pass.hpp"
#include "scene/manifold_pass.hpp"
#include "scene/nearest_pair.hpp"
#include "scene/object_queries.hpp"
#include "scene/pair_cache.hpp"
#include "scene/penetration_pass.hpp"
#include "scene/proximity_pass.hpp"
#include "scene/scene_object.hpp"
#include "supple/inspection.hpp"
#include "supple/scene.hpp"

namespace supple {

struct PlainScene;

/// These throw an error that names `call`: when the object has no such triangle, when a largest distance is
/// negative or NaN, and when the numbers of queries and results differ.
void check_triangle(const SceneObject& object, std::uint32_t triangle, const char* call);
void check_distance(double distance, const char* call);
void check_counts(std::size_t queries, std::size_t results, const char* call);

/// What a step searches.
struct Question {
  ContactKinds contacts = ContactKinds::none;
  ImpactSearchOptions impact;
  ProximityListing proximity_listing = ProximityListing::features;
  bool colliding_vertices = false;
  bool manifolds = false;
  PenetrationDepths depths = PenetrationDepths::all;
  std::optional<StepOptions> safe_step{};  ///< continuous contacts: for a safe step

  bool has_intersections() const { return contains(contacts, ContactKinds::intersection); }
  bool is_continuous() const { return contains(contacts, ContactKinds::continuous); }
  bool has_penetration() const { return contains(contacts, ContactKinds::penetration); }
  bool has_proximity() const { return contains(contacts, ContactKinds::proximity); }
  /// It searches intersections, or only counts their candidates.
  bool searches_at_rest() const { return contacts == ContactKinds::none || has_intersections(); }
  SearchedShapes shapes() const;
};

/// The objects and the step; `detect` reads as the list of stages.
class Scene::Implementation {
 public:
  explicit Implementation(const SceneOptions& scene_options);

  ObjectId add(const PositionsView& positions, const TrianglesView& triangles,
               const ObjectOptions& object_options, const std::string& fallback_name);
  void remove(ObjectId id);

  /// Throws an error that names `call` when the object is not in the scene.
  SceneObject& object(ObjectId id, const char* call) const;
  /// The same; also throws when the object is static.
  SceneObject& movable_object(ObjectId id, const char* call) const;
  void set_positions(ObjectId id, const PositionsView& positions);
  void set_vertices(ObjectId id, std::span<const std::uint32_t> vertices, const PositionsView& positions);
  void share_positions(ObjectId id, const PositionsView& positions);
  void set_motion(ObjectId id, const PositionsView& from, const PositionsView& to);
  void set_vertex_groups(ObjectId id, std::span<const std::uint32_t> groups,
                         std::span<const std::uint32_t> masks);

  /// Changes a distance of an object's options.
  void set_distance(ObjectId id, double ObjectOptions::*member, double distance, const char* call);

  const DetectResult& detect(const DetectRequest& request);
  std::optional<ContinuousContact> earliest_impact();
  SafeStep collision_free_step(const StepOptions& step);
  std::span<const ObjectStep> collision_free_steps(const StepOptions& step);
  /// Calls `answer(queries, i)` once for each query i.
  template <class Answer>
  void answer_queries(std::span<const Vec3d> places, const StopSignal& stop, const Answer& answer);
  void find_inside(const QueriedObject& object, std::span<const Vec3d> points, const StopSignal& stop,
                   std::span<Containment> results);
  void closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
               const ClosestOptions& query);
  void cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> results, const CastOptions& query);
  std::span<const ListedRayHit> cast_all(std::span<const Ray> rays, const QueryFilter& seen,
                                         const CallLimits& limits);
  void inside(std::span<const Vec3d> points, std::span<Containment> results, const QueryFilter& seen,
              const CallLimits& limits);
  /// For boxes and spheres.
  template <class Region>
  std::span<const Overlap> overlaps(std::span<const Region> regions, const QueryFilter& seen,
                                    const CallLimits& limits);
  std::optional<ProximityPair> distance(ObjectId a, ObjectId b, const CallLimits& limits);
  std::span<const ProximityPair> distances(double max_distance, const CallLimits& limits);
  bool any_contact(ObjectId a, ObjectId b, const CallLimits& limits);
  VerifyReport verify(const CallLimits& limits) const;
  std::vector<WrongAnswer> verify_closest(std::span<const Vec3d> points,
                                          std::span<const std::optional<ClosestPoint>> results,
                                          const ClosestOptions& query) const;
  std::vector<WrongAnswer> verify_cast(std::span<const Ray> rays,
                                       std::span<const std::optional<RayHit>> results,
                                       const CastOptions& query) const;
  std::vector<WrongAnswer> verify_cast_all(std::span<const Ray> rays, std::span<const ListedRayHit> hits,
                                           const QueryFilter& seen) const;
  template <class Region>
  std::vector<WrongAnswer> verify_overlaps(std::span<const Region> regions, std::span<const Overlap> overlaps,
                                           const QueryFilter& seen) const;
  std::vector<WrongAnswer> verify_inside(std::span<const Vec3d> points, std::span<const Containment> results,
                                         const QueryFilter& seen) const;
  std::vector<WrongAnswer> verify_distance(ObjectId a, ObjectId b,
                                           const std::optional<ProximityPair>& found) const;
  std::vector<WrongAnswer> verify_distances(double max_distance, std::span<const ProximityPair> found) const;
  std::vector<WrongAnswer> verify_any_contact(ObjectId a, ObjectId b, bool found) const;
  std::string validate() const;

  std::vector<OctreeCell> octree_cells(ObjectId id, std::optional<std::uint32_t> level) const;
  OctreeCell leaf(ObjectId id, std::uint32_t triangle) const;
  NodePairList node_pairs(ObjectId id_a, ObjectId id_b) const;
  std::uint32_t octree_depth(ObjectId id) const;
  CandidateList candidates(std::size_t limit) const;
  PairExplanation explain(ObjectId id_a, std::uint32_t triangle_a, ObjectId id_b,
                          std::uint32_t triangle_b) const;

  ElementVertices triangle_vertices(ObjectId id, std::uint32_t triangle) const;
  ElementVertices element_vertices(ObjectId id, FeatureKind kind,
                                   const std::array<std::uint32_t, 2>& element) const;
  bool contains(ObjectId id) const;
  std::vector<ObjectId> objects() const;
  /// Call after any change to what `detect` would find.
  void mark_changed() { detected_ = false; }

  SceneOptions options;
  Parallel parallel;
  Parallel serial{1};
  PairFilter filter;
  PairFinder pair_finder;
  DetectResult result;

 private:
  struct Slot {
    std::unique_ptr<SceneObject> object;
    std::uint32_t generation = 0;
  };

  /// Two objects that may be near, their nearest features, and triangles that have these, by the user's
  /// numbers.
  struct NearObjects {
    ObjectPair pair;
    std::optional<ProximityPair> found;
    TrianglePair triangles;
  };

  /// The pairs of objects whose volumes overlap, and all jobs: these pairs and the objects with
  /// self-collision, in canonical order.
  struct Jobs {
    std::vector<ObjectPair> pairs;
    std::vector<ContactJob> jobs;
  };

  double half_separation_of(const SceneObject& object, std::uint32_t index, const Question& question) const;
  void refit_objects(const SearchedShapes& shapes);
  void list_volumes(const Question& question);
  template <class Work, class Function>
  void for_each_object(std::span<const std::uint32_t> indices, const Work& work, const Function& function);
  /// Refits the objects that have moved, without changing the result of `detect`.
  void refit_for_queries();
  /// Throws an error that names `call` when the surface of an object that the query sees is open.
  void check_closed(const QueryFilter& seen, const char* call) const;
  void list_near_objects(double max_distance);
  bool are_far(const ObjectPair& pair) const;
  const QueryBox* updated_fine_boxes(ObjectId id);
  void prepare_nearest(const ObjectPair& pair);
  /// Both objects, the smaller one first.
  ObjectPair two_objects(ObjectId a, ObjectId b, const char* call) const;
  std::optional<ProximityPair> nearest_of(const ObjectPair& pair, double max_distance, const StopSignal& stop,
                                          NearestPairSearch& search, TrianglePair& triangles) const;
  /// Refits the objects that have moved and lists those that the filter lets through.
  void list_queried_objects(const QueryFilter& seen, const char* call);
  void find_object_pairs(Jobs& found);
  void count_queries(const Jobs& jobs);
  void rebuild_degraded(const Jobs& jobs);
  void rebuild_those_that_pay(const Jobs& jobs);
  /// These return false when they were stopped.
  bool find_contacts(const DetectRequest& request, const StopSignal& stop);
  bool find_impacts(const DetectRequest& request, const StopSignal& stop);
  bool find_proximity(const DetectRequest& request, const StopSignal& stop);
  void search_on_the_way(const Question& question);
  void prepare_safe_step(const StepOptions& step);
  ImpactSearchOptions impact_options() const {
    return {options.impact, options.element_kinds, options.continuous_listing, options.max_exact_bits};
  }
  /// Needs the contacts.
  bool find_penetrations(const StopSignal& stop);
  /// What queries and the search for penetrations read.
  QueriedObject queried_object(std::uint32_t index) const;
  /// With their elements on the way, or at its end.
  void list_element_objects(MovingShape::Part part);
  /// `group` holds the reported contacts of the pair; null when there are none.
  std::vector<TrianglePair> verify_contacts(const ObjectPair& pair, const ContactGroup* group,
                                            VerifyReport& report) const;
  void verify_impacts(const ObjectPair& pair, const ContactGroup* group, VerifyReport& report) const;
  void verify_penetrations(const ObjectPair& pair, std::span<const TrianglePair> touching,
                           VerifyReport& report) const;
  void verify_proximity(const ObjectPair& pair, const ContactGroup* group, VerifyReport& report) const;
  class AnswerWords;
  /// The objects that the filter lets through.
  PlainScene plain_scene(const QueryFilter& seen, const char* call) const;
  /// The distance of two objects in words, as found (null: nothing) and by brute force, when they differ.
  std::optional<WrongAnswer> wrong_distance(const ObjectPair& pair, double max_distance,
                                            const ProximityPair* found) const;
  void report_non_finite();
  /// Why a kind of contacts has nothing to test; nothing when something is tested.
  std::optional<NothingToTest> nothing_to_test(ContactKinds kind);
  template <class Accept>
  bool any_candidate_pair(ContactKinds kind, const Accept& accept) const;
  void list_untested(DetectResult& found);
  void find_manifolds(const DetectResult& found);
  void publish();
  void list_touching_pairs(const DetectResult& found);
  void list_deep_pairs(const DetectResult& found);
  void check_penetration(const DetectRequest& request) const;
  void check_manifolds() const;
  /// Throws an error when coordinates of two objects exceed `SceneOptions::max_exact_bits`, unless all
  /// requested contacts are continuous.
  void check_exact_bits(const Jobs& jobs) const;
  /// The same for queries, whose errors name `call`: between pairs of objects, and between the numbers of
  /// queries and the queried objects.
  void check_exact_bits(std::span<const ObjectPair> pairs, const char* call) const;
  void check_exact_bits(const CoordinateBits& queries, const char* call) const;
  bool has_exact_limit() const { return options.max_exact_bits < most_exact_bits; }
  bool volumes_apart(const IndexPair& pair) const;
  bool may_pair(const IndexPair& pair) const;
  /// Without the pair filter.
  bool may_pair_by_groups(const IndexPair& pair) const;
  OctreeView search_view(const SceneObject& object) const {
    if (question_.searches_at_rest()) return object.resting_view();
    return question_.is_continuous() ? object.moving_view() : object.near_view();
  }
  const SceneObject& refitted_object(ObjectId id, const char* call) const;
  /// The pair as the narrow phase sees it, without self-collision culling.
  ObjectPairView search_view(const ContactJob& job) const;
  double reach_of(const ContactJob& job) const {
    return reach_of_margins(slots_[job.a].object->options.margin, slots_[job.b].object->options.margin);
  }
  double separation_of(const ContactJob& job) const {
    return supple::separation_of(question_.impact.impact.min_separation,
                                 slots_[job.a].object->options.min_separation,
                                 slots_[job.b].object->options.min_separation);
  }
  PairExplanation explain_in_order(const ContactJob& job, TrianglePair triangles) const;
  bool touch_on_the_way(const ContactJob& job, TrianglePair triangles) const;
  bool are_near(const ContactJob& job, TrianglePair triangles) const;
  ObjectId id_of(std::uint32_t index) const { return {index, slots_[index].generation}; }
  std::vector<ObjectPair> pairs_to_verify() const;

  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_slots_;
  bool detected_ = false;
  Question question_;  // of the last `detect`
  std::uint64_t step_ = 0;

  // Scratch of a step, by slot.
  std::vector<Aabb> boxes_;
  std::vector<BoundingSphere> spheres_;
  std::vector<std::uint8_t> changed_;
  std::vector<std::uint32_t> changed_slots_;
  std::vector<std::uint64_t> versions_;  // of positions; a version is never used twice
  std::uint64_t last_version_ = 0,
                counted_version_ = 0;  // the newest, and the newest when queries of octrees were counted
  SearchedShapes searched_;            // by the last search
  std::vector<double> growths_;        // of boxes and spheres in the last search
  std::vector<std::uint32_t> stale_, degraded_, small_;
  std::vector<double> queries_;  // of degraded objects
  Jobs jobs_, impact_jobs_;      // of `detect`, and of `earliest_impact`
  std::vector<ObjectPair> touching_pairs_, leaf_pairs_, near_pairs_, deep_pairs_;
  std::vector<ContactObject> contact_objects_;
  std::vector<MovingObject> element_objects_;
  // By slot, of safe steps.
  std::vector<VertexWays> ways_;
  std::vector<std::vector<ChildBoxes>> ways_of_nodes_;
  std::vector<ObjectStep> object_steps_;
  std::vector<QueriedObject> queried_objects_;
  std::vector<PenetratedObject> penetrated_objects_;
  std::vector<ObjectQueries> queries_of_workers_;
  std::vector<CurvePlace> order_of_queries_;
  std::vector<std::vector<CurvePlace>> order_of_workers_;
  std::vector<Vec3d> origins_;  // of rays
  ContainmentCells containment_cells_;
  std::vector<std::vector<Overlap>> overlaps_of_workers_;
  std::vector<Overlap> overlaps_;
  /// The hits of one ray in the list of a worker.
  struct HitsOfRay {
    std::uint32_t worker = 0;
    std::size_t first = 0, count = 0;
  };
  std::vector<HitsOfRay> hits_of_rays_;
  std::vector<std::vector<ListedRayHit>> hits_of_workers_;
  std::vector<ListedRayHit> hits_;
  std::vector<NearestPairSearch> pair_searches_;  // by worker
  /// Triangles with the nearest features of pairs of objects, the user's numbers.
  std::map<ObjectPair, TrianglePair> nearest_triangles_;
  std::vector<NearObjects> near_objects_;
  std::vector<std::uint32_t> by_box_;
  std::vector<ProximityPair> distances_;
  std::vector<NonFiniteVertex> non_finite_;
  std::array<UntestedKind, 4> untested_;
  std::vector<std::uint32_t> candidates_;  // objects with something to test
  PairCache volume_pairs_, narrow_phase_pairs_, contact_pairs_, near_object_pairs_, penetrating_pairs_;
  ContactPass contact_pass_;
  ImpactPass impact_pass_;
  ProximityPass proximity_pass_;
  PenetrationPass penetration_pass_;
  ManifoldPass manifold_pass_;
  std::vector<ManifoldObject> manifold_objects_;
};

}  // namespace supple
