#include "supple/distributed.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/stop_signal.hpp"
#include "core/timer.hpp"
#include "distributed_implementation.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/topology.hpp"

namespace supple {
namespace {

constexpr const char* placements[] = {"gathered", "owner", "spread"};

/// Collective: the options, which all ranks have.
const DistributedOptions& checked(const DistributedOptions& options, const Communicator& ranks) {
  ranks.begin([&] {
    const auto refuse = [](const char* what) {
      fail(std::string("DistributedScene: ") + what + "; use a Scene for comparisons");
    };
    const SceneOptions& scene = options.scene;
    check(scene, "DistributedScene");
    if (scene.bounding_volume != BoundingVolume::aabb) refuse("the bounding volume is the box");
    if (scene.comparison.colliding_vertices) refuse("colliding vertices need whole octrees");
    if (scene.comparison.lazy_refit) refuse("lazy refit needs whole octrees");
    if (options.cluster_triangles == 0)
      fail("DistributedOptions: cluster_triangles is 0; it must be positive");
    if (!(options.max_imbalance >= 1))
      fail("DistributedOptions: max_imbalance is " + std::to_string(options.max_imbalance) +
           "; it must be at least 1");
    return CallText("DistributedScene")
        .add("results", std::string(placements[static_cast<std::size_t>(options.results)]))
        .add("cluster_triangles", options.cluster_triangles)
        .add("max_imbalance", options.max_imbalance)
        .add_options(scene);
  });
  return options;
}

/// Collective: the options of the scene with the threads of this rank.
SceneOptions with_threads(SceneOptions options, const Communicator& communicator) {
  const auto ranks = static_cast<std::uint32_t>(communicator.ranks_of_machine());
  if (options.threads == 0) options.threads = std::max(1u, Parallel(0).worker_count() / ranks);
  return options;
}

}  // namespace

DistributedScene::Implementation::Implementation(MPI_Comm communicator,
                                                 const DistributedOptions& distributed_options)
    : ranks(communicator),
      options(checked(distributed_options, ranks)),
      regions_(ranks),
      local_(with_threads(options.scene, ranks)),
      detection_(local_.world()),
      step_search_(local_.world()) {}

void DistributedScene::Implementation::add(ObjectId id, const PositionsView& positions,
                                           const TrianglesView& triangles, const ObjectPart* part,
                                           const ObjectOptions& object_options) {
  if (homes_.contains(id))
    fail("add: object " + std::to_string(id.index) + " (generation " + std::to_string(id.generation) +
         ") is on this rank already; remove it first, and take a higher generation");
  HomeObject object(id, positions, triangles, part, object_options, options.cluster_triangles, additions_++);
  if (object.options.solid && part == nullptr) {
    TriangleMesh surface;
    for (std::size_t v = 0; v < positions.size(); ++v) surface.positions.push_back(positions[v]);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto corners = triangles[t];
      surface.triangles.push_back({static_cast<std::uint32_t>(corners[0]),
                                   static_cast<std::uint32_t>(corners[1]),
                                   static_cast<std::uint32_t>(corners[2])});
    }
    if (const std::string fault = fault_of_solid(surface); !fault.empty())
      fail(object.options.name + " is no solid: " + fault);
  }
  homes_.emplace(id, std::move(object));
  has_changed_ = true;
  has_detected_ = false;
}

void DistributedScene::Implementation::remove(ObjectId id) {
  changing(id, "remove");
  homes_.erase(id);
  has_changed_ = true;
}

HomeObject& DistributedScene::Implementation::home(ObjectId id, const char* call) {
  const auto found = homes_.find(id);
  if (found == homes_.end())
    fail(std::string(call) + ": object " + std::to_string(id.index) + " (generation " +
         std::to_string(id.generation) + ") is not on this rank; call this on the rank that added it");
  return found->second;
}

/// Sums the counts of all ranks; times are those of the slowest one.
void DistributedScene::Implementation::gather_step_stats() {
  result_.stats.object_pairs = object_pairs_.size();
  result_.stats.contacts = result_.contacts.size() + result_.continuous_contacts.size();
  result_.stats.proximity_pairs = result_.proximity_pairs.size();
  result_.stats.penetrations = result_.penetrations.size();
  result_.stats.curves = result_.curves.size();
  std::vector<double> times;
  std::vector<std::uint64_t> counts;
  const auto visit_all = [&](const auto& of_time, const auto& of_count) {
    for_each_field<StepStats>([&](const auto& field) {
      auto& value = result_.stats.*field.member;
      using Value = std::remove_cvref_t<decltype(value)>;
      if constexpr (std::same_as<Value, double>) {
        of_time(value);
      } else if constexpr (std::same_as<Value, std::uint64_t>) {
        of_count(value);
      }
    });
  };
  visit_all([&](double time) { times.push_back(time); }, [&](std::uint64_t n) { counts.push_back(n); });
  ranks.largest(times);
  ranks.sum(counts);
  auto time = times.begin();
  auto count = counts.begin();
  visit_all([&](double& value) { value = *time++; }, [&](std::uint64_t& value) { value = *count++; });
}

/// Keeps what the step cost. The next step reads it to decide whether to divide space again.
void DistributedScene::Implementation::end_step() {
  double work = 0;
  for (const auto& [name, of_cluster] : needed_) work += of_cluster;
  std::vector<double> most{work}, total{work};
  ranks.largest(most);
  ranks.sum(total);
  stats.imbalance = total[0] > 0 ? most[0] * ranks.size() / total[0] : 1;
  if (stats.divided) most_imbalance_ = std::max(options.max_imbalance, 1.1 * stats.imbalance);
  count_messages();
}

void DistributedScene::Implementation::count_messages() {
  stats.bytes_sent = ranks.bytes_sent;
  stats.messages_sent = ranks.messages_sent;
}

const DetectResult& DistributedScene::Implementation::detect(const DetectRequest& request) {
  Timer total;
  ranks.begin([&] {
    question_ = supple::question_of(request, options.scene);
    const auto refuse = [](const char* what) { fail(std::string("DistributedScene::detect: ") + what); };
    if (request.max_contacts != DetectRequest{}.max_contacts) refuse("max_contacts is not supported");
    if (question_.manifolds) refuse("manifolds are not supported");
    if (question_.is_continuous() && question_.impact.listing == ContinuousListing::first)
      refuse("ContinuousListing::first is not supported");
    for (const auto& [id, object] : homes_) {
      if (question_.has_penetration() && object.has_vertex_groups())
        fail("detect: penetration needs all intersections, but " + object.options.name +
             " has vertex groups; remove them with set_vertex_groups");
    }
    return call("detect")
        .add("contacts", question_.contacts)
        .add_options(question_.impact.impact)
        .add("element_kinds", question_.impact.kinds)
        .add("proximity_listing", question_.proximity_listing)
        .add("curves", question_.curves);
  });
  prepare(question_.has_penetration());
  result_ = {};
  result_.step = step_;
  bool is_done = false;
  ranks.together(
      [&] { is_done = detection_.run(question_, request.max_contacts, stop_of(request), result_.stats); });
  if (ranks.any(!is_done)) {
    result_.stopped = true;
    end_step();
    return result_;
  }
  ranks.together([&] { send_results(); });
  send_lists();
  ranks.together([&] { lists_.list(result_); });
  end_step();
  list_untested();
  result_.untested = untested_;
  count_messages();
  ranks.together([&] {
    for (std::size_t list = 0; list < pair_lists; ++list) events_[list].prepare(lists_.pairs[list]);
  });
  // From here on, nothing may run out of memory on one rank.
  for (std::size_t list = 0; list < pair_lists; ++list) events_[list].update(lists_.pairs[list]);
  result_.volume_events = events_[of_volumes].events();
  for (const ContactKindInfo& kind : contact_kinds)
    result_.*kind.events = events_[pair_list_of(kind)].events();
  result_.stats.total_seconds = total.lap();
  gather_step_stats();
  ++step_;
  has_detected_ = true;
  return result_;
}

DistributedScene::DistributedScene(MPI_Comm communicator, const DistributedOptions& options)
    : implementation_(std::make_unique<Implementation>(communicator, options)) {}
DistributedScene::~DistributedScene() = default;
DistributedScene::DistributedScene(DistributedScene&&) noexcept = default;
DistributedScene& DistributedScene::operator=(DistributedScene&&) noexcept = default;

void DistributedScene::add(ObjectId id, PositionsView positions, TrianglesView triangles,
                           const ObjectOptions& options) {
  implementation_->add(id, positions, triangles, nullptr, options);
}
void DistributedScene::add_part(ObjectId id, PositionsView positions, TrianglesView triangles,
                                const ObjectPart& part, const ObjectOptions& options) {
  implementation_->add(id, positions, triangles, &part, options);
}
void DistributedScene::remove(ObjectId id) {
  implementation_->remove(id);
}
void DistributedScene::set_positions(ObjectId id, PositionsView positions) {
  implementation_->changing(id, "set_positions").set_positions(positions);
}
void DistributedScene::set_motion(ObjectId id, PositionsView from, PositionsView to) {
  implementation_->changing(id, "set_motion").set_motion(from, to);
}
const DetectResult& DistributedScene::detect(const DetectRequest& request) {
  return implementation_->detect(request);
}
VerifyReport DistributedScene::verify(const CallLimits& limits) {
  return implementation_->verify(limits);
}
void DistributedScene::set_options(ObjectId id, const ObjectChanges& changes) {
  implementation_->change(id, "set_options", [&](HomeObject& object) {
    const auto [distances, pairs] = change_options(object.options, changes);
    return distances || pairs;
  });
}
void DistributedScene::set_vertex_groups(ObjectId id, std::span<const std::uint32_t> groups,
                                         std::span<const std::uint32_t> masks) {
  implementation_->change(id, "set_vertex_groups", [&](HomeObject& object) {
    object.set_vertex_groups(groups, masks);
    return true;
  });
}
void DistributedScene::set_pair_filter(PairFilter filter) {
  implementation_->set_filter(std::move(filter));
}
std::optional<ContinuousContact> DistributedScene::earliest_impact(const StepLimits& limits) {
  return implementation_->earliest_impact(limits);
}
SafeStep DistributedScene::collision_free_step(const StepOptions& options, const StepLimits& limits) {
  return implementation_->safe_step(options, limits);
}
std::vector<ProximityPair> DistributedScene::distances(double max_distance, const CallLimits& limits) {
  return implementation_->distances(max_distance, limits);
}
void DistributedScene::closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
                               const ClosestOptions& options) {
  implementation_->closest(points, results, options);
}
SafeStep DistributedScene::max_step(const StepLimits& limits) {
  return implementation_->safe_step({}, limits);
}
void DistributedScene::save(const std::string& path) {
  implementation_->save(path);
}
void DistributedScene::load(const std::string& path) {
  implementation_->load(path);
}
std::vector<ObjectId> DistributedScene::objects() const {
  std::vector<ObjectId> ids;
  for (const auto& [id, object] : implementation_->homes()) ids.push_back(id);
  return ids;
}
std::span<const std::uint32_t> DistributedScene::part_vertices(ObjectId id) const {
  return implementation_->home(id, "part_vertices").part_vertices();
}
std::vector<Vec3d> DistributedScene::positions(ObjectId id) const {
  const HomeObject& object = implementation_->home(id, "positions");
  std::vector<Vec3d> found;
  for (std::size_t v = 0; v < object.vertex_count(); ++v) found.push_back(object.end()[v]);
  return found;
}
int DistributedScene::rank() const {
  return implementation_->ranks.rank();
}
int DistributedScene::rank_count() const {
  return implementation_->ranks.size();
}
const DistributedStats& DistributedScene::stats() const {
  return implementation_->stats;
}

}  // namespace supple
