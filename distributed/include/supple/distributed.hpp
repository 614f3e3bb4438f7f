#pragma once

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/call_limits.hpp"
#include "supple/options.hpp"
#include "supple/queries.hpp"
#include "supple/result.hpp"
#include "supple/safe_step.hpp"
#include "supple/types.hpp"
#include "supple/verify.hpp"
#include "supple/views.hpp"

namespace supple {

/// On which rank the contacts of a step are.
enum class ResultPlacement : std::uint8_t {
  gathered,  ///< all on rank 0: the lists of `Scene::detect`
  /// On the rank that added object a; of an object in parts, on the lowest rank that has one of them. The
  /// events and pairs of two objects are on a rank that their ids choose.
  owner,
  /// Where they were found, so nothing is sent: as even as the work. The events and pairs of two objects are
  /// on a rank that their ids choose.
  spread,
};

/// Options of a distributed scene, fixed at its construction and the same on all ranks.
struct DistributedOptions {
  /// `threads` are those of each rank; 0 means the cores of the machine divided by its ranks. The bounding
  /// volume is the box. Options that exist for comparison are errors where they need whole octrees.
  SceneOptions scene{};
  ResultPlacement results = ResultPlacement::gathered;
  /// Objects are cut into clusters of at most this many triangles, which are sent where they may touch
  /// others.
  std::uint32_t cluster_triangles = 2048;
  /// The scene divides space again when the busiest rank has more than this factor of the mean work, and more
  /// than 1.1 times the factor that it had after the last division. At least 1.
  double max_imbalance = 1.25;
};

/// The vertices and triangles of a part of an object, as the numbers that they have in the whole object, each
/// list ascending. Parts share the vertices on their borders; each triangle is in one part.
struct ObjectPart {
  std::span<const std::uint32_t> vertices, triangles;
};

/// What one rank did in the last collective call.
struct DistributedStats {
  std::uint64_t bytes_sent = 0, messages_sent = 0;  ///< to other ranks, without collective calls
  std::uint64_t clusters = 0;                       ///< of the parts that this rank added
  std::uint64_t cluster_pairs = 0;                  ///< that this rank tests
  std::uint64_t triangles = 0;                      ///< that this rank needs for its pairs
  double imbalance = 1;                             ///< work of the busiest rank by the mean
  bool divided = false;                             ///< the call divided space again
};

/// One scene over all ranks of a communicator: the contacts of `Scene::detect`, to the byte, for objects that
/// are on different ranks or in parts on several ones.
///
/// ```cpp
/// supple::DistributedScene scene(MPI_COMM_WORLD);
/// scene.add(supple::ObjectId{id}, positions, triangles);  // each rank its own objects
/// for (;;) {
///   scene.set_positions(supple::ObjectId{id}, positions);
///   for (const supple::Contact& c : scene.detect().contacts) respond(c);  // on rank 0
/// }
/// ```
///
/// The user gives the ids, which are those of the results. Results equal those of one `Scene` whose objects
/// have these ids. An id must not return after its object was removed: a new object takes a higher
/// `ObjectId::generation`.
///
/// Calls that name an object are calls of the ranks that have it. The others are collective: all ranks make
/// them in the same order with the same arguments. The ranks compare their calls, arguments and options
/// first: others are an `Error` on all ranks, which names what differs. An error on one rank, such as bad
/// input or no memory, becomes the same `Error` on all of them, which names the rank.
///
/// Method: clusters of neighbouring triangles are sent as boxes. Recursive coordinate bisection gives each
/// rank a region of space. Two clusters are tested by each rank whose region the intersection of their boxes
/// meets; it gets their vertices, the topology only once, and reports the contacts in its region. Penetration
/// and distances need whole objects: the rank whose region contains the lower corner of what two boxes share
/// gets both.
///
/// Memory of a rank: the positions and triangles that it added, and octrees of the clusters that it needs.
class DistributedScene {
 public:
  /// Collective. Throws `Error` when an option is out of its range, or other than on another rank. Numbers of
  /// threads may differ.
  explicit DistributedScene(MPI_Comm communicator, const DistributedOptions& options = {});
  ~DistributedScene();
  DistributedScene(DistributedScene&&) noexcept;
  DistributedScene& operator=(DistributedScene&&) noexcept;

  /// Adds an object whose triangles are all on this rank. Throws `Error` as `Scene::add` does, when this rank
  /// has the id, and when the options have `weld` or `same_vertex`: weld the mesh first.
  void add(ObjectId id, PositionsView positions, TrianglesView triangles, const ObjectOptions& options = {});
  /// Adds a part of an object. `triangles` have the numbers of the part's vertices: 0 is the first of
  /// `part.vertices`. All ranks give the same options. Throws `Error` as `add` does.
  void add_part(ObjectId id, PositionsView positions, TrianglesView triangles, const ObjectPart& part,
                const ObjectOptions& options = {});
  /// Removes the object, or the part of it that this rank has.
  void remove(ObjectId id);
  /// The positions of the vertices that this rank added, in its order. Copies them, O(n).
  void set_positions(ObjectId id, PositionsView positions);
  /// As `Scene::set_motion`.
  void set_motion(ObjectId id, PositionsView from, PositionsView to);

  // Each rank that has a part of the object makes these calls. When they change something, the next
  // collective call sends the object's topology again and rebuilds its octrees.

  /// As `Scene::set_options`.
  void set_options(ObjectId id, const ObjectChanges& changes);
  /// As `Scene::set_vertex_groups` for the vertices that this rank added, in its order. Ranks that share a
  /// vertex give it the same numbers.
  void set_vertex_groups(ObjectId id, std::span<const std::uint32_t> groups,
                         std::span<const std::uint32_t> masks);
  /// As `Scene::set_pair_filter`. All ranks set a function that gives the same answers. In each collective
  /// call, a rank asks it once for each pair of objects that it may test.
  void set_pair_filter(PairFilter filter);

  /// Finds the contacts as `Scene::detect` does. The result is valid until the next call. Counts of its
  /// statistics are sums over all ranks, its times those of the slowest rank. A stop on one rank stops the
  /// call on all of them. Requests with `max_contacts`, manifolds or first contacts of elements are errors.
  const DetectResult& detect(const DetectRequest& request = {});
  /// As `verify`: the last collective call must be `detect`. The ranks share the pairs of objects, and
  /// all of them get the report. Each rank reads all objects again from the ranks that added them, so the
  /// call also verifies the messages of `detect`. Each rank needs memory for the whole scene.
  VerifyReport verify(const CallLimits& limits = {});
  /// As `Scene::earliest_impact`; the same on all ranks.
  std::optional<ContinuousContact> earliest_impact(const StepLimits& limits = {});
  /// As `Scene::max_step`; the same on all ranks.
  SafeStep max_step(const StepLimits& limits = {});
  /// As `Scene::collision_free_step`; the same on all ranks.
  SafeStep collision_free_step(const StepOptions& options = {}, const StepLimits& limits = {});
  /// As `Scene::distances`, on the ranks that `ResultPlacement` says. A rank gets both objects of a pair. A
  /// stop on one rank is an `Error` on all of them, because an empty list would look like an answer.
  std::vector<ProximityPair> distances(double max_distance, const CallLimits& limits = {});
  /// As `Scene::closest` for the points of this rank, among the objects of all ranks. The options are the
  /// same on all ranks; a signed distance is an error. Each point goes to the ranks whose regions its ball
  /// meets, whose radius is the distance of the farthest corner of a cluster near it.
  void closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
               const ClosestOptions& options = {});

  /// Collective: writes the objects of all ranks, with their options and positions, and what the events of
  /// the next step need, to one file. The file appears when it is whole: an older one stays until then. The
  /// options of the scene and the pair filter are not in it. Throws `Error` when the file cannot be written.
  void save(const std::string& path);
  /// Collective, for a scene without objects: adds those of a file of `save`, spread evenly over the ranks,
  /// however many wrote it. Parts of an object on one rank become one part. With the same options, the next
  /// steps have the results and events that they would have had without the restart. `objects` says what this
  /// rank has now. Throws `Error` when the file cannot be read, is cut off or damaged.
  void load(const std::string& path);

  /// The objects of which this rank has all or a part, ascending.
  std::vector<ObjectId> objects() const;
  /// The numbers of the vertices of the part of an object that this rank has, ascending; empty for a whole
  /// object. Valid until the object is removed.
  std::span<const std::uint32_t> part_vertices(ObjectId id) const;
  /// The positions that were last set, of the vertices that this rank has.
  std::vector<Vec3d> positions(ObjectId id) const;

  int rank() const;
  int rank_count() const;
  /// What this rank did in the last collective call.
  const DistributedStats& stats() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
