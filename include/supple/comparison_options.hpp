#pragma once

#include <cstdint>
#include <optional>

#include "supple/types.hpp"

namespace supple {

// Options to repeat the paper's experiments and to compare methods. No program needs them to find contacts:
// the defaults are the fastest. They are parts of `ObjectOptions` and `SceneOptions`.

/// How the octree of an object is built; see `use_comparison_methods`. The contacts are the same for all.
enum class ObjectOctreeBuild : std::uint8_t {
  /// Top-down. Distributes the triangles among the children so that leaves are about equally full. This takes
  /// the fewest leaves. The arity is eight; `Scene::add` throws `Error` for another one.
  balanced,
  /// Top-down, as in the paper: the children of a node are the octants of its cell.
  regular,
  /// Bottom-up: merges neighbouring triangles into leaves, then leaves into nodes, up to the root.
  bottom_up,
};

/// How a sphere is fitted to a node.
enum class SphereFit : std::uint8_t {
  /// The center of the node's box; the radius reaches the farthest vertex (the paper's eq. 5). Conservative.
  vertices,
  /// The smallest sphere around the vertices, up to rounding: often smaller, never larger than that of
  /// `vertices`. Conservative. The refit takes longer.
  minimal,
  /// Around a point of the medial axis, chosen at rest so that the sphere is smallest, which moves with a
  /// triangle, or as `vertices` where that is smaller. Conservative. Builds and refits take longer.
  medial,
  /// Center and radius from the longest side L of the box (the paper's eq. 3 and 4). The sphere does not
  /// enclose the corners of the box, so `detect` misses collisions. Only to repeat the paper's experiment.
  box,
};

/// How a region of the scene octree is tested against a sphere.
enum class RegionSphereTest : std::uint8_t {
  arvo,       ///< closest point of the region (Arvo 1990)
  grown_box,  ///< the paper's: center inside the region grown by the radius; reports too much near corners
};

/// Shape of the octree of one object. The contacts are the same for all values. The paper's colliding
/// vertices (`ComparisonOptions::colliding_vertices`) depend on the leaves and therefore on these options.
struct ObjectOctreeOptions {
  /// Depth below the root at which splitting ends, 0 to 32 (the paper's level-allowed). It counts levels of
  /// eight children for every arity: a tree of arity 4 may have half as many levels more (rounded down), a
  /// tree of arity 2 three times as many, so that the smallest cell has the same size.
  std::uint32_t max_level = 16;
  /// A node with at most this many triangles is not split, ≥ 1. Vector kernels test the triangles of two
  /// leaves that meet, so small leaves are slower, and they take more memory. The limit is half of this value
  /// when `SceneOptions::contacts` has continuous contacts or proximity, unless the octree is regular.
  std::uint32_t leaf_size = 64;
  /// Children of a node: 8, 4 or 2; balanced octrees have 8. In a regular octree, a level halves a cell along
  /// three axes, two or one, which take turns. Nodes have room for eight children in any case, so fewer
  /// children take more memory and time.
  std::uint32_t arity = 8;
  ObjectOctreeBuild build = ObjectOctreeBuild::balanced;
  /// Rebuild the octree when the object has deformed so much that the accumulated extra query cost exceeds
  /// the cost of a rebuild. Has no effect when the scene reports colliding vertices or uses `SphereFit::box`,
  /// which depend on the leaves.
  bool rebuild_degraded = true;
};

/// The order in which the narrow phase compares the children of two nodes. The candidates are the same, and
/// with spheres those of `one_side_first` can be fewer; the contacts are the same.
enum class Descent : std::uint8_t {
  both_sides,  ///< all children of one node with all of the other, with vector instructions
  /// As in the paper's Figure 4: the children of the first node with the second node, then those that collide
  /// with the children of the second node. `StepStats::boxes_tested` counts only these tests. For
  /// contacts at rest; it is slower and needs `use_comparison_methods`.
  one_side_first,
};

/// A cube: its lowest corner and the length of its edges, > 0. The corner has no coordinate beyond ±1e36, and
/// the edge is from 1e-30 to 1e36, so that single precision can represent its halves.
struct RootCube {
  Vec3d corner{};
  double edge = 0;

  constexpr bool operator==(const RootCube&) const = default;
};

/// The smallest cube around a box, with the same centre. Throws `Error` when the box has no finite size.
RootCube cube_around(Vec3d lowest, Vec3d highest);

/// The most levels of the scene octree that may be there whatever the objects: 8^6 = 262,144 regions.
inline constexpr std::uint32_t most_full_levels = 6;

/// Shape of the octree of the scene. The pairs found are the same for all values. Any value but the default
/// is an `Error` when the broad phase is grid, sweep, brute or sweep3.
struct SceneOctreeOptions {
  /// Depth at which regions no longer expand, 1 to 20; 0 means 20. Far from the origin the depth is less,
  /// because floats cannot represent finer regions there. It counts levels of eight children for every arity,
  /// as `ObjectOctreeOptions::max_level` does.
  std::uint32_t max_level = 0;
  /// A region expands when this many of its objects fit into regions of half its edge, ≥ 2; 0 chooses 2, as
  /// in the paper, for up to 64 objects in the scene, and otherwise 96, which is faster.
  std::uint32_t expand_at = 0;
  /// The pairs are the same for both tests.
  RegionSphereTest region_sphere_test = RegionSphereTest::arvo;
  /// Also count objects that are too large for regions of half the edge, although dividing cannot separate
  /// them, as in the paper's Figure 2: a region expands whenever it has `expand_at` objects. It needs a
  /// `max_level` of at most `most_full_levels`, because each object is then in up to 8^max_level regions.
  bool expand_for_large_objects = false;
  /// Levels that are always there, 0 to `most_full_levels`: regions above this level expand in any case. 1 in
  /// the paper.
  std::uint32_t min_level = 0;
  /// Children of a region: 8, 4 or 2.
  std::uint32_t arity = 8;
  /// The root region. Without a value it is fitted to most of the objects, and again when they leave it. The
  /// outermost regions also contain everything beyond the root, so objects outside are found as well.
  std::optional<RootCube> root{};

  constexpr bool operator==(const SceneOctreeOptions&) const = default;
};

/// Options of a scene for comparison.
struct ComparisonOptions {
  /// How spheres are fitted to nodes, when the bounding volume is the sphere.
  SphereFit sphere_fit = SphereFit::vertices;
  /// Also report the paper's output: the vertices in the colliding leaves of both octrees
  /// (`DetectResult::colliding_vertices`). None are reported when continuous contacts are the only kind. It
  /// needs `use_comparison_methods`.
  bool colliding_vertices = false;
  Descent descent = Descent::both_sides;
  /// Refit in each step only the volume of each object, and the nodes below where two objects may collide, as
  /// in the paper (section 6). The contacts are the same. For intersections and for no contacts, with boxes
  /// or spheres: other kinds, objects that are tested against themselves, and those with edges or points of
  /// no triangle or vertices that are not finite refit all. Octrees are not rebuilt. One thread refits the
  /// nodes. It needs `use_comparison_methods`.
  bool lazy_refit = false;
};

}  // namespace supple
