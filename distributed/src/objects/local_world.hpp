#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "bytes.hpp"
#include "objects/home_object.hpp"
#include "renumbered.hpp"
#include "supple/options.hpp"
#include "world/world.hpp"

namespace supple {

/// Names a cluster among all ranks.
struct ClusterName {
  ObjectId object;
  std::int32_t home = 0;
  std::uint32_t addition = 0;  ///< counts what the home has added, because an id can return
  std::uint32_t cluster = 0;

  constexpr auto operator<=>(const ClusterName&) const = default;
};

/// The clusters that a rank needs for its pairs, as objects of a world. The clusters of one object are one
/// object there, in which vertices and triangles have the order of the user's numbers, and the objects have
/// the order of their ids. So contacts have the same sides and the same bits as in the whole scene. Clusters
/// that are not needed now stay for a while, with vertices that are not finite.
class LocalWorld final : public Numbers {
 public:
  explicit LocalWorld(const SceneOptions& options) : world_(options) {}

  /// The version of the positions that it has, 0 for none; nothing when it lacks the topology.
  std::optional<std::uint64_t> version_of(const ClusterName& name) const;
  /// Calls `visit(cluster, version)` for the clusters that it has of an object from one home.
  template <class Visit>
  void for_each_known(ObjectId object, int home, const Visit& visit) const {
    const auto found = objects_.find(object);
    if (found == objects_.end()) return;
    for (const GuestCluster& guest : found->second.clusters) {
      if (guest.name.home == home) visit(guest.name, guest.version);
    }
  }
  /// Starts a step, in which no cluster is needed yet.
  void begin();
  /// Needs a cluster of this rank. Its home must not move while the cluster is needed.
  void take_own(const ClusterName& name, const HomeObject& home);
  /// Reads a cluster that is needed, with what `HomeObject` wrote of it.
  void read_cluster(const ClusterName& name, std::uint64_t version, bool has_topology, bool has_positions,
                    Reader& from);
  /// Places all objects. `are_whole` says that all clusters of the objects are needed: then those that are
  /// solid become solids. Throws `Error` when one is none; call `forget` then.
  void end(bool are_whole);
  /// Forgets all clusters.
  void forget();

  World& world() { return world_; }
  std::uint64_t needed_triangles() const;
  /// The object of the world; nothing when it has no cluster of it.
  std::optional<ObjectId> local_object(ObjectId user) const {
    const auto found = objects_.find(user);
    if (found == objects_.end() || found->second.slot == none) return std::nullopt;
    return world_.id_of(found->second.slot);
  }
  // The user's numbers of an object of the world, and of what belongs to it.
  ObjectId object(ObjectId local) const override { return by_slot_[local.index]->id; }
  std::uint32_t vertex(ObjectId local, std::uint32_t v) const override {
    return by_slot_[local.index]->vertices[v];
  }
  std::uint32_t face(ObjectId local, std::uint32_t t) const override {
    return by_slot_[local.index]->faces[t];
  }

 private:
  struct GuestCluster {
    ClusterName name;
    const HomeObject* own = nullptr;  ///< the home on this rank, which has topology and positions
    ClusterTopology topology;         ///< the user's numbers
    std::array<std::vector<std::uint32_t>, 2> groups;  ///< and masks of the vertices; empty without groups
    std::vector<std::uint32_t> local;                  ///< the vertices in the object of the world
    std::uint64_t version = 0;
    bool is_needed = false, was_needed = false, is_new = true, has_moved = false;
    // Until the object is placed: x y z in the message, or what the cluster keeps of the last step.
    bool is_double = true;
    std::span<const std::byte> start, end;
    std::vector<std::byte> kept;
  };
  struct GuestObject {
    ObjectId id;
    ObjectOptions options;
    std::vector<GuestCluster> clusters;
    std::vector<std::uint32_t> vertices, faces;  ///< the user's numbers, ascending
    Coordinates start, end;                      ///< which the world reads, unless a home has them
    std::uint32_t slot = none;
    std::uint32_t unused_steps = 0;
    bool is_checked = false;  ///< whether it is a solid
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  static void read_positions(GuestCluster& cluster, Reader& from);
  GuestCluster& need(const ClusterName& name, std::uint64_t version, bool is_known);
  static const ClusterTopology& topology_of(const GuestCluster& cluster);
  static std::vector<std::uint32_t> vertices_of(const GuestCluster& cluster);
  static const HomeObject* whole_home(const GuestObject& object);
  void gather(GuestObject& object);
  void place(GuestObject& object);
  void fetch(const GuestObject& object, GuestCluster& cluster) const;
  void make_solid(GuestObject& object, bool is_whole);
  static void number_vertices(GuestObject& object);
  ObjectId add(GuestObject& object, const PositionsView& positions);
  void drop(GuestObject& object);
  void arrange();

  World world_;
  std::map<ObjectId, GuestObject> objects_;
  std::vector<const GuestObject*> by_slot_;
  bool is_arranged_ = true;
};

}  // namespace supple
