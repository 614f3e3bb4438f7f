#include "objects/local_world.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "supple/topology.hpp"

namespace supple {
namespace {

/// Steps after which an object that no pair needs is forgotten.
constexpr std::uint32_t kept_steps = 16;

std::vector<std::uint32_t> local_numbers(std::span<const std::uint32_t> vertices,
                                         const std::vector<std::uint32_t>& all) {
  std::vector<std::uint32_t> local;
  local.reserve(vertices.size());
  auto at = all.begin();
  for (const std::uint32_t v : vertices) {
    at = std::lower_bound(at, all.end(), v);
    local.push_back(static_cast<std::uint32_t>(at - all.begin()));
  }
  return local;
}

/// Not finite for all vertices.
void clear(Coordinates& coordinates, bool is_double, std::size_t vertices) {
  coordinates.is_double = is_double;
  coordinates.doubles.assign(is_double ? 3 * vertices : 0, std::numeric_limits<double>::quiet_NaN());
  coordinates.floats.assign(is_double ? 0 : 3 * vertices, std::numeric_limits<float>::quiet_NaN());
}

/// Writes x y z of a message to the places of these vertices.
template <class From, class To>
void scatter(std::span<const std::byte> from, std::span<const std::uint32_t> vertices, std::vector<To>& to) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    std::array<From, 3> xyz;
    std::memcpy(xyz.data(), from.data() + i * sizeof xyz, sizeof xyz);
    for (std::size_t axis = 0; axis < 3; ++axis)
      to[3 * std::size_t{vertices[i]} + axis] = static_cast<To>(xyz[axis]);
  }
}

void scatter(std::span<const std::byte> from, bool is_double, std::span<const std::uint32_t> vertices,
             Coordinates& to) {
  if (is_double) {
    scatter<double>(from, vertices, to.doubles);
  } else if (to.is_double) {
    scatter<float>(from, vertices, to.doubles);
  } else {
    scatter<float>(from, vertices, to.floats);
  }
}

}  // namespace

std::optional<std::uint64_t> LocalWorld::version_of(const ClusterName& name) const {
  const auto object = objects_.find(name.object);
  if (object == objects_.end()) return std::nullopt;
  const std::vector<GuestCluster>& clusters = object->second.clusters;
  const auto found = std::lower_bound(clusters.begin(), clusters.end(), name,
                                      [](const GuestCluster& p, const ClusterName& q) { return p.name < q; });
  if (found == clusters.end() || found->name != name) return std::nullopt;
  return found->version;
}

void LocalWorld::begin() {
  for (auto& [id, object] : objects_) {
    for (GuestCluster& cluster : object.clusters)
      cluster.was_needed = std::exchange(cluster.is_needed, false);
  }
}

/// A cluster that is needed, without what it had if it is not known.
LocalWorld::GuestCluster& LocalWorld::need(const ClusterName& name, std::uint64_t version, bool is_known) {
  GuestObject& object = objects_[name.object];
  object.id = name.object;
  auto cluster = std::lower_bound(object.clusters.begin(), object.clusters.end(), name,
                                  [](const GuestCluster& p, const ClusterName& q) { return p.name < q; });
  if (cluster == object.clusters.end() || cluster->name != name)
    cluster = object.clusters.insert(cluster, GuestCluster{});
  if (!is_known) *cluster = {};
  cluster->name = name;
  cluster->is_needed = true;
  cluster->has_moved = cluster->version != version;
  cluster->version = version;
  return *cluster;
}

void LocalWorld::take_own(const ClusterName& name, const HomeObject& home) {
  const bool is_known = version_of(name).has_value();
  GuestCluster& cluster = need(name, home.version(), is_known);
  if (is_known) return;
  cluster.own = &home;
  cluster.groups = home.groups_of(home.clusters[name.cluster]);
  ObjectOptions& options = objects_[name.object].options = home.options;
  options.is_static = false;
}

void LocalWorld::read_cluster(const ClusterName& name, std::uint64_t version, bool has_topology,
                              bool has_positions, Reader& from) {
  GuestCluster& cluster = need(name, version, !has_topology);
  if (has_topology) {
    objects_[name.object].options = read_options(from);
    cluster.topology.elements = from.get_all<std::array<std::uint16_t, 3>>();
    cluster.topology.faces = from.get_all<std::uint32_t>();
    cluster.topology.vertices = from.get_all<std::uint32_t>();
    for (auto& numbers : cluster.groups) numbers = from.get_all<std::uint32_t>();
  }
  if (has_positions) read_positions(cluster, from);
}

void LocalWorld::read_positions(GuestCluster& cluster, Reader& from) {
  cluster.is_double = from.get<bool>();
  const bool has_start = from.get<bool>();
  const auto moment = [&] {
    return cluster.is_double ? from.bytes_of_all<double>() : from.bytes_of_all<float>();
  };
  if (has_start) cluster.start = moment();
  cluster.end = moment();
}

const ClusterTopology& LocalWorld::topology_of(const GuestCluster& cluster) {
  return cluster.own == nullptr ? cluster.topology : cluster.own->clusters[cluster.name.cluster];
}

/// The user's numbers.
std::vector<std::uint32_t> LocalWorld::vertices_of(const GuestCluster& cluster) {
  if (cluster.own == nullptr) return cluster.topology.vertices;
  return cluster.own->vertices_of(cluster.own->clusters[cluster.name.cluster]);
}

void LocalWorld::end(bool are_whole) {
  for (auto at = objects_.begin(); at != objects_.end();) {
    GuestObject& object = (at++)->second;
    const bool is_used = std::any_of(object.clusters.begin(), object.clusters.end(),
                                     [](const GuestCluster& cluster) { return cluster.is_needed; });
    object.unused_steps = is_used ? 0 : object.unused_steps + 1;
    if (object.unused_steps > kept_steps || (!is_used && object.slot == none)) {
      drop(object);
      continue;
    }
    place(object);
    make_solid(object, is_used && are_whole);
  }
  if (!is_arranged_) arrange();
}

void LocalWorld::forget() {
  for (const ObjectId id : world_.objects()) world_.remove(id);
  objects_.clear();
  arrange();
}

/// Parts of a solid are none.
void LocalWorld::make_solid(GuestObject& object, bool is_whole) {
  const bool is_solid = is_whole && object.options.solid;
  world_[object.slot].options.solid = is_solid;
  if (!is_solid || std::exchange(object.is_checked, true)) return;
  const ObjectOctree& octree = world_[object.slot].octree();
  TriangleMesh surface;
  for (std::uint32_t t = 0; t < object.faces.size(); ++t)
    surface.triangles.push_back(octree.user_triangle(t));
  for (std::uint32_t v = 0; v < object.vertices.size(); ++v)
    surface.positions.push_back(world_[object.slot].placement().position(v));
  const std::string fault = fault_of_solid(surface);
  if (!fault.empty()) fail(object.options.name + " is no solid: " + fault);
}

/// Gives the vertices and triangles of the clusters that are needed their places, and forgets the others.
void LocalWorld::number_vertices(GuestObject& object) {
  std::erase_if(object.clusters, [](const GuestCluster& cluster) { return !cluster.is_needed; });
  object.vertices.clear();
  object.faces.clear();
  for (const GuestCluster& cluster : object.clusters) {
    const std::vector<std::uint32_t> vertices = vertices_of(cluster), &faces = topology_of(cluster).faces;
    object.vertices.insert(object.vertices.end(), vertices.begin(), vertices.end());
    object.faces.insert(object.faces.end(), faces.begin(), faces.end());
  }
  sort_once(object.vertices);
  std::sort(object.faces.begin(), object.faces.end());
  object.vertices.shrink_to_fit();
  object.faces.shrink_to_fit();
  for (GuestCluster& cluster : object.clusters)
    cluster.local = local_numbers(vertices_of(cluster), object.vertices);
}

/// The home on this rank that has all of the object in the same order; null when there is none.
const HomeObject* LocalWorld::whole_home(const GuestObject& object) {
  const HomeObject* const home = object.clusters.empty() ? nullptr : object.clusters.front().own;
  // A home that is not needed may be gone.
  const bool has_all =
      home != nullptr && std::all_of(object.clusters.begin(), object.clusters.end(),
                                     [&](const GuestCluster& c) { return c.is_needed && c.own == home; });
  return has_all && home->vertex_count() == object.vertices.size() ? home : nullptr;
}

/// Gathers the positions of the clusters that are needed.
void LocalWorld::gather(GuestObject& object) {
  bool is_double = false, has_start = false;
  for (const GuestCluster& cluster : object.clusters) {
    if (!cluster.is_needed) continue;
    is_double = is_double || (cluster.own != nullptr ? cluster.own->end().is_double : cluster.is_double);
    has_start = has_start || (cluster.own != nullptr ? cluster.own->has_motion() : !cluster.start.empty());
  }
  clear(object.end, is_double, object.vertices.size());
  clear(object.start, is_double, has_start ? object.vertices.size() : 0);
  std::vector<std::byte> own;
  for (GuestCluster& cluster : object.clusters) {
    if (!cluster.is_needed) continue;
    if (cluster.own != nullptr) {
      own.clear();
      Writer to(own);
      cluster.own->write_positions(cluster.name.cluster, to);
      Reader from(own);
      read_positions(cluster, from);
    }
    if (has_start)
      scatter(cluster.start.empty() ? cluster.end : cluster.start, cluster.is_double, cluster.local,
              object.start);
    scatter(cluster.end, cluster.is_double, cluster.local, object.end);
  }
}

/// Moves an object to the positions of the clusters that are needed.
void LocalWorld::place(GuestObject& object) {
  bool is_new = object.slot == none, has_changed = is_new;
  for (const GuestCluster& cluster : object.clusters) {
    is_new = is_new || cluster.is_new;
    has_changed = has_changed || is_new || cluster.has_moved || cluster.is_needed != cluster.was_needed;
  }
  if (!has_changed) return;
  for (GuestCluster& cluster : object.clusters) {
    if (!cluster.is_needed) {
      cluster.version = 0;
    } else if (cluster.own == nullptr && cluster.end.empty() && !cluster.local.empty()) {
      fetch(object, cluster);
    }
  }
  if (is_new) number_vertices(object);
  const HomeObject* const whole = whole_home(object);
  if (whole != nullptr) {
    object.start = object.end = {};
  } else {
    gather(object);
  }
  const Coordinates &start = whole != nullptr ? whole->start() : object.start,
                    &end = whole != nullptr ? whole->end() : object.end;
  for (GuestCluster& cluster : object.clusters) {
    cluster.is_new = cluster.has_moved = false;
    cluster.start = cluster.end = {};
    cluster.kept = {};
  }
  if (is_new) {
    if (object.slot != none) world_.remove(world_.id_of(object.slot));
    object.slot = add(object, end.view()).index;
    object.is_checked = false;
    is_arranged_ = false;
  }
  const ObjectId local = world_.id_of(object.slot);
  if (start.size() != 0) {
    world_.set_motion(local, start.view(), end.view());
    object.start = object.end = {};
  } else {
    world_.share_positions(local, end.view());
  }
}

/// Takes the positions that a cluster had in the last step.
void LocalWorld::fetch(const GuestObject& object, GuestCluster& cluster) const {
  const Placement& placement = world_[object.slot].placement();
  cluster.is_double = placement.shape().is_double();
  Writer to(cluster.kept);
  const auto put = [&](const auto& position) {
    for (const std::uint32_t v : cluster.local) {
      const Vec3d p = position(v);
      if (cluster.is_double) {
        to.put(std::array{p.x, p.y, p.z});
      } else {
        to.put(std::array{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      }
    }
  };
  if (placement.has_motion()) put([&](std::uint32_t v) { return placement.start_position(v); });
  const std::size_t of_start = to.size();
  put([&](std::uint32_t v) { return placement.position(v); });
  cluster.start = std::span<const std::byte>(cluster.kept).first(of_start);
  cluster.end = std::span<const std::byte>(cluster.kept).subspan(of_start);
}

ObjectId LocalWorld::add(GuestObject& object, const PositionsView& positions) {
  ObjectOptions options = object.options;
  options.solid = false;  // until `make_solid`
  std::vector<Triangle> faces(object.faces.size());
  for (const GuestCluster& cluster : object.clusters) {
    const ClusterTopology& topology = topology_of(cluster);
    const std::vector<std::uint32_t> places = local_numbers(topology.faces, object.faces);
    for (std::size_t e = 0; e < topology.elements.size(); ++e) {
      Triangle corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = cluster.local[topology.elements[e][i]];
      if (e < places.size()) {
        faces[places[e]] = corners;
      } else if (corners[0] == corners[1]) {
        options.points.push_back(corners[0]);
      } else {
        options.edges.push_back({corners[0], corners[1]});
      }
    }
  }
  const ObjectId local = world_.add(positions, faces, options, "");
  if (std::any_of(object.clusters.begin(), object.clusters.end(),
                  [](const GuestCluster& cluster) { return !cluster.groups[0].empty(); })) {
    std::vector<std::uint32_t> groups(object.vertices.size(), ~std::uint32_t{0}), masks = groups;
    for (const GuestCluster& cluster : object.clusters) {
      for (std::size_t i = 0; i < cluster.groups[0].size(); ++i) {
        groups[cluster.local[i]] = cluster.groups[0][i];
        masks[cluster.local[i]] = cluster.groups[1][i];
      }
    }
    world_.set_vertex_groups(local, groups, masks);
  }
  return local;
}

void LocalWorld::drop(GuestObject& object) {
  if (object.slot != none) world_.remove(world_.id_of(object.slot));
  is_arranged_ = false;
  objects_.erase(object.id);
}

/// Gives the objects of the world the order of their ids.
void LocalWorld::arrange() {
  std::vector<std::uint32_t> slots;
  by_slot_.clear();
  for (auto& [id, object] : objects_) {
    if (object.slot == none) continue;
    slots.push_back(object.slot);
    by_slot_.push_back(&object);
  }
  world_.arrange(slots);
  std::uint32_t slot = 0;
  for (auto& [id, object] : objects_) {
    if (object.slot != none) object.slot = slot++;
  }
  is_arranged_ = true;
}

std::uint64_t LocalWorld::needed_triangles() const {
  std::uint64_t count = 0;
  for (const auto& [id, object] : objects_) {
    for (const GuestCluster& cluster : object.clusters)
      count += cluster.is_needed ? topology_of(cluster).elements.size() : 0;
  }
  return count;
}

}  // namespace supple
