#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "answers/detection.hpp"
#include "answers/impact/step_search.hpp"
#include "answers/untested.hpp"
#include "call_text.hpp"
#include "communicator.hpp"
#include "found_lists.hpp"
#include "objects/home_object.hpp"
#include "objects/local_world.hpp"
#include "regions.hpp"
#include "scene/pair_cache.hpp"
#include "supple/broad_phase.hpp"
#include "supple/distributed.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/queries.hpp"

namespace supple {

/// The cluster of a `ClusterName` that stands for all clusters of its object.
constexpr std::uint32_t all_clusters = ~std::uint32_t{0};

/// A cluster or an object, as the ranks whose regions it meets get it.
struct Unit {
  ClusterName name;  ///< `all_clusters` for an object
  Aabb box;
  std::uint32_t triangles = 0;
  std::uint32_t group = 1, mask = ~std::uint32_t{0};
  bool is_static = false, self_collision = false;

  bool may_pair(const Unit& other) const {
    if (name.object == other.name.object) return self_collision;
    return !(is_static && other.is_static) && (group & other.mask) != 0 && (other.group & mask) != 0;
  }
};

/// A step is a row of exchanges: the boxes of clusters and objects go to the ranks whose regions they meet;
/// these ask for the clusters of their pairs, and get them; what they find goes to where the results are.
class DistributedScene::Implementation {
 public:
  Implementation(MPI_Comm communicator, const DistributedOptions& distributed_options);

  void add(ObjectId id, const PositionsView& positions, const TrianglesView& triangles,
           const ObjectPart* part, const ObjectOptions& object_options);
  void remove(ObjectId id);
  HomeObject& home(ObjectId id, const char* call);
  /// To change what the next search finds.
  HomeObject& changing(ObjectId id, const char* call) {
    has_detected_ = false;
    return home(id, call);
  }
  void set_filter(PairFilter given) {
    has_detected_ = false;
    filter_ = std::move(given);
  }
  /// Changes what the ranks with clusters of the object know of it, unless `change(object)` is false.
  template <class Change>
  void change(ObjectId id, const char* call, const Change& change) {
    HomeObject& object = changing(id, call);
    if (!change(object)) return;
    object.addition = additions_++;
    has_changed_ = true;
  }
  const DetectResult& detect(const DetectRequest& request);
  VerifyReport verify(const CallLimits& limits);
  std::optional<ContinuousContact> earliest_impact(const StepLimits& limits);
  SafeStep safe_step(const std::optional<StepOptions>& step, const StepLimits& limits);
  std::vector<ProximityPair> distances(double max_distance, const CallLimits& limits);
  void closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
               const ClosestOptions& closest_options);
  void save(const std::string& path);
  void load(const std::string& path);
  const std::map<ObjectId, HomeObject>& homes() const { return homes_; }

  Communicator ranks;
  const DistributedOptions options;
  DistributedStats stats;

 private:
  CallText call(const char* name) const {
    return CallText(name).add("pair filter", std::string(filter_ ? "set" : "none"));
  }
  World& world() { return local_.world(); }
  void prepare(bool by_objects = false, double growth = 0);
  void exchange_units();
  void fetch_clusters();
  void agree_on_objects();
  void divide_space();
  /// What concerns most ranks goes to all of them in one call, not in a message to each.
  bool is_wide(std::span<const int> of) const {
    return 2 * of.size() > static_cast<std::size_t>(ranks.size());
  }
  void send_units();
  void send_unit(const Unit& unit, const std::vector<int>& homes);
  bool accepts(const Unit& a, const Unit& b);
  bool is_tested(ObjectId a, ObjectId b) const;
  void read_units(const Inbox& wide);
  void find_object_pairs();
  void find_cluster_pairs();
  void request_clusters();
  void answer_requests();
  void take_clusters();

  std::optional<ContinuousContact> first_of_all(const std::optional<ContinuousContact>& own);
  void clear_lists();
  void send_lists();
  void release_messages();

  ObjectId user(ObjectId local) const { return local_.object(local); }
  Vec3d lower_corner(ObjectId object, FeatureKind kind, const std::array<std::uint32_t, 2>& element,
                     bool on_the_way);
  bool is_mine(const ListInfo& list, const std::byte* row);
  bool reports_all(ObjectId a, ObjectId b);
  int rank_of_pair(ObjectId a, ObjectId b) const;
  FoundLists& lists_of(ObjectId a);
  void send_pair(std::size_t list, ObjectId p, ObjectId q);
  struct PointQuery;
  struct Candidate;
  class SeenClusters;
  std::vector<PointQuery> query_points(std::span<const Vec3d> points, const SeenClusters& seen);
  void need_clusters_near(std::vector<PointQuery>& points, const SeenClusters& seen);
  void send_nearest(std::span<const PointQuery> points, const ClosestOptions& closest_options);
  static ClosestPoint nearest_of(std::span<const Candidate> candidates, const Vec3d& point);
  void send_groups(const DetectResult& found, const ContactKindInfo& kind);
  void send_all(const DetectResult& found, const char* name);
  void send_results();
  bool has_pair_to_test(ContactKinds kind);
  void list_untested();
  TestableObject testable(ContactKinds kind, const HomeObject& object);
  void gather_step_stats();
  void end_step();
  void count_messages();

  std::map<ObjectId, HomeObject> homes_;
  PairFilter filter_;
  std::uint32_t additions_ = 0;
  bool has_changed_ = true;  // objects were added or removed on this rank
  bool has_parts_ = false;   // on any rank
  Regions regions_;
  double most_imbalance_ = 1;  // above it, the next step divides space again
  LocalWorld local_;
  Detection detection_;
  StepSearch step_search_;
  Outbox outbox_;
  std::vector<std::byte> to_all_;  // a message
  Inbox inbox_;
  // What a step computes.
  Question question_;
  Region region_;
  bool by_objects_ = false;              // whole objects are tested
  double growth_ = 0;                    // of boxes, for a search of distances
  std::map<ObjectPair, bool> filtered_;  // what the filter said
  std::vector<Unit> objects_, clusters_;
  std::map<ObjectId, std::vector<int>> homes_of_;  // of `objects_`
  std::vector<ObjectPair> object_pairs_, tested_;  // of this rank; `tested_` also of an object with itself
  std::map<ObjectId, int> owners_;                 // the first homes of objects with clusters here
  std::vector<std::pair<ClusterName, double>> needed_;  // ascending, with their work
  BroadPhase object_phase_{{.threads = 1}}, cluster_phase_{{.threads = 1}};
  FoundLists lists_;
  std::map<int, FoundLists> outgoing_;        // by rank
  std::array<PairCache, pair_lists> events_;  // of the lists of pairs
  DetectResult result_;
  bool has_detected_ = false;  // the last call on this rank was a whole `detect`
  std::vector<UntestedKind> untested_;
  std::uint64_t step_ = 0;
};

}  // namespace supple
