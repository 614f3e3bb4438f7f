#pragma once

#include <gtest/gtest.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "supple/distributed.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/random.hpp"

namespace supple {

inline int rank_of_world() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}
inline int size_of_world() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// The same file for all ranks of this job, and for no other job.
inline std::string path_of_job(const std::string& name) {
  int job = static_cast<int>(getpid());
  MPI_Bcast(&job, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return testing::TempDir() + name + "_" + std::to_string(job);
}

/// An object of both scenes. All ranks know all of them.
struct LivingObject {
  ObjectId id;
  TriangleMesh mesh;
  ObjectOptions options;
  bool is_float = false;
  std::vector<int> rank_of_triangle;  // of an object in parts; else empty
  int home = 0;
  Vec3d place;
  std::vector<Vec3d> now, from;
  std::vector<std::uint32_t> groups, masks;  // of vertices
  bool is_on_path = false;
};

/// The vertices and triangles of a part.
struct Part {
  std::vector<std::uint32_t> vertices, triangles;
  std::vector<Triangle> corners;
};

inline Part part_of(const LivingObject& object, int rank) {
  Part part;
  for (std::uint32_t t = 0; t < object.mesh.triangles.size(); ++t) {
    if (object.rank_of_triangle[t] != rank) continue;
    part.triangles.push_back(t);
    for (const std::uint32_t v : object.mesh.triangles[t]) part.vertices.push_back(v);
  }
  std::sort(part.vertices.begin(), part.vertices.end());
  part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
  for (const std::uint32_t t : part.triangles) {
    Triangle corners = object.mesh.triangles[t];
    for (std::uint32_t& corner : corners) {
      corner = static_cast<std::uint32_t>(
          std::lower_bound(part.vertices.begin(), part.vertices.end(), corner) - part.vertices.begin());
    }
    part.corners.push_back(corners);
  }
  return part;
}

template <class Scalar>
std::vector<Vec3<Scalar>> chosen(const std::vector<Vec3d>& positions,
                                 const std::vector<std::uint32_t>* some) {
  std::vector<Vec3<Scalar>> found;
  const auto add = [&](const Vec3d& p) {
    found.push_back({static_cast<Scalar>(p.x), static_cast<Scalar>(p.y), static_cast<Scalar>(p.z)});
  };
  if (some == nullptr) {
    for (const Vec3d& p : positions) add(p);
  } else {
    for (const std::uint32_t v : *some) add(positions[v]);
  }
  return found;
}

/// Calls `use(view)` with views of positions in the object's precision.
template <class Use, class... Lists>
void with_views(bool is_float, const std::vector<std::uint32_t>* some, const Use& use,
                const Lists&... lists) {
  if (is_float) {
    use(PositionsView(chosen<float>(lists, some))...);
  } else {
    use(PositionsView(chosen<double>(lists, some))...);
  }
}

/// The same random objects in one scene and in a distributed one. All ranks have the same random numbers.
class Lives {
 public:
  Lives(std::uint64_t seed, const DistributedOptions& options)
      : random(seed), plain(options.scene), distributed(MPI_COMM_WORLD, options) {}

  void add_object(bool may_be_solid) {
    LivingObject object;
    switch (random.below(5)) {
      case 0:
        object.mesh = make_icosphere(2 + random.below(5));
        break;
      case 1:
        object.mesh = make_torus(8 + random.below(8), 6 + random.below(4));
        break;
      case 2:
        object.mesh = make_cloth(3 + random.below(12), 3 + random.below(12));
        break;
      case 3:
        object.mesh = make_box({0.6, 0.7, 0.8}, 1 + random.below(4));
        break;
      default:
        object.mesh = soup();
        break;
    }
    const bool is_closed = object.mesh.name != "cloth" && object.mesh.name != "soup";
    ObjectOptions& options = object.options;
    options.name = "object " + std::to_string(added_++);
    options.self_collision = random.below(3) == 0;
    if (random.below(4) == 0) options.neighbours = Neighbours::exact;
    options.margin = random.below(2) * random.uniform(0, 0.1);
    options.min_separation = random.below(4) == 0 ? random.uniform(0, 0.02) : 0;
    options.is_static = random.below(6) == 0;
    options.solid = may_be_solid && is_closed && random.below(2) == 0;
    if (random.below(5) == 0) options.group = 2 + random.below(2);
    if (random.below(5) == 0) options.mask = ~std::uint32_t{2};
    if (random.below(4) == 0 && object.mesh.positions.size() > 4) {
      options.edges = {{0, 2}, {1, 3}};
      options.points = {1, 4};
    }
    object.is_float = random.below(3) == 0;
    object.place = random.vector(1.5);
    object.now = moved(object);
    object.id = with_positions(object, object.now, nullptr, [&](const PositionsView& view) {
      return plain.add(view, object.mesh.triangles, options);
    });
    settle(object);
    objects.push_back(std::move(object));
  }

  void change_ranks() {
    if (objects.empty()) return;
    LivingObject& object = objects[random.below(static_cast<std::uint32_t>(objects.size()))];
    leave(object);
    settle(object);
    if (object.is_on_path) place(object);
  }

  /// Changes an option of a random object in both scenes, or the pair filter. Penetration permits no groups
  /// of vertices.
  void change_settings(bool may_group) {
    if (objects.empty()) return;
    LivingObject& object = objects[random.below(static_cast<std::uint32_t>(objects.size()))];
    const auto both = [&](const auto& change) {
      change(plain);
      for_my_part(object, [&](const Part*) { change(distributed); });
    };
    ObjectOptions& options = object.options;
    switch (random.below(7)) {
      case 0:
        options.margin = random.uniform(0, 0.1);
        both([&](auto& scene) { scene.set_options(object.id, {.margin = options.margin}); });
        break;
      case 1:
        options.min_separation = random.uniform(0, 0.02);
        both([&](auto& scene) { scene.set_options(object.id, {.min_separation = options.min_separation}); });
        break;
      case 2:
        options.group = 1 + random.below(3);
        options.mask = 1 + random.below(3);
        both([&](auto& scene) {
          scene.set_options(object.id, {.group = options.group, .mask = options.mask});
        });
        break;
      case 3:
        options.is_static = !options.is_static;
        both([&](auto& scene) { scene.set_options(object.id, {.is_static = options.is_static}); });
        break;
      case 4:
        options.self_collision = !options.self_collision;
        both([&](auto& scene) { scene.set_options(object.id, {.self_collision = options.self_collision}); });
        break;
      case 5:
        if (may_group) set_vertex_groups(object);
        break;
      default: {
        const std::uint32_t divisor = 2 + random.below(4), rest = random.below(2);
        PairFilter filter = [=](ObjectId a, ObjectId b) { return (a.index + b.index) % divisor != rest; };
        if (random.below(3) == 0) filter = {};
        plain.set_pair_filter(filter);
        distributed.set_pair_filter(filter);
      }
    }
  }

  /// Gives all objects other ranks than those where a checkpoint put them.
  void settle_all() {
    for (const ObjectId id : distributed.objects()) distributed.remove(id);
    for (LivingObject& object : objects) {
      settle(object);
      if (object.is_on_path) place(object);
    }
  }

  void remove_object() {
    if (objects.empty()) return;
    const std::uint32_t which = random.below(static_cast<std::uint32_t>(objects.size()));
    plain.remove(objects[which].id);
    leave(objects[which]);
    objects.erase(objects.begin() + which);
  }

  /// Some coordinates are not finite, some far away unless `all_near`.
  void move_objects(bool crowd, bool all_near = false) {
    for (LivingObject& object : objects) {
      if (object.options.is_static || random.below(5) == 0) continue;
      object.place = crowd ? Vec3d{2, 2, 2} + random.vector(0.2) : object.place + random.vector(0.3);
      object.from = object.now;
      object.now = moved(object);
      object.is_on_path = random.below(2) == 0;
      if (random.below(8) == 0)
        object.now[random.below(static_cast<std::uint32_t>(object.now.size()))].y =
            random.below(2) == 0 ? std::numeric_limits<double>::quiet_NaN()
                                 : std::numeric_limits<double>::infinity();
      if (!all_near && random.below(30) == 0) object.now[0].x = 1e30;
      place(object);
      with_views(
          object.is_float, nullptr,
          [&](const PositionsView& from, const PositionsView& now) {
            object.is_on_path ? plain.set_motion(object.id, from, now) : plain.set_positions(object.id, now);
          },
          object.from, object.now);
    }
  }

  RandomNumbers random;
  Scene plain;
  DistributedScene distributed;
  std::vector<LivingObject> objects;

 private:
  TriangleMesh soup() {
    TriangleMesh mesh{.name = "soup", .positions = {}, .triangles = {}};
    const std::uint32_t vertices = 4 + random.below(20);
    for (std::uint32_t v = 0; v < vertices; ++v) mesh.positions.push_back(random.vector(0.6));
    const std::uint32_t triangles = random.below(30);
    for (std::uint32_t t = 0; t < triangles; ++t)
      mesh.triangles.push_back({random.below(vertices), random.below(vertices), random.below(vertices)});
    return mesh;
  }

  std::vector<Vec3d> moved(const LivingObject& object) {
    std::vector<Vec3d> positions;
    const Vec3d stretch{random.uniform(0.7, 1.3), random.uniform(0.7, 1.3), random.uniform(0.7, 1.3)};
    const double noise = random.below(2) * 0.01;
    for (const Vec3d& p : object.mesh.positions)
      positions.push_back(object.place + Vec3d{p.x * stretch.x, p.y * stretch.y, p.z * stretch.z} +
                          random.vector(noise));
    if (object.is_float) {
      for (Vec3d& p : positions) p = {float(p.x), float(p.y), float(p.z)};
    }
    return positions;
  }

  template <class Use>
  static ObjectId with_positions(const LivingObject& object, const std::vector<Vec3d>& positions,
                                 const std::vector<std::uint32_t>* some, const Use& use) {
    ObjectId id;
    with_views(
        object.is_float, some, [&](const PositionsView& view) { id = use(view); }, positions);
    return id;
  }

  /// Gives the object, or parts of it, to ranks.
  void settle(LivingObject& object) {
    const auto ranks = static_cast<std::uint32_t>(size_of_world());
    object.home = static_cast<int>(random.below(ranks));
    object.rank_of_triangle.clear();
    const bool has_extra = !object.options.edges.empty() || !object.options.points.empty();
    if (random.below(2) == 0 && !has_extra && !object.mesh.triangles.empty()) {
      const std::uint32_t way = random.below(2);
      for (std::uint32_t t = 0; t < object.mesh.triangles.size(); ++t) {
        const auto count = static_cast<std::uint32_t>(object.mesh.triangles.size());
        object.rank_of_triangle.push_back(
            static_cast<int>(way == 0 ? t * ranks / count : random.below(ranks)));
      }
    }
    for_my_part(object, [&](const Part* part) {
      with_views(
          object.is_float, part != nullptr ? &part->vertices : nullptr,
          [&](const PositionsView& view) {
            if (part == nullptr) {
              distributed.add(object.id, view, object.mesh.triangles, object.options);
            } else {
              distributed.add_part(object.id, view, part->corners, {part->vertices, part->triangles},
                                   object.options);
            }
          },
          object.now);
    });
    if (!object.groups.empty()) group_my_part(object);
  }

  void set_vertex_groups(LivingObject& object) {
    object.groups.clear();
    object.masks.clear();
    for (std::size_t v = 0; v < object.now.size() && random.below(50) != 0; ++v) {
      object.groups.push_back(1 + random.below(3));
      object.masks.push_back(1 + random.below(3));
    }
    if (object.groups.size() != object.now.size()) object.groups = object.masks = {};
    plain.set_vertex_groups(object.id, object.groups, object.masks);
    group_my_part(object);
  }
  void group_my_part(const LivingObject& object) {
    for_my_part(object, [&](const Part* part) {
      std::vector<std::uint32_t> groups = object.groups, masks = object.masks;
      if (part != nullptr && !groups.empty()) {
        groups = masks = {};
        for (const std::uint32_t v : part->vertices) {
          groups.push_back(object.groups[v]);
          masks.push_back(object.masks[v]);
        }
      }
      distributed.set_vertex_groups(object.id, groups, masks);
    });
  }

  void leave(const LivingObject& object) {
    for_my_part(object, [&](const Part*) { distributed.remove(object.id); });
  }

  void place(const LivingObject& object) {
    for_my_part(object, [&](const Part* part) {
      if (object.options.is_static) distributed.set_options(object.id, {.is_static = false});
      with_views(
          object.is_float, part != nullptr ? &part->vertices : nullptr,
          [&](const PositionsView& from, const PositionsView& now) {
            object.is_on_path ? distributed.set_motion(object.id, from, now)
                              : distributed.set_positions(object.id, now);
          },
          object.from, object.now);
      if (object.options.is_static) distributed.set_options(object.id, {.is_static = true});
    });
  }

  template <class Use>
  static void for_my_part(const LivingObject& object, const Use& use) {
    if (object.rank_of_triangle.empty()) {
      if (object.home == rank_of_world()) use(nullptr);
      return;
    }
    const Part part = part_of(object, rank_of_world());
    if (!part.triangles.empty()) use(&part);
  }

  std::uint32_t added_ = 0;
};

}  // namespace supple
