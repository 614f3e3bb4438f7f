#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "answers/intersection/intersection_pass.hpp"
#include "broad_phase/overlap_kernel.hpp"
#include "broad_phase/pair_search.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/object_octree.hpp"
#include "octree/octree_topology.hpp"
#include "octree/volumes/node_volumes.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/views.hpp"
#include "world/world.hpp"

namespace supple {

/// Builds an octree from its leaves to its root in O(n log n). Triangles merge into leaves of up to
/// `leaf_size` triangles. Leaves merge into nodes of up to `arity` children, and so do nodes, up to the root.
/// Where the octree would be deeper than `max_level` allows, its deepest nodes are leaves.
///
/// Clusters lie in the order of the Morton curve through the centres. In each round, each cluster chooses the
/// cluster near it along the curve with which it has the smallest common box, and clusters that chose each
/// other merge. Clusters that lie too far apart merge only while clusters are less than half full. (Meister
/// and Bittner, "Parallel locally-ordered clustering for bounding volume hierarchy construction", 2018.)
/// There, merging makes a binary tree. Here, it makes clusters of limited size, which become the leaves and
/// nodes.
///
/// A triangle with a vertex that is not finite has no box, so it merges with any neighbour.
OctreeTopology build_bottom_up_octree(const PositionsView& positions, std::span<const Triangle> triangles,
                                      std::span<const Vec3d> centers, const ObjectOctreeOptions& options);

/// Builds the paper's regular octree over the centres of triangles, in O(n log n): the children of a node are
/// the octants of its cell. A centre that is not finite counts as the lower corner of the others. Equal
/// centres cannot be split and may leave a leaf larger than `leaf_size`.
OctreeTopology build_regular_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options);

/// `SphereFit::minimal` starts with the sphere of `SphereFit::vertices`. Then it finds the vertex farthest
/// from the centre and computes the smallest sphere of this vertex and of the up to four vertices on the
/// sphere before, again and again, until no vertex is outside. (Gärtner, "Fast and robust smallest enclosing
/// balls", 1999.) It takes the smallest of these spheres after their radii reached the farthest vertex, so
/// the result encloses all vertices and is never larger than the first, even when rounding ends the search
/// early.
///
/// `SphereFit::medial` tries, for each node at rest, the middle of its box and up to 32 points of the medial
/// axis (`medial_depths`), and keeps the centre with the smallest sphere, as Bradshaw and O'Sullivan,
/// "Adaptive medial-axis approximation for sphere-tree construction", 2004, place spheres; here, each node
/// has one. About O(n log n), once. Each refit moves the centre with its triangle and takes the smaller one
/// of the spheres around it and around the middle of the box.
///
/// The three fits search the farthest vertex below a node top-down and skip children whose sphere ends before
/// the farthest vertex so far. A refit takes O(n · levels).
std::unique_ptr<NodeVolumes> make_spheres(SphereFit fit, const ObjectOctree& octree,
                                          const PositionsView& rest_positions);

/// Oriented boxes, rounded outward. Their axes are the principal axes of the surface, as in Gottschalk, Lin
/// and Manocha, "OBBTree", 1996; the area as weight makes them independent of the tessellation. They are
/// never larger than the box of the triangles: they equal that box when the principal axes are worse. They
/// are infinite when coordinates are so large that squares overflow. A refit takes O(vertices · levels).
std::unique_ptr<NodeVolumes> make_oriented_boxes(std::size_t nodes);

/// The slabs that make k-DOPs of the boxes. A refit takes O(vertices).
std::unique_ptr<NodeVolumes> make_kdops(BoundingVolume kind, std::size_t nodes);

/// Sweep and prune (Baraff 1992) along the axis with the largest variance of the centres. Without sorting,
/// every volume against every other, O(n²): the reference for all other methods.
class SweepSearch final : public PairSearch {
 public:
  explicit SweepSearch(bool sorts) : sorts_(sorts) {}

  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;

 private:
  bool sorts_;
  BoxLanes lanes_;
  std::vector<std::uint64_t> order_;  // `order_key` of the boxes that are not empty
  PairSorter sorter_;
};

/// Sweep and prune with a sorted list of the ends of all boxes along each axis, as Baraff describes it
/// ("Dynamic simulation of non-penetrating rigid bodies", 1992). Each step sorts the lists by insertion,
/// which is fast when the order hardly changes, and only exchanges of two ends begin and end pairs. When a
/// box appears, disappears or becomes empty, the lists and the pairs are made again.
class ThreeAxisSweep final : public PairSearch {
 public:
  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;

 private:
  /// The lower or upper end of a box along one axis.
  struct End {
    float value;
    std::uint32_t slot;
    bool is_upper;
    /// Boxes that touch overlap, so lower ends come first.
    bool operator<(const End& other) const {
      return value < other.value || (value == other.value && is_upper < other.is_upper);
    }
  };
  /// The list of an axis, and what its last sorting did.
  struct Axis {
    std::vector<End> ends;
    std::vector<IndexPair> begun;
    std::vector<std::size_t> ended;  // places in `box_pairs_`
    std::uint64_t exchanges = 0, tests = 0;
  };

  void start(std::span<const Aabb> boxes);
  void sort_by_insertion(Axis& axis, int k, std::span<const Aabb> boxes) const;
  void update_box_pairs();
  void report(const VolumeStore& volumes, FoundPairs& found) const;

  std::array<Axis, 3> axes_;
  std::vector<std::uint8_t> is_listed_;  // by slot
  std::vector<IndexPair> box_pairs_;     // pairs of overlapping boxes, sorted
  // Scratch memory; `open_` has the boxes that began and did not end yet along the first axis.
  std::vector<std::uint32_t> open_;
  std::vector<std::uint8_t> has_ended_;
  std::vector<IndexPair> begun_, merged_;
};

/// See `ComparisonMethods`.
std::uint64_t mask_one_side_first(const ObjectPairView& pair, const NodePair& nodes, std::uint64_t& tests);
void list_colliding_vertices(std::span<const ContactJob> jobs, std::span<const IntersectedObject> objects,
                             CollidingVertexLists& lists);

/// The paper's section 6; see `ComparisonMethods`.
struct LazyRefit {
  static bool refit_object(ObjectOctree& octree, const VertexBuffer& vertices,
                           const std::optional<Aabb>& box);
  static std::size_t refit_children(ObjectOctree& octree, std::uint32_t node, const VertexBuffer& vertices);
  static std::uint64_t refit_where_objects_meet(const World& world, std::span<const ContactJob> jobs,
                                                std::vector<NodePair>& node_pairs,
                                                std::vector<ChildPair>& children);
};

}  // namespace supple
